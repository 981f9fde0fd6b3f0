"""What rests falls asleep, and only what is hit wakes."""

from __future__ import annotations

import numpy as np

from engine import Box, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor
from sandbox.scenes.registry import scene

ROWS, COLUMNS, HEIGHT = 5, 8, 4  # stacks in so many rows of shelves, boxes in each
SIDE, GAP, SHELF = 0.8, 2.0, 5.0  # of a box, between stacks, between shelves [m]
WIDTH = COLUMNS * GAP
FIRST = ROWS + 2  # body: after the shelves, the floor's is one of them, and the ball
OTHERS = (ROWS - 1) * COLUMNS * HEIGHT  # boxes in the rows that are not hit
NEXT = (COLUMNS - 1) * HEIGHT  # boxes in the one that is, but for the first stack
BEFORE, HIT = 0.7, 1.2  # before the ball comes to that, and soon after [s]


def asleep_in_row(world: World, row: int) -> int:
    """How many boxes of a row of stacks sleep."""
    first = FIRST + row * COLUMNS * HEIGHT
    return int(world.asleep[first : first + COLUMNS * HEIGHT].sum())


def asleep_where_hit(world: World) -> float:
    """How many boxes sleep in the row that the ball rolls into."""
    return float(asleep_in_row(world, ROWS // 2))


def asleep_elsewhere(world: World) -> float:
    """How many boxes sleep in the rows that are not hit."""
    return float(sum(asleep_in_row(world, row) for row in range(ROWS) if row != ROWS // 2))


@scene(
    "Sleeping/Stacks",
    shows=(
        Criterion("boxes asleep before the ball comes:", asleep_elsewhere, "", BEFORE, at_least=OTHERS),
        Criterion("boxes asleep in the row that is hit:", asleep_where_hit, "", HIT, at_least=HEIGHT, at_most=NEXT),
        Criterion("boxes asleep in all other rows:", asleep_elsewhere, "", HIT, at_least=OTHERS),
        Criterion("bodies awake in the end:", lambda world: float(world.awake_count), "", 20.0, at_most=0.0),
    ),
    view=(0.0, 0.5 * ROWS * SHELF, 1.2 * ROWS * SHELF),
)
def stacks(world: World) -> None:
    """Shelves of stacks that fall asleep; a ball rolls into one row, and only what it hits wakes."""
    add_floor(world, 3 * WIDTH)
    for row in range(1, ROWS):
        world.create_body(Box(WIDTH, 0.4), position=(0, SHELF * row - 0.2), kind="static", friction=ROUGH)
    ramp = SHELF * (ROWS // 2)
    world.create_body(Box(WIDTH, 0.4), position=(-WIDTH, ramp - 0.2), kind="static", friction=ROUGH)
    world.create_body(
        Circle(0.5), position=(-0.5 * WIDTH - 7.0, ramp + 0.5), velocity=(9.0, 0), density=4.0, friction=ROUGH,
        angular_velocity=-18.0, angular_damping=0.05,
    )  # fmt: skip
    where = [
        (GAP * (column - 0.5 * (COLUMNS - 1)), SHELF * row + SIDE * (k + 0.5))
        for row in range(ROWS)
        for column in range(COLUMNS)
        for k in range(HEIGHT)
    ]
    world.create_bodies(Box(SIDE, SIDE), positions=np.array(where), friction=ROUGH)
