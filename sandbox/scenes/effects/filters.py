"""Categories, masks and groups: what passes through what."""

from __future__ import annotations

import numpy as np

from engine import Box, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import add_floor
from sandbox.scenes.registry import scene

LIGHT, DARK = 2, 4  # categories
SIEVES = ((4.0, LIGHT), (2.0, DARK))  # height of a shelf [m], and the category that it carries
BALLS = 5  # of each


def in_the_wrong_place(world: World) -> float:
    """Balls that are not on the shelf that carries them."""
    y = world.positions[3:, 1]
    expected = np.array([SIEVES[k % 2][0] + 0.4 for k in range(2 * BALLS)])
    return float(np.count_nonzero(np.abs(y - expected) > 0.05))


@scene(
    "Effects/Filters",
    shows=Criterion("balls that do not lie on their own shelf:", in_the_wrong_place, "", 4.0, at_most=0.0),
    view=(0.0, 4.0, 10.0),
)
def filters(world: World) -> None:
    """Two shelves, two kinds of ball: the upper one carries the first, and lets the second through to the lower one."""
    add_floor(world, 40)
    for y, category in SIEVES:
        world.create_body(Box(12, 0.3), position=(0.0, y - 0.15), kind="static", mask=category)
    for k in range(2 * BALLS):
        world.create_body(
            Circle(0.4), position=(1.1 * (k - BALLS + 0.5), 7.0 + 0.1 * (k % 3)), category=SIEVES[k % 2][1]
        )
