"""What is tiny, huge or thin."""

from __future__ import annotations

from sandbox.lab.hard_cases.case import Case, case, variant
from sandbox.scenes.robustness.sizes import aside, pyramid_of, stands


def pyramid(side: float, what: str) -> Case:
    """A pyramid of boxes of that side [m]."""
    return variant(
        "Robustness/Tiny Pyramid",
        pyramid_of(side),
        f"A pyramid of boxes of {what}.",
        shows=(stands(side), aside(side)),
        quick=True,
    )


CASES: dict[str, Case] = {
    "tiny_pyramid": case("Robustness/Tiny Pyramid", quick=True),
    "tiny_pyramid_2cm": pyramid(0.02, "2 cm"),
    "huge_pyramid": pyramid(100.0, "100 m"),
    "slivers": case("Robustness/Slivers", quick=True),
}
