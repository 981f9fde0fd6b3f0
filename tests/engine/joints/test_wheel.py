"""The wheel joint: the suspension sags, the wheel turns freely or by its motor, a cart drives."""

from __future__ import annotations

import math

import pytest

from engine import Box, Circle
from tests.engine.joints.making import GRAVITY, joint_omega, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, floor, run


def cart(hertz: float | None = 2.0, **settings):
    """A chassis of 10 kg on two wheels of 1 kg each, on a floor."""
    world = world_of_joints(**{"gravity": (0, -GRAVITY), **settings})
    floor(world, friction=1.0)
    chassis = world.create_body(Box(2, 0.4), position=(0, 0.8), mass=10)
    wheels, joints = [], []
    for x in (-0.8, 0.8):
        wheel = world.create_body(Circle(0.3), position=(x, 0.3), mass=1, friction=1.0)
        joints.append(
            world.create_joint_wheel(
                chassis, wheel, anchor=(x, 0.3), axis=(0, 1), hertz=hertz, damping_ratio=0.7, collide_connected=False
            )
        )
        wheels.append(wheel)
    return world, chassis, wheels, joints


@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_suspension_sags_as_its_stiffness_says(precision: str) -> None:
    hertz = 2.0
    world, chassis, _, joints = cart(hertz, precision=precision)
    run(world, 600)
    # the mass that a spring holds: 1/m = 1/m1 + 1/m2 + a^2/I1 at 0.8 m from the middle
    effective = 1 / (1 / 10 + 1 / 1 + 0.8**2 / chassis.inertia)
    stiffness = effective * (2 * math.pi * hertz) ** 2
    for joint in joints:
        assert joint.translation == pytest.approx(10 * GRAVITY / 2 / stiffness, rel=2e-3)
        assert joint.force.y == pytest.approx(-10 * GRAVITY / 2, rel=2e-3)
        assert joint.torque == pytest.approx(0.0, abs=1e-3)


def test_the_wheel_turns_freely() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    wheel = world.create_body(Circle(0.3), position=(0, 1), mass=2, angular_velocity=7.0)
    joint = world.create_joint_wheel(ground, wheel, anchor=(0, 1), axis=(0, 1), hertz=3.0, damping_ratio=1.0)
    run(world, 120)
    assert wheel.angular_velocity == pytest.approx(7.0, rel=1e-12)
    assert joint.speed == pytest.approx(7.0, rel=1e-12)
    assert joint.angle == pytest.approx(7.0 * 120 * DT, rel=1e-9)
    assert joint.translation == pytest.approx(-GRAVITY / (2 * math.pi * 3) ** 2, rel=1e-5)


def test_across_the_axis_it_is_held() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    wheel = world.create_body(Circle(0.3), mass=2)
    joint = world.create_joint_wheel(ground, wheel, anchor=(0, 0), axis=(1, 0), hertz=2.0)
    run(world, 120)
    assert wheel.position.y == pytest.approx(-GRAVITY / joint_omega(world) ** 2, rel=1e-6)
    assert tuple(joint.force) == pytest.approx((0, 2 * GRAVITY), abs=1e-6)


def test_without_a_spring_it_slides_freely() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    wheel = world.create_body(Circle(0.3), mass=2)
    joint = world.create_joint_wheel(ground, wheel, anchor=(0, 0), axis=(0, 1), hertz=None)
    run(world, 30)
    h, n = DT / 4, 120
    assert joint.translation == pytest.approx(-GRAVITY * h * h * n * (n + 1) / 2, rel=1e-9)


def test_a_cart_speeds_up_as_the_motors_torque_says_and_keeps_the_wheels_speed() -> None:
    # while the wheels roll: m a = 2 T / r, m being 12 kg and what the wheels' inertia adds, 2 I / r^2 = 1 kg
    world, chassis, wheels, joints = cart(4.0)
    run(world, 300)
    torque = 1.0
    for joint in joints:
        joint.motor_speed, joint.max_motor_torque = -5.0, torque
    run(world, 60)
    rate = 2 * torque / 0.3 / (12 + 2 * wheels[0].inertia / 0.3**2)
    assert chassis.velocity.x == pytest.approx(rate * 60 * DT, rel=0.03)
    for joint in joints:
        assert joint.motor_torque == pytest.approx(-torque, rel=1e-6)
    run(world, 600)
    assert chassis.velocity.x == pytest.approx(5.0 * 0.3, rel=0.02)
    for wheel in wheels:
        assert wheel.angular_velocity - chassis.angular_velocity == pytest.approx(-5.0, rel=1e-3)
    for joint in joints:
        joint.motor_speed = 0.0
    run(world, 600)
    assert chassis.velocity.x == pytest.approx(0.0, abs=1e-3), "it brakes"


def test_limits_stop_the_suspension() -> None:
    world, _, _, joints = cart(0.5)
    for joint in joints:
        joint.lower, joint.upper = -0.1, 0.05
    run(world, 400)
    for joint in joints:
        assert joint.translation == pytest.approx(0.05, abs=2e-3)
        assert joint.force.y == pytest.approx(-10 * GRAVITY / 2, rel=1e-2)
