"""What bounces: how high balls come back, at any moment of a time step."""

from __future__ import annotations

from functools import partial

import numpy as np

from engine import Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import COPIES, History, Measure, Watch, add_floor, experiment, places

RESTITUTION, BALL = 0.8, 0.25
DROPS = np.linspace(4.0, 5.0, COPIES)  # all different: a ball may hit at any moment of a time step [m]


def apex_error(history: History, dt: float, restitution: float = RESTITUTION) -> float:
    errors = []
    for heights, drop in zip(history.T, DROPS, strict=True):
        bounced = int(np.argmax(np.diff(heights) > 0.0))  # the first step that leads upwards
        errors.append(vertex(heights[bounced:]) / references.apex(drop, restitution) - 1.0)
    return float(np.sqrt(np.mean(np.square(errors))))


def vertex(heights: np.ndarray) -> float:
    """The top of the parabola through the highest of some equidistant heights and its neighbours [m]."""
    top = int(np.clip(np.argmax(heights), 1, len(heights) - 2))
    before, here, after = heights[top - 1 : top + 2]
    slope, bend = 0.5 * (after - before), after - 2.0 * here + before
    return float(here - 0.5 * slope * slope / bend) if bend < 0.0 else float(here)


def drop_balls(world: World, restitution: float) -> Watch:
    world.continuous = False  # what stops at its impact loses the rest of that step, however short substeps are
    add_floor(world)
    for (x, y), height in zip(places(), DROPS, strict=True):
        world.create_body(Circle(BALL), position=(x, y + height + BALL), restitution=restitution)
    return lambda world: world.positions[1:, 1] - BALL


def apex_measure(restitution: float) -> Measure:
    return Measure(
        "apex",
        "relative",
        "how high they rise, root mean square",
        partial(apex_error, restitution=restitution),
        against="the height they should rise",
    )


@experiment(
    "bounce",
    f"{COPIES} balls dropped from {DROPS[0]:g} to {DROPS[-1]:g} m bounce with e = {RESTITUTION:g}",
    seconds=2.2,
    measures=apex_measure(RESTITUTION),
    needs=("restitution",),
)
def build_bounce(world: World) -> Watch:
    return drop_balls(world, RESTITUTION)


@experiment(
    "bounce_elastic",
    f"{COPIES} balls dropped from {DROPS[0]:g} to {DROPS[-1]:g} m bounce with e = 1",
    seconds=2.4,
    measures=apex_measure(1.0),
    needs=("restitution",),
)
def build_bounce_elastic(world: World) -> Watch:
    return drop_balls(world, 1.0)
