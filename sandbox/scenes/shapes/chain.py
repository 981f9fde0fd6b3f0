"""A chain of flat pieces, and a row of boxes: only one of them feels flat to what slides over it."""

from __future__ import annotations

import numpy as np

from engine import Box, Capsule, Chain, Circle, Polygon, World
from engine.shapes import Shape
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import scene
from sandbox.scenes.shapes.gathering import regular

PIECES = 60
PIECE = 0.5  # [m]
LEFT = -15.0
ABOVE = 4.0  # of the chain over the row of boxes [m]
SPEED = 5.0  # [m/s]
SHAPES: tuple[tuple[Shape, float], ...] = (  # and how high their middles are when they lie [m]
    (Box(0.8, 0.8), 0.4),
    (Circle(0.4), 0.4),
    (Capsule(0.7, 0.3), 0.3),
    (Polygon(regular(6, 0.5)), 0.5 * 3**0.5 / 2),
    (Polygon(regular(5, 0.3), radius=0.15), 0.3 * float(np.cos(np.pi / 5)) + 0.15),
)

BEGIN = LEFT + 1.0 + 1.6 * np.arange(len(SHAPES))  # where they begin [m]


def bump(world: World) -> float:
    """The fastest that anything on the chain moves up or down, or turns, 1 m from its middle [m/s]."""
    on_chain = slice(1, 1 + len(SHAPES))
    return float(max(np.abs(world.velocities[on_chain, 1]).max(), np.abs(world.angular_velocities[on_chain]).max()))


@scene(
    "Shapes/Chain",
    shows=(
        Criterion("what slides over the chain's joints moves up or down at", bump, "m/s", 3.0, 0.01, throughout=True),
        Criterion(
            "what slides over the chain's joints has come, in parts of v t, to",
            lambda world: float((world.positions[1 : 1 + len(SHAPES), 0] - BEGIN).min()) / (3.0 * SPEED),
            unit="",
            after=3.0,
            at_least=0.999,  # nothing holds it
        ),
        Criterion(
            "what slides over the chain's joints has lost",
            lambda world: float(np.abs(world.velocities[1 : 1 + len(SHAPES), 0] - SPEED).max()),
            unit="m/s",
            after=3.0,
            at_most=1e-3,
        ),
    ),
    view=(0.0, 3.5, 24.0),
)
def chain(world: World) -> None:
    """Five shapes slide over forty joints of a chain and feel none; below, over a row of boxes, they may."""
    points = tuple((LEFT + PIECE * k, ABOVE) for k in range(PIECES + 1))
    world.create_body(Chain(points), kind="static", friction=0.0)
    for height in (ABOVE, 0.0):
        for k, (shape, above) in enumerate(SHAPES):
            place = (float(BEGIN[k]), height + above)
            world.create_body(shape, position=place, velocity=(SPEED, 0.0), friction=0.0)
    for k in range(PIECES):
        place = (LEFT + PIECE * (k + 0.5), -0.5)
        world.create_body(Box(PIECE, 1.0), position=place, kind="static", friction=0.0)
