"""Heavy on light."""

from __future__ import annotations

from functools import partial

from sandbox.lab.hard_cases.case import Case, case, variant
from sandbox.scenes.robustness.masses import add_pair, pair_stays, stays
from sandbox.scenes.stacking import heaps

CASES: dict[str, Case] = {
    **{
        f"mass_ratio_{ratio}": variant(
            "Robustness/Heavy on Light",
            partial(add_pair, ratio=float(ratio)),
            f"A box on another of the same size and 1/{ratio} of its mass.",
            shows=pair_stays(float(ratio)),
            quick=True,
        )
        for ratio in (10, 100, 1000)
    },
    "mass_ratio_pyramid_300": case("Robustness/Heavy on a Pyramid", quick=True),
    "mass_ratio_boxes_400": case(
        "Stacking/Mass Ratio 400", shows=stays(heaps.PLACES, heaps.heavy_on_light(), 2), quick=True
    ),
    "mass_ratio_triangles_200": case("Robustness/Heavy on Triangles", quick=True),
    "growing_stack": case("Robustness/Growing Stack", quick=True),
}
