"""Yards that fill up: with bodies of two triangles each, and with splinters that a pusher moves about."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Polygon, Segment, World
from sandbox.scenes.benchmark.parts import grid_places, one_steps_fall, outside
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene


def add_yard(world: World, half_width: int, height: int) -> Body:
    """A floor and two walls, each of boxes a metre apart that overlap by a tenth; the floor's top is y = 0.5."""
    ground = world.create_body(kind="static")
    for x in range(-half_width, half_width + 1):
        ground.add_shape(Box(1.1, 1.0), offset=(x, 0.0), friction=ROUGH)
    for side in (-half_width, half_width):
        for y in range(1, height + 1):
            ground.add_shape(Box(1.0, 1.1), offset=(side, y), friction=ROUGH)
    return ground


def zigzag(places: np.ndarray, by: float) -> np.ndarray:
    """Places moved aside in turn, to the right the first."""
    places[:, 0] += by * np.resize((1.0, -1.0), len(places))
    return places


# --- compounds --------------------------------------------------------------------------------------------------------

COMPOUND_COLUMNS, COMPOUND_ROWS = 20, 150
HALF_BARREL = 40
LEFT = Polygon(((-1.0, 0.0), (0.5, 1.0), (0.0, 2.0)))
RIGHT = Polygon(((1.0, 0.0), (-0.5, 1.0), (0.0, 2.0)))


@scene(
    "Benchmark/Compounds",
    shows=Criterion(
        "a body has left the yard by",
        lambda world: outside(world, 1, (0.5 - HALF_BARREL, 0.5, HALF_BARREL - 0.5, np.inf)),
        unit="m",
        after=1.5,
        at_most=one_steps_fall(1.5),
    ),
    view=(0.0, 170.0, 350.0),
)
def compounds(world: World) -> None:
    """Three thousand bodies of two triangles each fall into a yard, from a column of 150 rows.

    As Box2D's compounds: 281 boxes and a segment make the yard, friction is 0.5.
    """
    ground = add_yard(world, HALF_BARREL, 100)
    ground.add_shape(Segment((-800.0, -80.0), (800.0, -80.0)), friction=ROUGH)
    places = grid_places(COMPOUND_COLUMNS, COMPOUND_ROWS, 1.0 - COMPOUND_COLUMNS, 5.575, 2.0, 2.25)
    for body in world.create_bodies(LEFT, positions=zigzag(places, 0.25), friction=0.5):
        body.add_shape(RIGHT, friction=0.5)


# --- junkyard ---------------------------------------------------------------------------------------------------------

JUNK_COLUMNS, JUNK_ROWS = 200, 40
HALF_YARD = 80
RADIUS = 0.25  # of a splinter [m]
TURN = math.pi * (math.sqrt(5.0) - 1.0)  # from corner to corner: the golden angle [rad]
SPLINTER = Polygon(
    tuple(
        (RADIUS * math.cos(turn), RADIUS * math.sin(turn)) for turn in sorted((TURN * k) % math.tau for k in range(5))
    )
)
REACH = 60.0  # of the pusher, either way [m]
QUARTER = 0.5 * math.pi / 0.2  # of Box2D's pusher's period, which swings as sin(0.2 t) [s]


@scene(
    "Benchmark/Junkyard",
    shows=Criterion(
        "a splinter has left the yard by",
        lambda world: outside(world, 2, (0.5 - HALF_YARD, 0.5, HALF_YARD - 0.5, np.inf)),
        unit="m",
        after=2.0,
        at_most=0.0,
    ),
    view=(0.0, 27.0, 130.0),
)
def junkyard(world: World) -> None:
    """Eight thousand splinters fall into a yard, through which a pusher goes.

    As Box2D's junkyard: hulls of five points on a circle. There the pusher swings to and fro, to 60 m from the middle;
    here it goes once through the yard, from -60 m on, as fast as that one is on average.
    """
    add_yard(world, HALF_YARD, 50)
    world.create_body(
        Box(4, 8), kind="kinematic", position=(-REACH, 0.0), offset=(0.0, 4.0), velocity=(REACH / QUARTER, 0.0),
        friction=ROUGH,
    )  # fmt: skip
    places = grid_places(JUNK_COLUMNS, JUNK_ROWS, -1.5 * JUNK_COLUMNS * RADIUS, 15.0, 3.0 * RADIUS, 4.0 * RADIUS)
    world.create_bodies(SPLINTER, positions=zigzag(places, -0.1), friction=ROUGH)
