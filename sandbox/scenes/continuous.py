"""Continuous collision: what is fast stops at what it would go through. Each scene is lost without it."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from engine import Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import scene

HOUSE = ((-8.0, 0.0), (8.0, 0.0), (8.0, 7.0), (0.0, 12.0), (-8.0, 7.0))
BULLETS, BULLET_SPEED = 16, 200.0
BULLET_RADII = (0.15, 0.1, 0.25)  # [m]
MIDDLE = 5.0  # height of the middle of the house [m]

WALL_X, ROW = 10.0, 1.2
SPEEDS = (30.0, 100.0, 300.0, 1000.0)


def outside_of_house(world: World) -> float:
    """How far the bullet furthest out is behind a wall [m]; < 0: all are inside."""
    corners = np.array(HOUSE)
    along = np.roll(corners, -1, axis=0) - corners
    out = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(along[:, 0], along[:, 1])[:, None]
    return float(max(((place - corners) * out).sum(axis=1).max() for place in world.positions[1:]))


def energy_of_bullets(world: World) -> float:
    """What moves, in parts of what moved in the beginning."""
    masses = world.body_records()["mass"][1:]
    return float(masses @ (world.velocities[1:] ** 2).sum(axis=1) / (masses.sum() * BULLET_SPEED**2))


@scene(
    "Continuous/Bounce House",
    shows=(
        Criterion(
            "of a bullet is out of the house at most",
            outside_of_house,
            unit="m",
            after=5.0,
            at_most=0.0,
            at_least=-2.0 * max(BULLET_RADII),  # they have come to the walls
            throughout=True,
        ),
        Criterion(
            "after some bounces without loss, of their energy, the bullets have",
            energy_of_bullets,
            unit="",
            after=0.3,  # each has flown 60 m in a house of 12
            at_least=0.9,
            at_most=1.1,
        ),
    ),
    view=(0.0, MIDDLE, 14.0),
    gravity=(0.0, 0.0),
)
def bounce_house(world: World) -> None:
    """Bullets of 200 m/s in a closed house, whose walls have no thickness: none gets out, nor through another."""
    world.create_body(Chain(HOUSE, closed=True), kind="static", friction=0.0, restitution=1.0)
    shapes = tuple(map(Circle, BULLET_RADII))
    for k in range(BULLETS):
        turn = 2.0 * math.pi * (k + 0.5) / BULLETS
        out = (math.cos(turn), math.sin(turn))
        world.create_body(
            shapes[k % len(shapes)], position=(2.0 * out[0], MIDDLE + 2.0 * out[1]), angle=turn, friction=0.0,
            velocity=(BULLET_SPEED * out[0], BULLET_SPEED * out[1]), restitution=1.0, bullet=True,
        )  # fmt: skip


def at_walls(world: World) -> float:
    """Part of what flies that is so near to its wall that it has hit it, or all but."""
    return float(np.mean(world.positions[-len(SPEEDS) * 6 :, 0] > WALL_X - 1.5))


@scene(
    "Continuous/Thin Walls",
    shows=(
        Criterion(
            "is how far anything is behind its wall",
            lambda world: float((world.positions[-len(SPEEDS) * 6 :, 0]).max() - WALL_X),
            unit="m",
            after=3.0,
            at_most=0.0,
            throughout=True,
        ),
        Criterion(
            "of what flies, there have come to their walls",
            at_walls,
            unit="",
            after=0.45,  # the slowest needs 12 / 30 s
            at_least=0.6,  # the half that does not spin, and more; what hits with a corner is thrown back
        ),
    ),
    view=(4.0, 7.0, 18.0),
)
def thin_walls(world: World) -> None:
    """Balls, rods and boxes of 30 to 1000 m/s, some spinning at 60 rad/s, against a millimetre, a line and a chain."""
    top = ROW * 2 * len(SPEEDS) * 1.5
    world.create_body(Box(40, 2), position=(0, -1), kind="static")
    world.create_body(Box(0.001, top / 3), position=(WALL_X, top / 6), kind="static")
    world.create_body(Segment((WALL_X, top / 3), (WALL_X, 2 * top / 3)), kind="static")
    ys = np.linspace(2 * top / 3, top, 7)
    chain = world.create_body(kind="static")
    chain.add_shape(Chain(tuple((WALL_X, float(y)) for y in ys)))
    for a, b in pairwise([(WALL_X, top), (-4.0, top + 2), (-4.0, 0.0)]):
        world.create_body(Segment(a, b), kind="static")
    shapes: tuple[Shape, ...] = (
        Circle(0.05), Box(1.0, 0.01), Capsule(0.8, 0.02), Box(0.4, 0.3), Circle(0.3),
        Polygon(((-0.4, -0.1), (0.4, -0.1), (0.0, 0.2))),
    )  # fmt: skip
    for k, shape in enumerate(shapes):
        for j, speed in enumerate(SPEEDS):
            y = top * (k * len(SPEEDS) + j + 0.7) / (len(shapes) * len(SPEEDS))
            spin = 60.0 if (k + j) % 2 else 0.0
            world.create_body(shape, position=(-2.0 + 1.5 * (k % 2), y), velocity=(speed, 0), angular_velocity=spin)
