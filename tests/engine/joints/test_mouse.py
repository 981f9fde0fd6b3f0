"""The mouse joint: it draws a point to a target with at most its force."""

from __future__ import annotations

import math

import pytest

from engine import Box, Circle
from tests.engine.joints.making import GRAVITY, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run


def dragged(target=(3.0, 0.0), **more):
    world = world_of_joints(**{"gravity": (0, 0), **more.pop("settings", {})})
    ground = world.create_body(kind="static")
    ball = world.create_body(Circle(0.3), mass=2)
    joint = world.create_joint_mouse(ground, ball, **{"target": (0, 0), **more})
    joint.target = target
    return joint


def test_it_drags_with_at_most_its_force() -> None:
    joint = dragged(max_force=5.0)
    for step in range(1, 31):
        joint.world.step(DT)
        assert math.hypot(*joint.force) == pytest.approx(5.0, rel=1e-9)
        assert joint.body2.velocity.x == pytest.approx(2.5 * step * DT, rel=1e-9)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_comes_to_the_target_and_follows_it(precision: str) -> None:
    joint = dragged(settings={"precision": precision})
    rounding = 1e-4 if precision == "single" else 1e-6
    for target in ((3.0, 0.0), (-1.0, 2.5)):
        joint.target = target
        assert tuple(joint.target) == pytest.approx(target, abs=1e-12)
        run(joint.world, 240)
        assert tuple(joint.body2.position) == pytest.approx(target, abs=rounding)


def test_a_weight_hangs_below_the_target_as_stiffness_says() -> None:
    joint = dragged((0.0, 0.0), hertz=3.0, settings={"gravity": (0, -GRAVITY)})
    run(joint.world, 240)
    assert joint.body2.position.y == pytest.approx(-GRAVITY / (2 * math.pi * 3) ** 2, rel=1e-8)
    assert tuple(joint.force) == pytest.approx((0, 2 * GRAVITY), abs=1e-6)


def test_too_heavy_a_weight_falls() -> None:
    joint = dragged((0.0, 0.0), max_force=15.0, settings={"gravity": (0, -GRAVITY)})
    run(joint.world, 120)
    fell = joint.body2.velocity.y
    run(joint.world, 30)
    assert joint.body2.velocity.y - fell == pytest.approx(-(20 - 15) / 2 * 30 * DT, rel=1e-9)
    assert joint.force.y == pytest.approx(15.0, rel=1e-9)


def test_held_off_its_middle_a_body_hangs_below_the_target() -> None:
    # a pendulum on a stiff spring: it swings about where it hangs straight
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    plank = world.create_body(Box(1, 0.2), mass=2)
    joint = world.create_joint_mouse(ground, plank, target=(0.5, 0), hertz=4.0, damping_ratio=1.0)
    assert tuple(joint.anchors[1]) == pytest.approx((0.5, 0.0))
    plank.position, plank.angle = (0.5, -0.55), math.pi / 2
    run(world, 240)
    assert plank.position.x == pytest.approx(0.5, abs=1e-6)
    stiffness = 2 * (2 * math.pi * 4) ** 2  # straight below, the lever is nothing
    assert plank.position.y == pytest.approx(-0.5 - 2 * GRAVITY / stiffness, rel=1e-6)
    assert joint.force.y == pytest.approx(2 * GRAVITY, rel=1e-6)
    assert joint.torque == 0.0


def test_properties_are_set_at_any_time() -> None:
    joint = dragged(max_force=0.0)
    run(joint.world, 10)
    assert joint.body2.position.x == 0.0
    joint.max_force, joint.hertz, joint.damping_ratio = None, 8.0, 1.0
    assert (joint.max_force, joint.hertz, joint.damping_ratio) == (None, 8.0, 1.0)
    run(joint.world, 240)
    assert joint.body2.position.x == pytest.approx(3.0, abs=1e-8)
    joint.hertz = None
    assert joint.hertz is None


def test_body1_carries_the_target() -> None:
    world = world_of_joints(gravity=(0, 0))
    boat = world.create_body(Box(1, 1), kind="kinematic", velocity=(1, 0))
    ball = world.create_body(Circle(0.2), position=(0, 3), mass=1)
    joint = world.create_joint_mouse(boat, ball, target=(0, 3), hertz=5.0, damping_ratio=1.0)
    run(world, 240)
    assert tuple(joint.target) == pytest.approx((4, 3), abs=1e-9)
    assert tuple(ball.velocity) == pytest.approx((1, 0), abs=1e-6)
