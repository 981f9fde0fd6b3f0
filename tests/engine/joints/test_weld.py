"""The weld joint: a cantilever's force and torque at its root; two that are one; soft ones."""

from __future__ import annotations

import math

import pytest

from engine import Box, Circle
from tests.engine.joints.making import GRAVITY, joint_omega, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run

solvings = pytest.mark.parametrize("solving", ["iterated", "direct"])


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_cantilever_at_its_root(precision: str) -> None:
    world = world_of_joints(gravity=(0, -GRAVITY), precision=precision)
    wall = world.create_body(kind="static")
    beam = world.create_body(Box(2, 0.2), position=(1, 0), mass=3)
    weld = world.create_joint_weld(wall, beam, anchor=(0, 0))
    run(world, 300)
    rounding = 1e-3 if precision == "single" else 1e-6
    assert tuple(weld.force) == pytest.approx((0, 3 * GRAVITY), abs=30 * rounding)
    assert weld.torque == pytest.approx(3 * GRAVITY * 1.0 * math.cos(beam.angle), rel=rounding)
    # its angle gives way as its inertia about its middle says
    sag = 3 * GRAVITY / beam.inertia / joint_omega(world) ** 2
    assert beam.angle == pytest.approx(-sag, rel=0.02)
    assert weld.angle == beam.angle


@solvings
def test_a_cantilever_of_five_beams(solving: str) -> None:
    # at each weld the weight of all that is beyond it, and its moment
    world = world_of_joints(gravity=(0, -GRAVITY), joint_solving=solving, iterations=20 if solving == "iterated" else 1)
    last = world.create_body(kind="static")
    welds = []
    for k in range(5):
        beam = world.create_body(Box(1, 0.2), position=(k + 0.5, 0), mass=2)
        welds.append(world.create_joint_weld(last, beam, anchor=(k, 0), collide_connected=False))
        last = beam
    run(world, 300)
    for k, weld in enumerate(welds):
        beyond = 5 - k
        assert weld.force.y == pytest.approx(2 * GRAVITY * beyond, rel=1e-3)
        assert weld.torque == pytest.approx(2 * GRAVITY * beyond * beyond / 2, rel=0.02)


@solvings
def test_two_welded_bodies_fly_as_one(solving: str) -> None:
    world = world_of_joints(gravity=(0, 0), joint_solving=solving)
    a = world.create_body(Box(1, 0.5), position=(-0.5, 0), mass=2, velocity=(0, 1))
    b = world.create_body(Circle(0.3), position=(0.8, 0), mass=3)
    world.create_joint_weld(a, b, anchor=(0.2, 0), collide_connected=False)
    middle = (2 * -0.5 + 3 * 0.8) / 5
    inertia = a.inertia + b.inertia + 2 * (middle + 0.5) ** 2 + 3 * (0.8 - middle) ** 2
    spin = 2 * 1 * (-0.5 - middle) / inertia
    run(world, 120)
    assert a.angular_velocity == pytest.approx(spin, rel=1e-2)
    assert b.angular_velocity == pytest.approx(spin, rel=1e-2)
    assert (2 * a.velocity.y + 3 * b.velocity.y) / 5 == pytest.approx(2 / 5, rel=1e-12)
    assert b.angle == pytest.approx(a.angle, abs=1e-3)
    assert b.angle == pytest.approx(spin * 120 * DT, rel=1e-2)


def test_it_holds_the_pose_that_it_was_made_in() -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Box(1, 0.5), angle=0.4, mass=2)
    b = world.create_body(Box(1, 0.5), position=(1, 0.5), angle=-1.9, mass=2, velocity=(0.5, 0.2))
    weld = world.create_joint_weld(a, b, anchor=(0.5, 0.2), collide_connected=False)
    assert weld.angle == pytest.approx(0.0, abs=1e-15)
    assert weld.reference_angle == pytest.approx(-2.3)
    run(world, 60)
    assert b.angle - a.angle == pytest.approx(-2.3, abs=1e-3)
    first, second = weld.anchors
    assert tuple(first) == pytest.approx(tuple(second), abs=1e-3)


def test_a_soft_angle_sags_as_its_stiffness_says() -> None:
    hertz = 1.5
    world = world_of_joints(gravity=(0, -GRAVITY))
    wall = world.create_body(kind="static")
    beam = world.create_body(Box(1, 1), position=(0.5, 0), mass=3)
    weld = world.create_joint_weld(wall, beam, anchor=(0, 0), angular_hertz=hertz)
    run(world, 900)
    stiffness = beam.inertia * (2 * math.pi * hertz) ** 2
    assert weld.torque == pytest.approx(-stiffness * beam.angle, rel=1e-6)
    assert weld.torque == pytest.approx(3 * GRAVITY * 0.5 * math.cos(beam.angle), rel=1e-3)


def test_a_soft_point_sags_as_its_stiffness_says() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    wall = world.create_body(kind="static")
    ball = world.create_body(Circle(0.3), mass=3)
    weld = world.create_joint_weld(wall, ball, anchor=(0, 0), linear_hertz=2.0)
    run(world, 300)
    assert ball.position.y == pytest.approx(-GRAVITY / (4 * math.pi) ** 2, rel=1e-8)
    assert weld.force.y == pytest.approx(3 * GRAVITY, rel=1e-8)
