"""The motor joint: it comes to its pose within its force and torque, and holds it against no more than these."""

from __future__ import annotations

import math

import pytest

from engine import Box
from tests.engine.joints.making import GRAVITY, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run


def driven(**more):
    """A box of 3 kg, 2 m from where it is to be, and turned."""
    world = world_of_joints(**{"gravity": (0, 0), **more.pop("settings", {})})
    ground = world.create_body(kind="static", position=(1, 1), angle=0.5)
    box = world.create_body(Box(0.5, 0.5), position=(3, 1), angle=1.0, mass=3)
    return world.create_joint_motor(ground, box, **more)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_comes_to_its_pose(precision: str) -> None:
    joint = driven(offset=(0.5, -0.2), angle=0.3, settings={"precision": precision})
    run(joint.world, 120)
    box = joint.body2
    c, s = math.cos(0.5), math.sin(0.5)
    rounding = 1e-4 if precision == "single" else 1e-9
    assert tuple(box.position) == pytest.approx((1 + c * 0.5 + s * 0.2, 1 + s * 0.5 - c * 0.2), abs=rounding)
    assert box.angle == pytest.approx(0.5 + 0.3, abs=rounding)
    assert math.hypot(*box.velocity) < 10 * rounding


def test_left_out_it_holds_the_pose_as_it_is() -> None:
    joint = driven(settings={"gravity": (0, -GRAVITY)})
    start, angle = tuple(joint.body2.position), joint.body2.angle
    run(joint.world, 120)
    assert tuple(joint.body2.position) == pytest.approx(start, abs=1e-3)
    assert joint.body2.angle == pytest.approx(angle, abs=1e-9)
    assert joint.force.y == pytest.approx(3 * GRAVITY, rel=1e-6)
    assert joint.angle == pytest.approx(0.5)


def test_within_its_force_it_holds_and_beyond_it_slips() -> None:
    holds = driven(max_force=30.5, settings={"gravity": (0, -GRAVITY)})
    run(holds.world, 120)
    assert holds.body2.position.y == pytest.approx(1.0, abs=1e-3)
    assert holds.force.y == pytest.approx(30.0, rel=1e-6)

    slips = driven(max_force=27.0, settings={"gravity": (0, -GRAVITY)})
    run(slips.world, 60)
    h, n = DT / 4, 240
    assert slips.body2.velocity.y == pytest.approx(-(30 - 27) / 3 * 60 * DT, rel=1e-9)
    assert slips.body2.position.y == pytest.approx(1 - 1.0 * h * h * n * (n + 1) / 2, abs=1e-5)
    assert tuple(slips.force) == pytest.approx((0, 27.0), abs=1e-9)


def test_within_its_torque_it_turns_and_beyond_it_slips() -> None:
    # a constant torque on it: the motor gives at most its own
    for most, slips in ((2.2, False), (1.5, True)):
        joint = driven(max_torque=most)
        for _ in range(60):
            joint.body2.torque = 2.0
            joint.world.step(DT)
        if slips:
            assert joint.body2.angular_velocity == pytest.approx((2.0 - most) / joint.body2.inertia * 60 * DT, rel=1e-9)
            assert joint.torque == pytest.approx(-most, rel=1e-9)
        else:
            assert joint.body2.angle == pytest.approx(1.0, abs=1e-3)
            assert joint.torque == pytest.approx(-2.0, rel=1e-6)


def test_on_its_way_it_speeds_up_as_its_force_says() -> None:
    joint = driven(offset=(0, 0), max_force=6.0, max_torque=0.0)
    for step in range(1, 20):
        joint.world.step(DT)
        assert math.hypot(*joint.force) == pytest.approx(6.0, rel=1e-9)
        assert joint.body2.velocity.x == pytest.approx(-2.0 * step * DT, rel=1e-9)
        assert joint.torque == 0.0


def test_it_comes_to_its_pose_within_its_force_and_torque() -> None:
    # sprung, or there would be no braking ahead of the place
    joint = driven(
        offset=(0, 0), angle=0.0, max_force=6.0, max_torque=1.0, linear_hertz=0.15, angular_hertz=0.3,
    )  # fmt: skip
    for _ in range(1200):
        joint.world.step(DT)
        assert math.hypot(*joint.force) < 6.0 + 1e-9
        assert abs(joint.torque) < 1.0 + 1e-9
    assert tuple(joint.body2.position) == pytest.approx((1, 1), abs=1e-3)
    assert joint.body2.angle == pytest.approx(0.5, abs=1e-3)


def test_turning_it_speeds_up_as_its_torque_says() -> None:
    joint = driven(angle=3.0, max_torque=0.5)
    for step in range(1, 20):
        joint.world.step(DT)
        assert joint.torque == pytest.approx(0.5, rel=1e-9)
        assert joint.body2.angular_velocity == pytest.approx(0.5 / joint.body2.inertia * step * DT, rel=1e-9)


def test_no_torque_lets_it_turn_and_no_force_lets_it_move() -> None:
    joint = driven(max_torque=0.0, max_force=0.0)
    joint.body2.angular_velocity = 2.0
    joint.body2.velocity = (0.3, 0.4)
    run(joint.world, 60)
    assert joint.body2.angular_velocity == pytest.approx(2.0, rel=1e-12)
    assert tuple(joint.body2.velocity) == pytest.approx((0.3, 0.4), rel=1e-12)


def test_pose_and_strength_are_set_at_any_time() -> None:
    joint = driven(max_force=0.0, max_torque=0.0)
    run(joint.world, 10)
    joint.max_force = joint.max_torque = None
    assert (joint.max_force, joint.max_torque) == (None, None)
    joint.offset, joint.angle = (1.0, 0.0), -0.5
    assert tuple(joint.offset) == (1.0, 0.0)
    run(joint.world, 120)
    expected = (1 + math.cos(0.5), 1 + math.sin(0.5))
    assert tuple(joint.body2.position) == pytest.approx(expected, abs=1e-6)
    assert joint.body2.angle == pytest.approx(0.0, abs=1e-9)
    joint.max_force = 12.5
    assert joint.max_force == 12.5


def test_a_mover_on_a_moving_body() -> None:
    # over a kinematic body: the pose goes with it
    world = world_of_joints(gravity=(0, 0))
    ship = world.create_body(Box(1, 1), kind="kinematic", velocity=(1, 0))
    box = world.create_body(Box(0.2, 0.2), position=(0, 1), mass=1)
    world.create_joint_motor(ship, box, collide_connected=False)
    run(world, 120)
    assert tuple(box.velocity) == pytest.approx((1, 0), abs=1e-6)
    assert tuple(box.position) == pytest.approx((2, 1), abs=1e-2)
