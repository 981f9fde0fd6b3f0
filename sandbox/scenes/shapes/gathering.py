"""All shapes in one bin."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Capsule, Chain, Circle, Polygon, Segment, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene

BIN = ((-6.0, 7.0), (-5.0, 0.0), (5.0, 0.0), (6.0, 7.0))  # left to right: solid from inside
RESISTANCE = 0.1  # against rolling, so that what is round comes to rest


def regular(corners: int, radius: float) -> tuple[tuple[float, float], ...]:
    """Corners of a regular polygon that stands on one of its sides [m]."""
    turns = (2.0 * math.pi * (k + 0.5) / corners - 0.5 * math.pi for k in range(corners))
    return tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)


SHAPES = (
    Box(0.9, 0.6),
    Circle(0.4),
    Capsule(0.6, 0.25),
    Polygon(regular(3, 0.55)),
    Polygon(regular(6, 0.5)),
    Polygon(regular(5, 0.35), radius=0.15),
)


@scene(
    "Shapes/All Shapes",
    shows=(
        Criterion(
            "the fastest body still moves at",
            lambda world: float(np.hypot(*world.velocities.T).max()),
            unit="m/s",
            after=20.0,
            at_most=0.05,  # Box2D's speed of what may fall asleep
        ),
        Criterion(
            "bodies outside the bin:",
            lambda world: float(np.count_nonzero(world.positions[2:, 1] < 0.0)),
            unit="",
            after=20.0,
            at_most=0.0,
        ),
    ),
    view=(0.0, 6.2, 14.5),
)
def all_shapes(world: World) -> None:
    """Boxes, circles, capsules, polygons and rounded ones fall past two segments into a bin that is a chain."""
    world.create_body(Chain(BIN), kind="static", friction=ROUGH)
    world.create_body(Segment((-5.6, 6.0), (-1.4, 4.2)), kind="static", friction=0.1).add_shape(
        Segment((5.6, 6.0), (1.4, 4.2)), friction=0.1
    )
    for k in range(36):
        world.create_body(
            SHAPES[k % len(SHAPES)],
            position=(-4.2 + 1.4 * (k % 7), 7.4 + 1.1 * (k // 7)),
            angle=0.3 * k,
            friction=ROUGH,
            rolling_resistance=RESISTANCE,
        )
