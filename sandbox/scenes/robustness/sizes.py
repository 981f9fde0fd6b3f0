"""What is tiny, huge or thin."""

from __future__ import annotations

import numpy as np

from engine import Box, Polygon, World
from engine.constants import SLOP
from sandbox.lab.sag import predicted_pyramid
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor, and_a_fifth, but_a_fifth
from sandbox.scenes.registry import Build, scene
from sandbox.scenes.robustness.chains import CALM, fastest

BASE = 10
TINY = 0.05  # [m]
STANDS = 10.0  # [s]


def stands(side: float) -> Criterion:
    """The apex sinks by what its contacts give way, whatever the size: g / w^2 has no other length in it."""
    return Criterion(
        "the top box has sunk by",
        lambda world: (BASE - 0.5) * side - float(world.positions[-1, 1]),
        unit="m",
        after=STANDS,
        at_most=and_a_fifth(lambda world, dt: predicted_pyramid(world, dt, BASE), 0.5 * side),
        at_least=but_a_fifth(lambda world, dt: predicted_pyramid(world, dt, BASE), 0.5 * side),
    )


def aside(side: float) -> Criterion:
    """The apex is still above the middle of the pyramid."""
    return Criterion(
        "the top box is off its place sideways by",
        lambda world: abs(float(world.positions[-1, 0])),
        unit="m",
        after=STANDS,
        at_most=0.5 * side,
    )


def pyramid_of(side: float) -> Build:
    """Builds a pyramid of boxes of that side."""

    def build(world: World) -> None:
        world.create_body(
            Box(40.0 * side, 2.0 * side), position=(0.0, -side), kind="static", friction=ROUGH
        )  # as thick as it is large
        places = [(0.5 * row + i - 0.5 * (BASE - 1), row + 0.5) for row in range(BASE) for i in range(BASE - row)]
        world.create_bodies(Box(side, side), positions=side * np.array(places), friction=ROUGH)

    return build


@scene("Robustness/Tiny Pyramid", shows=(stands(TINY), aside(TINY)), view=(0.0, 0.25, 0.75))
def tiny_pyramid(world: World) -> None:
    """A pyramid of boxes of 5 cm: contacts are seen 2 cm ahead, and kept while they move by 5 cm. As Box2D's."""
    pyramid_of(TINY)(world)


# --- slivers ----------------------------------------------------------------------------------------------------------

SPLINTERS = (Box(2.0, 0.01), Box(1.0, 0.02), Polygon(((-0.8, -0.01), (0.8, -0.01), (0.8, 0.01))), Box(0.01, 0.5))
LIES = 8.0  # [s]


@scene(
    "Robustness/Slivers",
    shows=(
        Criterion(
            "a sliver's middle is under the floor by",
            lambda world: -float(world.positions[1:, 1].min()),
            unit="m",
            after=LIES,
            at_most=SLOP,  # it may overlap, but not come through
            throughout=True,
        ),
        Criterion(
            "the highest sliver's middle is over the floor by",
            lambda world: float(world.positions[1:, 1].max()),
            unit="m",
            after=LIES,
            at_most=1.0,  # all have fallen, and what leans on others does not reach over half of the longest
        ),
        Criterion("the fastest sliver still moves at", fastest, "m/s", LIES, at_most=CALM),
    ),
    view=(0.0, 3.0, 14.0),
)
def slivers(world: World) -> None:
    """Splinters a hundredth as thick as they are long fall on a floor and on each other, and lie still."""
    add_floor(world, 60)
    for k in range(16):
        world.create_body(
            SPLINTERS[k % 4], position=(1.6 * (k % 4) - 2.4, 1.0 + 0.5 * k), angle=0.7 * k, friction=ROUGH
        )
