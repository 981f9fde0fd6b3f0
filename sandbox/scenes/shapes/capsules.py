"""Logs on logs."""

from __future__ import annotations

from engine import Capsule, World
from sandbox.lab.sag import predicted_column
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor, and_a_fifth, but_a_fifth, distance_from
from sandbox.scenes.registry import scene

LENGTHS = (1.0, 2.0, 3.0)  # between the centres of their ends [m]
RADIUS = 0.4
COUNT = 8  # logs a pile
PLACES = (-4.5, -1.3, 3.0)  # of the piles [m]


def stands(pile: int) -> Criterion:
    """The top log sinks as its contacts give way: one at either end of the straight part."""
    shape = Capsule(LENGTHS[pile], RADIUS)

    def predicted(world: World, dt: float) -> float:
        return predicted_column(world, dt, COUNT, shape.inertia(1.0), 0.5 * LENGTHS[pile])

    return Criterion(
        f"the top of the logs {LENGTHS[pile]:g} m long is off its place by",
        lambda world: distance_from(world, COUNT * (pile + 1), PLACES[pile], RADIUS * (2 * COUNT - 1)),
        unit="m",
        after=10.0,
        at_most=and_a_fifth(predicted),
        at_least=but_a_fifth(predicted),
    )


@scene("Shapes/Capsules", shows=tuple(map(stands, range(len(LENGTHS)))), view=(0.0, 3.6, 10.0))
def capsules(world: World) -> None:
    """Three piles of logs: a contact at either end of what is straight."""
    add_floor(world, 60)
    for length, x in zip(LENGTHS, PLACES, strict=True):
        for k in range(COUNT):
            world.create_body(Capsule(length, RADIUS), position=(x, RADIUS * (2 * k + 1)), friction=ROUGH)
