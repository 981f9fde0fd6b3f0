"""Far from the origin, where float32 has no digits left: a stack must stand there as it does at home."""

from __future__ import annotations

from functools import partial

import numpy as np

from engine import Box, World
from sandbox.lab.hard_cases.case import Case, variant
from sandbox.lab.sag import predicted_column
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, and_a_fifth, but_a_fifth

COUNT, STANDS = 10, 10.0  # boxes; [s]


def far_stack(world: World, far: float) -> None:
    """Ten boxes, so far to the right and up [m]."""
    world.create_body(Box(40, 2), position=(far, far - 1.0), kind="static", friction=ROUGH)
    places = np.column_stack([np.full(COUNT, far), far + 0.5 + np.arange(COUNT)])
    world.create_bodies(Box(1, 1), positions=places, friction=ROUGH)


def stands(far: float) -> tuple[Criterion, Criterion]:
    """It sinks as its springs say, and does not wander."""
    return (
        Criterion(
            "the top box has sunk by",
            lambda world: far + COUNT - 0.5 - float(world.positions[-1, 1]),
            unit="m",
            after=STANDS,
            at_most=and_a_fifth(lambda world, dt: predicted_column(world, dt, COUNT)),
            at_least=but_a_fifth(lambda world, dt: predicted_column(world, dt, COUNT)),
        ),
        Criterion(
            "a box is off its place sideways by",
            lambda world: float(np.abs(world.positions[1:, 0] - far).max()),
            unit="m",
            after=STANDS,
            at_most=0.05,  # a twentieth of its width
        ),
    )


CASES: dict[str, Case] = {
    f"far_1e{digits}": variant(
        "Shapes/Far From Origin",
        partial(far_stack, far=10.0**digits),
        f"Ten boxes on each other, 1e{digits} m from the origin.",
        shows=stands(10.0**digits),
        quick=True,
    )
    for digits in range(3, 8)
}
