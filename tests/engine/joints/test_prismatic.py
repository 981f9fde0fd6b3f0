"""The prismatic joint: a slide on an incline; it neither leaves its line nor turns, and tells what it holds."""

from __future__ import annotations

import math

import pytest

from engine import Box
from tests.engine.joints.making import GRAVITY, joint_omega, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("angle", [0.4, -1.1, math.pi / 2])
def test_down_an_incline_it_falls_with_g_sin(angle: float, precision: str) -> None:
    world = world_of_joints(gravity=(0, -GRAVITY), precision=precision)
    ground = world.create_body(kind="static")
    box = world.create_body(Box(0.5, 0.3), position=(1, 2), angle=0.7, mass=3)
    axis = (math.cos(angle), math.sin(angle))
    slide = world.create_joint_prismatic(ground, box, anchor=(1, 2), axis=(2 * axis[0], 2 * axis[1]))
    h, n = DT / 4, 4 * 60
    run(world, 60)
    rounding = 2e-4 if precision == "single" else 1e-9
    assert slide.translation == pytest.approx(-GRAVITY * axis[1] * h * h * n * (n + 1) / 2, rel=rounding)
    assert box.angle == pytest.approx(0.7, abs=rounding)
    # what it holds is the weight across, and nothing along
    across = 3 * GRAVITY * axis[0]
    assert tuple(slide.force) == pytest.approx((-across * axis[1], across * axis[0]), abs=30 * rounding)
    assert slide.torque == pytest.approx(0.0, abs=rounding)
    give = abs(GRAVITY * axis[0]) / joint_omega(world) ** 2
    far = (box.position.x - 1) * -axis[1] + (box.position.y - 2) * axis[0]
    assert abs(far) == pytest.approx(give, abs=10 * rounding)
    assert tuple(slide.axis) == pytest.approx(axis, abs=rounding)


def test_an_arm_beside_the_line_is_held_with_the_torque_of_its_weight() -> None:
    # level slide in which nothing moves along: an anchor 0.6 m beside the middle
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    box = world.create_body(Box(0.5, 0.5), position=(0.6, 0), mass=3)
    slide = world.create_joint_prismatic(ground, box, anchor=(0, 0), axis=(1, 0), upper=0.0, lower=0.0)
    run(world, 400)
    assert slide.force.y == pytest.approx(3 * GRAVITY, rel=1e-6)
    assert slide.torque == pytest.approx(3 * GRAVITY * 0.6, rel=1e-3)
    assert box.angular_velocity == pytest.approx(0.0, abs=1e-9)


def test_a_spring_along_a_vertical_slide_sags_as_its_stiffness_says() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    box = world.create_body(Box(0.5, 0.5), mass=3)
    slide = world.create_joint_prismatic(ground, box, anchor=(0, 0), axis=(0, 1), hertz=2.0)
    run(world, 240)
    assert slide.translation == pytest.approx(-GRAVITY / (2 * math.pi * 2.0) ** 2, rel=1e-8)
    assert tuple(slide.force) == pytest.approx((0, 3 * GRAVITY), rel=1e-8, abs=1e-9)


def test_the_axis_turns_with_body1() -> None:
    # a rail on a kinematic body that turns: the rider is carried round, flung out as in a centrifuge r = r0 cosh(w t)
    world = world_of_joints(gravity=(0, 0), substeps=32)
    rail = world.create_body(Box(0.1, 0.1), kind="kinematic", angular_velocity=1.5)
    bead = world.create_body(Box(0.01, 0.01), position=(1, 0), velocity=(0, 1.5), angular_velocity=1.5, mass=2)
    slide = world.create_joint_prismatic(rail, bead, anchor=(0, 0), axis=(1, 0), collide_connected=False)
    for step in range(1, 61):
        world.step(DT)
        if step % 20 == 0:
            t = step * DT
            assert math.hypot(*bead.position) == pytest.approx(math.cosh(1.5 * t), rel=5e-3)
            assert math.atan2(bead.position.y, bead.position.x) == pytest.approx(1.5 * t, abs=1e-3)
            assert bead.angle == pytest.approx(1.5 * t, abs=1e-3)
            assert slide.translation == pytest.approx(math.cosh(1.5 * t) - 1, rel=1e-2)


def test_either_body_may_be_the_static_one() -> None:
    ends = []
    for first in (True, False):
        world = world_of_joints(gravity=(0, -GRAVITY))
        ground = world.create_body(kind="static")
        box = world.create_body(Box(0.5, 0.3), mass=3)
        bodies = (ground, box) if first else (box, ground)
        slide = world.create_joint_prismatic(*bodies, anchor=(0, 0), axis=(3, 4))
        run(world, 60)
        ends.append(box.position)
        assert slide.translation == pytest.approx(-(1 if first else -1) * math.hypot(*box.position), rel=1e-4)
    assert tuple(ends[0]) == pytest.approx(tuple(ends[1]), abs=1e-9)
