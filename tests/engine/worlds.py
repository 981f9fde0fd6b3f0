"""Small worlds that several tests start from."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine import Body, Box, Circle, World

DT = 1.0 / 60.0
PRECISIONS = ("single", "double")


def floor(world: World, friction: float = 0.6) -> Body:
    """A wide static box whose top is y = 0."""
    return world.create_body(Box(100, 2), position=(0, -1), kind="static", friction=friction)


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


def touching(
    first: tuple[Box | Circle, tuple[float, float], float],
    second: tuple[Box | Circle, tuple[float, float], float],
    precision: str = "double",
) -> World:
    """Two bodies (shape, position, angle) at rest, after a step that moved neither: its contacts are pure geometry."""
    world = World(gravity=(0, 0), precision=precision, position_correction=False, iterations=1)
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


def fingerprint(world: World) -> tuple[str, bytes, int, float]:
    """What a refusal must leave as it was."""
    return world.state_hash(), world.snapshot().to_bytes(), world.step_count, world.time
