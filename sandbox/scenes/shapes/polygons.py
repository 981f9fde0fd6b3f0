"""Polygons with rounded corners rest as if rolled up to their radius."""

from __future__ import annotations

import math

import numpy as np

from engine import Circle, Polygon, World
from engine.constants import SLOP
from sandbox.lab.sag import MARGIN, contact_hertz, is_soft, spring_sag
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor
from sandbox.scenes.registry import scene
from sandbox.scenes.shapes.gathering import regular

CORNERS = (3, 4, 5, 6, 7, 8)
RADIUS = 0.7  # from the middle to a corner, before rounding [m]
ROUNDING = 0.25  # [m]
DROPPED = 1.0  # [m]


def rest(corners: int) -> float:
    """Height at which one rests: from the middle to a side, and the rounding [m]."""
    return RADIUS * math.cos(math.pi / corners) + ROUNDING


RESTS = np.array([rest(corners) for corners in CORNERS])


def sag(world: World, dt: float) -> float:
    """How far the one whose contacts are softest sinks into the ground, and what its float32 numbers may add [m]."""
    if not is_soft(world):
        return MARGIN * SLOP
    softest = 0.0
    for corners in CORNERS:
        shape = Polygon(regular(corners, RADIUS), radius=ROUNDING)
        half_side = RADIUS * math.sin(math.pi / corners)
        mass = 2.0 / (1.0 + half_side**2 / shape.inertia(1.0))  # that both of its contacts feel, in parts of its own
        softest = max(softest, spring_sag(GRAVITY, mass, 2.0 * contact_hertz(world, dt)))
    return MARGIN * softest + 1e-5


@scene(
    "Shapes/Rounded Polygons",
    shows=Criterion(
        "a polygon rests off its rounded height by",
        lambda world: float(np.abs(world.positions[1 : 1 + len(CORNERS), 1] - RESTS).max()),
        unit="m",
        after=5.0,
        at_most=sag,
    ),
    view=(0.0, 2.8, 12.0),
)
def rounded_polygons(world: World) -> None:
    """From triangle to octagon, each rests at the distance of its side plus its rounding."""
    add_floor(world, 60)
    for k, corners in enumerate(CORNERS):
        shape = Polygon(regular(corners, RADIUS), radius=ROUNDING)
        world.create_body(shape, position=(2.7 * k - 6.75, rest(corners) + DROPPED), friction=ROUGH)
    for k in range(len(CORNERS) - 1):
        world.create_body(Circle(0.3), position=(2.7 * k - 5.4, 2.0 + 0.5 * k), friction=ROUGH)
