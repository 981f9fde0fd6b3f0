"""What stands by its weight and by friction."""

from __future__ import annotations

import numpy as np

from engine import Box, World
from sandbox.lab.hard_cases.case import Case, case, variant
from sandbox.lab.sag import predicted_pyramid
from sandbox.scenes.parts import ROUGH, add_floor
from sandbox.scenes.registry import Build
from sandbox.scenes.robustness.stacks import LEANS
from sandbox.scenes.stacking.stacks import add_stack, column_stands, stands

BASE = 20


def column(count: int) -> Build:
    """Builds a stack of so many boxes."""

    def build(world: World) -> None:
        add_floor(world, 80)
        add_stack(world, count)

    return build


def pyramid_20(world: World) -> None:
    """210 boxes."""
    add_floor(world, 60)
    places = [(0.5 * row + i - 0.5 * (BASE - 1), row + 0.5) for row in range(BASE) for i in range(BASE - row)]
    world.create_bodies(Box(1, 1), positions=np.array(places), friction=ROUGH)


CASES: dict[str, Case] = {
    "single_box": case("Robustness/Single Box", quick=True),
    "stack_10": case("Stacking/Vertical Stack 10", quick=True),
    "stack_20": case("Stacking/Vertical Stack 20", quick=True),
    "stack_40": case("Stacking/Vertical Stack 40", quick=True),
    "stack_80": variant(
        "Stacking/Vertical Stack 40", column(80), "Eighty boxes: four times the sag of forty.", shows=column_stands(80)
    ),
    "tilted_stack": case("Robustness/Tilted Stack", shows=LEANS, quick=True),
    "circle_stack": case("Robustness/Circle Stack", quick=True),
    "capsule_stack": case("Shapes/Capsules"),
    "pyramid_20": variant(
        "Stacking/Pyramid 100",
        pyramid_20,
        "210 boxes, twenty in the lowest row.",
        shows=stands(BASE * (BASE + 1) // 2, BASE - 0.5, lambda world, dt: predicted_pyramid(world, dt, BASE)),
    ),
    "pyramid_100": case("Stacking/Pyramid 100"),
    "card_house": case("Stacking/Card House"),
    "arch": case("Stacking/Arch", quick=True),
    "dominoes": case("Stacking/Dominoes"),
    "domino_run": case("Joints/Domino Run"),
}
