"""Bullets do not go through moving bodies, nor through each other; and the largest speed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from engine import SHAPES, Body, Box, Capsule, Circle, Polygon, Shape, World
from tests.engine.worlds import DT, POINTS, PRECISIONS, run

TARGETS: tuple[Shape, ...] = (Box(2, 0.01), Circle(0.3), Capsule(2.0, 0.01), Polygon(POINTS))


def shot(target: Shape, speed: float, bullet: bool = True, **more: Any) -> tuple[Body, Body]:
    """A bullet, and what it is shot at from 6 m: lines stand in its way."""
    world = World(gravity=(0, 0), precision="double")
    ball = world.create_body(Circle(0.05), velocity=(speed, 0), bullet=bullet, restitution=1.0, friction=0.0)
    return ball, world.create_body(target, position=(6, 0), **{"velocity": (-5, 0), "angle": 1.6, **more})


def momentum(world: World) -> np.ndarray:
    return np.sum([body.mass * np.array(body.velocity) for body in world.bodies], axis=0)


@pytest.mark.parametrize("target", TARGETS, ids=lambda shape: type(shape).__name__)
@pytest.mark.parametrize("speed", [60.0, 1000.0])
def test_a_bullet_meets_what_moves(target: Shape, speed: float) -> None:
    ball, other = shot(target, speed)
    before = momentum(ball.world)
    met = False
    for _ in range(20):
        ball.world.step(DT)
        assert ball.position.x < other.position.x, "never beyond it"
        met |= other.velocity.x != -5.0
    assert met
    assert momentum(ball.world) == pytest.approx(before, rel=1e-9)


def test_what_is_no_bullet_goes_through() -> None:
    ball, other = shot(Box(2, 0.01), 1000.0, bullet=False)
    run(ball.world, 3)
    assert ball.position.x > other.position.x + 10
    assert tuple(other.velocity) == (-5.0, 0.0)


@pytest.mark.parametrize("target", TARGETS, ids=lambda shape: type(shape).__name__)
def test_what_is_fast_does_not_go_through_a_bullet_at_rest(target: Shape) -> None:
    ball, other = shot(target, 0.0, velocity=(-700, 0))
    for _ in range(10):
        ball.world.step(DT)
        assert ball.position.x < other.position.x


def test_two_bullets_stop_where_they_meet() -> None:
    world = World(gravity=(0, 0), precision="double")
    a = world.create_body(Circle(0.05), velocity=(800, 0), bullet=True)
    b = world.create_body(Circle(0.15), position=(7, 0), velocity=(-400, 0), bullet=True)
    world.step(DT)
    assert a.position.x == pytest.approx(800 * 6.8 / 1200, abs=1e-6)
    assert b.position.x - a.position.x == pytest.approx(0.2, abs=1e-6)
    assert (a.velocity.x, b.velocity.x) == (800.0, -400.0), "velocities are the next step's"


def test_the_first_impact_decides_what_comes_after() -> None:
    # the second bullet would meet the plate, but the first one, stopped by it, is in its way
    world = World(gravity=(0, 0), precision="double")
    first = world.create_body(Circle(0.05), position=(1, 0), velocity=(900, 0), bullet=True)
    second = world.create_body(Circle(0.05), velocity=(900, 0), bullet=True)
    world.create_body(Box(0.02, 3), position=(6, 0), density=50.0)
    world.step(DT)
    assert first.position.x == pytest.approx(6 - 0.01 - 0.05, abs=1e-6)
    assert second.position.x == pytest.approx(first.position.x - 0.1, abs=1e-6)


def test_a_crowd_of_bullets_in_a_closed_room() -> None:
    world = World(gravity=(0, 0))
    for x, y, size in ((0, 5.5, (12, 1)), (0, -5.5, (12, 1)), (5.5, 0, (1, 12)), (-5.5, 0, (1, 12))):
        world.create_body(Box(*size), position=(x, y), kind="static", restitution=1.0)
    rng = np.random.default_rng(7)
    for k, place in enumerate(rng.uniform(-4, 4, (20, 2))):
        turn = rng.uniform(0, 2 * math.pi)
        shape = (Circle(0.1), Box(0.2, 0.2), Capsule(0.2, 0.05))[k % 3]
        world.create_body(
            shape, position=place, velocity=(300 * math.cos(turn), 300 * math.sin(turn)), bullet=True, restitution=0.5
        )
    for _ in range(60):
        world.step(DT)
        assert np.abs(world.positions[4:]).max() < 5.0


def test_the_property() -> None:
    world = World()
    body = world.create_body(Circle(0.5))
    assert body.bullet is False
    body.bullet = True
    assert body.bullet is True
    with pytest.raises(ValueError, match=r"^bullet = 1: must be True or False"):
        body.bullet = 1  # type: ignore[assignment]
    with pytest.raises(ValueError, match=r"^bullet = True: must be False with the solver"):
        World(solver="sequential_impulses").create_body(Circle(0.5), bullet=True)
    with pytest.raises(ValueError, match="solver = 'sequential_impulses': must be one that knows bullets"):
        world.solver = "sequential_impulses"


@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_largest_speed(precision: str) -> None:
    world = World(gravity=(0, 0), precision=precision, maximum_speed=50.0)
    pushed = world.create_body(Circle(0.5), mass=2.0)
    thrown = world.create_body(Box(1, 1), position=(50, 0), velocity=(300, -400))
    slow = world.create_body(Box(1, 1), position=(0, 9), velocity=(30, 40))
    belt = world.create_body(Box(1, 1), position=(0, 99), velocity=(70, 0), kind="kinematic")
    for _ in range(30):
        pushed.force = (3000, 4000)
        world.step(DT)
        assert math.hypot(*pushed.velocity) <= 50.0 * (1 + 1e-6)
    assert pushed.velocity.x == pytest.approx(30.0)
    assert thrown.velocity.y == pytest.approx(-40.0)
    assert slow.velocity.x == pytest.approx(30.0), "in its direction, and not slower"
    assert belt.velocity.x == pytest.approx(70.0), "nothing holds what is kinematic"
    assert thrown.position.x == pytest.approx(50 + 30 * 30 * DT, rel=1e-5)
    with pytest.raises(ValueError, match=r"^maximum_speed = 0: must be a finite number > 0"):
        world.maximum_speed = 0
    assert World().maximum_speed >= 1000.0


def test_every_shape_can_be_a_bullet() -> None:
    for shape in SHAPES:
        world = World(gravity=(0, 0))
        world.create_body(Box(0.01, 4), position=(4, 0), kind="dynamic", density=100.0)
        body = world.create_body(Circle(0.02), velocity=(500, 0), bullet=True)
        body.add_shape(shape.filling(0.4, 0.3))
        run(world, 3)
        assert body.position.x < 4.5, shape.name
