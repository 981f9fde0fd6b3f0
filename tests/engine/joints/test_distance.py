"""The distance joint as a rod: a pendulum of two pins. As a rope and as a spring: test_limits.py, test_springs.py."""

from __future__ import annotations

import math

import pytest

from engine import Box, Circle
from tests.engine.joints.making import GRAVITY, joint_omega, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run


@pytest.mark.parametrize("angle", [0.05, 1.0])
def test_period_of_a_pendulum_on_a_rod(angle: float) -> None:
    # anchored at its middle a bob turns freely: a point on a rod, whose period is the complete elliptic integral
    length, dt = 2.0, 1 / 240
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    bob = world.create_body(Box(0.5, 0.3), position=(length * math.sin(angle), -length * math.cos(angle)), mass=3)
    rod = world.create_joint_distance(ground, bob, anchor1=(0, 0), anchor2=tuple(bob.position))
    assert rod.length == pytest.approx(length)
    crossings, before = [], bob.position.x
    for step in range(1, 1500):
        world.step(dt)
        x = bob.position.x
        if before > 0 >= x or before < 0 <= x:
            crossings.append((step - x / (x - before)) * dt)
        before = x
        assert rod.current_length == pytest.approx(length, abs=1e-4)
    period = 2 * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    a, b = 1.0, math.cos(angle / 2)
    for _ in range(10):
        a, b = (a + b) / 2, math.sqrt(a * b)
    assert period == pytest.approx(2 * math.pi * math.sqrt(length / GRAVITY) / a, rel=2e-3)
    assert bob.angle == pytest.approx(0.0, abs=1e-9), "nothing turns it"


@pytest.mark.parametrize("precision", PRECISIONS)
def test_hanging_still_it_carries_the_weight(precision: str) -> None:
    world = world_of_joints(gravity=(0, -GRAVITY), precision=precision)
    ground = world.create_body(kind="static")
    bob = world.create_body(Circle(0.2), position=(0, -2), mass=3)
    rod = world.create_joint_distance(ground, bob, anchor1=(0, 0), anchor2=(0, -2))
    run(world, 200)
    rounding = 1e-3 if precision == "single" else 1e-9
    assert tuple(rod.force) == pytest.approx((0, 3 * GRAVITY), abs=30 * rounding)
    assert rod.current_length - 2 == pytest.approx(GRAVITY / joint_omega(world) ** 2, abs=1e-5 * rounding / 1e-9 * 1e-3)
    assert rod.torque == 0.0


def test_it_pushes_as_well_as_it_pulls() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    bob = world.create_body(Circle(0.2), position=(0, 2), mass=3)
    rod = world.create_joint_distance(ground, bob, anchor1=(0, 0), anchor2=(0, 2))
    run(world, 120)
    assert rod.current_length - 2 == pytest.approx(-GRAVITY / joint_omega(world) ** 2, rel=1e-6)
    assert tuple(rod.force) == pytest.approx((0, 3 * GRAVITY), rel=1e-9, abs=1e-9)


def test_two_rods_off_the_middle_share_a_plank() -> None:
    # moments about its ends: the load is nearer to the second
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    plank = world.create_body(Box(2, 0.1), position=(0, -2), mass=3)
    rods = [
        world.create_joint_distance(ground, plank, anchor1=(x, 0), anchor2=(x, -2)) for x in (-1.0, 0.5)
    ]  # fmt: skip
    run(world, 400)
    assert rods[0].force.y == pytest.approx(3 * GRAVITY * 0.5 / 1.5, rel=1e-3)
    assert rods[1].force.y == pytest.approx(3 * GRAVITY * 1.0 / 1.5, rel=1e-3)


def test_length_set_at_any_time() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    bob = world.create_body(Circle(0.2), position=(0, -2), mass=3)
    rod = world.create_joint_distance(ground, bob, anchor1=(0, 0), anchor2=(0, -2))
    rod.length = 1.5
    run(world, 200)
    assert rod.current_length == pytest.approx(1.5, abs=1e-4)


def test_it_is_a_rod_while_it_has_neither_spring_nor_limits_nor_motor() -> None:
    # in whatever order these come and go
    def fresh(**more):
        world = world_of_joints(gravity=(0, -GRAVITY))
        ground = world.create_body(kind="static")
        bob = world.create_body(Circle(0.2), position=(0.3, -2), mass=3)
        return world.create_joint_distance(ground, bob, anchor1=(0, 0), anchor2=(0.3, -2), **more)

    rope = fresh(upper=2.5)
    late = fresh()
    late.upper = 2.5
    sprung = fresh(upper=2.5, hertz=4.0)
    sprung.hertz = None
    for joint in (rope, late, sprung):
        run(joint.world, 60)
    assert late.body2.position == rope.body2.position
    assert sprung.body2.position == rope.body2.position
    rope.upper = None
    rod = fresh(length=rope.length)
    rod.body2.position, rod.body2.velocity = rope.body2.position, rope.body2.velocity
    rod.body2.angular_velocity, rod.body2.angle = rope.body2.angular_velocity, rope.body2.angle
    run(rope.world, 60)
    run(rod.world, 60)
    assert tuple(rod.body2.position) == pytest.approx(tuple(rope.body2.position), abs=1e-9)
    motored = fresh()
    motored.motor_speed = 0.4
    run(motored.world, 30)
    h, n = DT / 4, 4 * 30
    assert motored.body2.position.y == pytest.approx(-2 - h * h * GRAVITY * n * (n + 1) / 2), "no force: it falls"
    motored.motor_speed = None
    length = motored.length
    run(motored.world, 200)
    assert motored.current_length == pytest.approx(length, abs=1e-2), "and now it is a rod"


def test_anchors_in_one_place_are_pushed_apart() -> None:
    world = world_of_joints(gravity=(0, 0))
    ground = world.create_body(kind="static")
    bob = world.create_body(Circle(0.2), position=(1, 1), mass=3)
    rod = world.create_joint_distance(ground, bob, anchor1=(1, 1), anchor2=(1, 1), length=0.5)
    run(world, 120)
    assert rod.current_length == pytest.approx(0.5, abs=1e-6)
    assert bob.position.x == pytest.approx(1.0)
