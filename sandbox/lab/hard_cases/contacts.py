"""Corners, seams, slopes and bounces."""

from __future__ import annotations

from sandbox.lab.hard_cases.case import Case, case
from sandbox.scenes import find_scene
from sandbox.scenes.effects.surfaces import SLID
from sandbox.scenes.robustness.contacts import SMOOTH

CASES: dict[str, Case] = {
    "ghost_bumps": case("Shapes/Chain", quick=True),
    "seams": case("Robustness/Seams", shows=SMOOTH, quick=True),
    "wedge": case("Robustness/Wedge", quick=True),
    "friction_ramp": case(
        "Effects/Friction Ramp", shows=(*find_scene("Effects/Friction Ramp").shows, SLID), quick=True
    ),
    "friction_creep": case("Robustness/Friction Creep", quick=True),
    "restitution": case("Effects/Restitution", quick=True),
    "restitution_threshold": case("Robustness/Restitution Threshold", quick=True),
    "bouncing_column": case("Robustness/Bouncing Column", quick=True),
}
