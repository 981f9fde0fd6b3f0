"""What slides on a level floor, and on a belt: dry friction."""

from __future__ import annotations

import numpy as np

from engine import Box, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    G,
    Measure,
    Watch,
    add_floor,
    experiment,
    of_impulses,
    places,
    substep,
)

# --- sliding ----------------------------------------------------------------------------------------------------------

SLIDING_AT, FRICTION = 10.0, 0.5  # [m/s]
STOPPED_AFTER = references.stopping_distance(SLIDING_AT, FRICTION, G)  # [m]


@experiment(
    "sliding",
    "a box slides until friction has stopped it",
    seconds=3.0,
    measures=Measure(
        "distance",
        "m",
        "how far it gets",
        lambda history, dt: abs(history[-1, 0] - STOPPED_AFTER),
        of_impulses(lambda world, dt: references.stopping_lag(SLIDING_AT, substep(world, dt))),
        scale=STOPPED_AFTER,
        against="how far it gets",
    ),
)
def build_sliding(world: World) -> Watch:
    add_floor(world, FRICTION)
    boxes = [
        world.create_body(Box(1.0, 0.5), position=(x, y + 0.25), velocity=(SLIDING_AT, 0.0), friction=FRICTION)
        for x, y in places()
    ]
    box = boxes[0]
    return lambda world: np.array([box.position.x])


# --- conveyor ---------------------------------------------------------------------------------------------------------

BELT, CARRIED = 4.0, 2.0  # [m/s], [s]
CARRIED_TO = BELT * CARRIED - references.stopping_distance(BELT, FRICTION, G)  # [m]


@experiment(
    "conveyor",
    "a belt takes along a box that is laid on it",
    seconds=CARRIED,
    measures=Measure(
        "distance",
        "m",
        f"how far it is after {CARRIED:g} s",
        lambda history, dt: abs(float(history[-1, 0]) - CARRIED_TO),
        of_impulses(lambda world, dt: references.stopping_lag(BELT, substep(world, dt))),
        scale=CARRIED_TO,
        against="how far it is",
    ),
    needs=("conveyor", "friction"),
)
def build_conveyor(world: World) -> Watch:
    add_floor(world, FRICTION, tangent_speed=BELT)
    boxes = [world.create_body(Box(1.0, 0.5), position=(x, y + 0.25), friction=FRICTION) for x, y in places()]
    box = boxes[0]
    return lambda world: np.array([box.position.x])
