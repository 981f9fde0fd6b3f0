"""Small worlds that several tests start from."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from engine import SOLVERS, Body, Box, Capsule, Chain, Circle, Polygon, Segment, Settings, Shape, World

DT = 1.0 / 60.0
PRECISIONS = ("single", "double")
OF_ANY_SIZE = tuple(name for name in SOLVERS if name != "direct")
"""Solvers that take a world of any size."""

Placed = tuple[Shape, tuple[float, float], float]


def talk(**settings: Any) -> World:
    """A world with the talk's solver."""
    return World(**{"solver": "sequential_impulses", **settings})


def floor(world: World, friction: float = 0.6, **properties: Any) -> Body:
    """A wide static box whose top is y = 0."""
    return world.create_body(Box(100, 2), position=(0, -1), kind="static", friction=friction, **properties)


def busy(precision: str = "double", **settings: Any) -> World:
    """Boxes and circles on a floor, one of them on a joint: something of everything."""
    world = World(precision=precision, **settings)
    ground = floor(world)
    world.create_body(Box(1, 1), position=(0, 0.6), angle=0.2, friction=0.4)
    world.create_body(Box(0.8, 0.5), position=(0.2, 1.6), velocity=(0.5, 0), angular_velocity=2.0)
    world.create_body(Circle(0.4), position=(-1.2, 0.5), velocity=(3, -1), mass=2)
    bob = world.create_body(Circle(0.3), position=(1.7, 1.5), density=3)
    world.create_joint_revolute(ground, bob, anchor=(0.6, 2.0))
    return world


def gathering(precision: str = "double", **settings: Any) -> World:
    """Every shape, on a floor of every kind that there is without mass; a compound; one kinematic, two joined."""
    world = World(precision=precision, **settings)
    ground = world.create_body(kind="static")
    ground.add_shape(Chain(((-4, 2), (-3, 0.2), (0, 0), (3, 0.1), (4, 2))), friction=0.6)
    ground.add_shape(Segment((1.9, 0.75), (3.4, 0.85)), friction=0.4)
    world.create_body(Box(3, 0.2), position=(0.5, 0.6), kind="kinematic", velocity=(0.2, 0), angular_velocity=0.3)
    world.create_body(Capsule(0.6, 0.2), position=(-1.5, 1.2), angle=0.4, velocity=(1, 0))
    world.create_body(Polygon(POINTS), position=(-2.2, 1.5), angle=1.0)
    world.create_body(Polygon(POINTS, radius=0.1), position=(0.3, 1.9), angular_velocity=-2)
    world.create_body(Circle(0.3), position=(-0.7, 2.2), friction=0.8)
    hammer = world.create_body(Box(0.2, 1.0), position=(1.6, 1.6), angle=0.3)
    hammer.add_shape(Capsule(0.5, 0.15), offset=(0, 0.5), angle=0.1, density=3)
    ball = world.create_body(Circle(0.25), position=(2.4, 1.4))
    world.create_joint_revolute(hammer, ball, anchor=(2.0, 1.5))
    world.create_body(Box(0.4, 0.3), position=(3.0, 1.1))
    return world


POINTS = ((0.5, -0.2), (0.3, 0.4), (-0.2, 0.5), (-0.5, 0.0), (-0.1, -0.4))
"""A pentagon whose centre of mass is not its origin."""


def regular(corners: int, radius: float = 0.5) -> tuple[tuple[float, float], ...]:
    """Corners of a regular polygon, counter-clockwise."""
    turns = [2 * math.pi * k / corners for k in range(corners)]
    return tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)


def touching(first: Placed, second: Placed, precision: str = "double", solver: str = "sequential_impulses") -> World:
    """Two bodies (shape, position, angle) at rest, after a step that moved neither: its contacts are pure geometry."""
    world = World(
        gravity=(0, 0), precision=precision, solver=solver, position_correction=False, iterations=1,
        speculative_distance=0,
    )  # fmt: skip
    for shape, position, angle in (first, second):
        world.create_body(shape, position=position, angle=angle)
    before = world.positions.copy()
    world.step(DT)
    assert np.array_equal(world.positions, before)
    return world


def run(world: World, steps: int, dt: float = DT) -> World:
    for _ in range(steps):
        world.step(dt)
    return world


def tables_of(world: World) -> dict[str, bytes]:
    """Every bit that a later step depends on."""
    return {name: table.tobytes() for name, table in world.snapshot().tables.items()}


def fingerprint(world: World) -> tuple[dict[str, bytes], Settings, int, float]:
    """What a refusal must leave as it was."""
    return tables_of(world), world.settings, world.step_count, world.time
