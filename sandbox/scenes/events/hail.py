"""Balls fall, and each tells how fast it hit."""

from __future__ import annotations

import math

from engine import Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

HEIGHTS = (1.0, 2.0, 3.0, 4.0)  # that balls fall from, each so many [m]
ON_EACH = 6
RADIUS = 0.25  # [m]
APART = 0.55  # [m]


def hits(world: World) -> float:
    """How many there were in the last step."""
    return float(len(world.events.hit))


def fastest(world: World) -> float:
    """The speed of the fastest hit of the last step [m/s]."""
    return float(world.events.hit["speed"].max(initial=0.0))


def speed_of_fall(world: World, dt: float) -> float:
    """From the greatest height, v^2 = 2 g h [m/s]."""
    return math.sqrt(2.0 * GRAVITY * max(HEIGHTS))


@scene(
    "Events/Hail",
    shows=(
        Criterion(
            "of the balls that fell equally far, hit in the same step",
            hits,
            unit="",
            after=1.5,
            at_least=ON_EACH,
            at_most=ON_EACH,
            throughout=True,
        ),
        Criterion(
            "the fastest hit has, give or take what a step adds,",
            fastest,
            unit="m/s",
            after=1.5,
            at_least=lambda world, dt: speed_of_fall(world, dt) - GRAVITY * dt,
            at_most=lambda world, dt: speed_of_fall(world, dt) + GRAVITY * dt,
            throughout=True,
        ),
    ),
    view=(0.0, 2.5, 10.0),
    tell_events=True,
)
def hail(world: World) -> None:
    """Twenty-four balls fall from four heights: six at a time hit the floor, as fast as they must."""
    add_floor(world, 60)
    for k in range(ON_EACH * len(HEIGHTS)):
        x = APART * (k - 0.5 * (ON_EACH * len(HEIGHTS) - 1))
        world.create_body(Circle(RADIUS), position=(x, RADIUS + HEIGHTS[k % len(HEIGHTS)]))
