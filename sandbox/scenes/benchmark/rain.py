"""Rain: many ragdolls fall through a grid of obstacles."""

from __future__ import annotations

import numpy as np

from engine import Box, World
from sandbox.scenes.benchmark.parts import one_steps_fall, outside
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.human import BONES, GRIP, POSES, add_human
from sandbox.scenes.joints.parts import gap
from sandbox.scenes.registry import scene

SEED = 20261122
ACROSS, UP = 25, 8  # ragdolls beside and above each other
APART, ABOVE = (2.4, 2.6), 16.0  # from one to the next [m]; height of the lowest
HALF = 0.5 * ACROSS * APART[0] + 1.0  # of the yard's width [m]
SHELVES, LEDGES, LEDGE = 5, 16, 0.6  # rows of obstacles; how many in a row; width of one [m]
FOREARM = BONES["near forearm"].top - BONES["near forearm"].bottom  # [m]


@scene(
    "Benchmark/Rain",
    shows=(
        Criterion(
            "a bone has left the yard by",
            lambda world: outside(world, 1, (-HALF, 0.0, HALF, np.inf)),
            unit="m",
            after=2.0,
            at_most=one_steps_fall(2.0),
        ),
        Criterion("a joint's anchors are apart by", gap, "m", 2.0, at_most=FOREARM),
    ),
    view=(0.0, 19.0, 46.0),
)
def rain(world: World) -> None:
    """Two hundred ragdolls of eleven bones fall through a grid of ledges.

    After Box2D's rain, where ragdolls are created and destroyed all the time; here all are there from the beginning.
    """
    yard = world.create_body(Box(2.0 * HALF + 4.0, 2.0), kind="static", offset=(0.0, -1.0), friction=GRIP)
    for side in (-1.0, 1.0):
        yard.add_shape(Box(2.0, 45.0), offset=(side * (HALF + 1.0), 20.5), friction=GRIP)
    for row in range(SHELVES):
        for k in range(LEDGES + row % 2):
            x = 2.0 * HALF / LEDGES * (k - 0.5 * (LEDGES - 1 + row % 2))
            yard.add_shape(Box(LEDGE, 0.3), offset=(x, 2.5 + 2.5 * row), friction=GRIP)
    rng = np.random.default_rng(SEED)
    turns = rng.uniform(-3.0, 3.0, ACROSS * UP).tolist()
    for k, turn in enumerate(turns):
        row, column = divmod(k, ACROSS)
        place = (APART[0] * (column - 0.5 * (ACROSS - 1) + 0.2 * (row % 2 - 0.5)), ABOVE + APART[1] * row)
        add_human(world, place, group=k + 1, angle=turn, pose=POSES[k % 3])
