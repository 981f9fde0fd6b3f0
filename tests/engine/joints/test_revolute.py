"""The revolute joint: it holds, it swings, it gives way as a spring does, it keeps its bodies apart or not."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from engine import Box, Circle, RevoluteJoint, World
from tests.engine.worlds import DT, PRECISIONS, run

pytestmark = pytest.mark.kernel


def pendulum(precision: str, angle: float, length: float = 2.0, **settings) -> tuple[World, RevoluteJoint]:
    """A small disc on a pin at the origin, at rest at that angle from the vertical; its pin turns with it."""
    world = World(precision=precision, **settings)
    pin = world.create_body(Box(0.1, 0.1), kind="static")
    position = (length * math.sin(angle), -length * math.cos(angle))
    bob = world.create_body(Circle(0.2), position=position, mass=3)
    return world, world.create_joint_revolute(pin, bob, anchor=(0, 0))


def apart(joint: RevoluteJoint) -> float:
    a, b = joint.anchors
    return math.hypot(a.x - b.x, a.y - b.y)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_holds(precision: str) -> None:
    world, joint = pendulum(precision, 1.5)
    farthest = 0.0
    for _ in range(300):
        world.step(DT)
        farthest = max(farthest, apart(joint))
    assert 0 < farthest < 0.02


@pytest.mark.parametrize("angle", [0.05, 1.0])
def test_period_of_a_pendulum(angle: float) -> None:
    length, inertia = 2.0, 0.5 * 0.2**2  # per mass, about the bob's own centre
    world, joint = pendulum("double", angle, length)
    bob = joint.body2
    crossings, before = [], bob.position.x
    dt = 1 / 240
    for step in range(1, 2000):
        world.step(dt)
        x = bob.position.x
        if before > 0 >= x or before < 0 <= x:
            crossings.append((step - x / (x - before)) * dt)
        before = x
    period = 2 * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    small = 2 * math.pi * math.sqrt((length * length + inertia) / (10 * length))
    # the complete elliptic integral by the arithmetic-geometric mean
    a, b = 1.0, math.cos(angle / 2)
    for _ in range(10):
        a, b = (a + b) / 2, math.sqrt(a * b)
    assert period == pytest.approx(small / a, rel=2e-3)


def test_hanging_still_it_carries_the_weight() -> None:
    world, joint = pendulum("double", 0.0)
    run(world, 5)
    assert joint.impulse.y == pytest.approx(3 * 10 * DT, rel=1e-9)
    assert joint.impulse.x == pytest.approx(0.0, abs=1e-12)


def test_one_impulse_stops_both_anchors() -> None:
    # K P = -dv, solved exactly for one joint in one pass: afterwards the anchors move as one
    world = World(gravity=(0, 0), precision="double", iterations=1)
    a = world.create_body(Box(1, 3), position=(0, 0), velocity=(1, 2), angular_velocity=3, mass=2)
    b = world.create_body(Box(2, 1), position=(2, 1), velocity=(-3, 1), angular_velocity=-1, mass=5)
    joint = world.create_joint_revolute(a, b, anchor=(1, 0.2), collide_connected=False)
    momentum = world.diagnostics().momentum
    place = {body: body.position for body in (a, b)}
    world.step(DT)
    ends = []
    for body in (a, b):
        r = (1 - place[body].x, 0.2 - place[body].y)
        ends.append((body.velocity.x - body.angular_velocity * r[1], body.velocity.y + body.angular_velocity * r[0]))
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)
    assert tuple(world.diagnostics().momentum) == pytest.approx(tuple(momentum), rel=1e-14)
    assert b.velocity.x - -3 == pytest.approx(joint.impulse.x / 5, rel=1e-12)  # on body2


@pytest.mark.parametrize("passes", [1, 20])
def test_softness_is_a_spring_with_a_damper(passes: int) -> None:
    # x'' = -g - (k x + d x') / m by implicit Euler, step by step, whatever the number of passes
    mass, k, d, g = 2.0, 40.0, 3.0, 10.0
    softness, bias_factor = 1 / (DT * (d + DT * k)), DT * k / (d + DT * k)
    world = World(precision="double", iterations=passes, gravity=(0, -g))
    pin = world.create_body(Box(0.1, 0.1), kind="static")
    bob = world.create_body(Circle(0.2), mass=mass, position=(0, 0))
    world.create_joint_revolute(
        pin, bob, anchor=(0, 0), softness=softness, bias_factor=bias_factor, collide_connected=False
    )
    x = v = 0.0
    for _ in range(600):
        world.step(DT)
        v = (v - DT * (g + k * x / mass)) / (1 + DT * d / mass + DT * DT * k / mass)
        x += DT * v
        assert bob.position.y == pytest.approx(x, abs=1e-9)
    assert bob.position.y == pytest.approx(-mass * g / k, rel=1e-3)  # hangs as low as a spring would


def test_bias_factor_is_what_a_step_removes() -> None:
    for factor in (0.0, 0.2, 0.7, 1.0):
        world = World(gravity=(0, 0), precision="double")
        pin = world.create_body(Box(0.1, 0.1), kind="static")
        bob = world.create_body(Circle(0.2), position=(0, 0))
        joint = world.create_joint_revolute(pin, bob, anchor=(0, 0), bias_factor=factor, collide_connected=False)
        bob.position = (1, -2)
        world.step(DT)
        assert tuple(bob.position) == pytest.approx((1 - factor, -2 * (1 - factor)), abs=1e-12)
        assert joint.bias_factor == factor
    world.position_correction = False
    bob.position = (1, -2)
    bob.velocity = (0, 0)
    world.warm_starting = False
    world.step(DT)
    assert tuple(bob.position) == pytest.approx((1, -2), abs=1e-12)


def test_warm_starting_begins_with_the_impulses_of_the_step_before() -> None:
    settled = World(precision="double", iterations=60)
    bodies = [settled.create_body(Box(0.1, 0.1), kind="static")]
    for k in range(5):
        bodies.append(settled.create_body(Box(0.2, 0.8), position=(0, -0.5 - k)))
        settled.create_joint_revolute(bodies[k], bodies[k + 1], anchor=(0, -k), collide_connected=False)
    run(settled, 60)
    speeds = {}
    for warm in (True, False):
        world = World(precision="double")
        world.restore(settled.snapshot())
        world.set(iterations=1, warm_starting=warm)
        world.step(DT)
        speeds[warm] = np.abs(world.velocities).max()
    assert speeds[True] < 1e-4
    assert speeds[False] > 0.01


def test_default_bias_factor_is_box2d_lites() -> None:
    assert pendulum("double", 0.3)[1].bias_factor == float(np.float32(0.2))


@pytest.mark.parametrize("precision", PRECISIONS)
def test_collide_connected(precision: str) -> None:
    for collide in (True, False):
        world = World(gravity=(0, 0), precision=precision)
        a = world.create_body(Box(1, 1))
        other = world.create_body(Box(1, 1), position=(0.2, 0.1))
        b = world.create_body(Box(1, 1), position=(0.5, 0.5))
        joint = world.create_joint_revolute(b, a, anchor=(0.25, 0.25), collide_connected=collide)
        world.step(DT)
        met = {(arbiter.body1.serial, arbiter.body2.serial) for arbiter in world.arbiters}
        assert met == {(0, 1), (1, 2)} | ({(0, 2)} if collide else set())
        assert joint.collide_connected is collide
        joint.destroy()
        world.step(1e-6)
        assert (0, 2) in {(arbiter.body1.serial, arbiter.body2.serial) for arbiter in world.arbiters}
        assert other.alive


def test_destroyed_joint_lets_go_and_its_handle_is_stale() -> None:
    world, joint = pendulum("double", 0.5)
    assert world.joint_count == 1
    joint.destroy()
    assert world.joint_count == 0
    assert not joint.alive
    assert world.joints == []
    height = world.positions[1, 1]
    run(world, 10)
    assert world.positions[1, 1] == pytest.approx(height - 10 * DT * DT * 55, rel=1e-12)
    for name in ("body1", "body2", "impulse", "anchors", "softness", "bias_factor", "collide_connected"):
        with pytest.raises(ValueError, match=r"RevoluteJoint 0.*living"):
            getattr(joint, name)
    with pytest.raises(ValueError, match="living"):
        joint.destroy()
    with pytest.raises(ValueError, match="living"):
        joint.softness = 1.0
    assert repr(joint) == "<RevoluteJoint 0, destroyed>"


def test_joints_are_listed_in_the_order_of_creation() -> None:
    world = World()
    bodies = [world.create_body(Box(1, 1), position=(2 * k, 0)) for k in range(5)]
    joints = [world.create_joint_revolute(a, b, anchor=(0, 0)) for a, b in pairwise(bodies)]
    joints[1].destroy()
    late = world.create_joint_revolute(bodies[4], bodies[0], anchor=(0, 0))  # in the place of the destroyed one
    assert world.joints == [joints[0], joints[2], joints[3], late]
    assert (late.body1, late.body2) == (bodies[4], bodies[0])
    assert len({*world.joints, *joints}) == 5
    assert [record["joint"] for record in world.joint_records()] == [0, 2, 3, 4]


@pytest.mark.parametrize("mass", [1e-12, 1e12])
def test_any_mass_hangs_on_a_joint(mass: float) -> None:
    world = World(precision="single")
    pin = world.create_body(Box(1, 1), kind="static")
    bob = world.create_body(Box(1, 1), mass=mass, position=(2, 0))
    joint = world.create_joint_revolute(pin, bob, anchor=(0.6, 0), collide_connected=False)
    run(world, 60)
    assert apart(joint) < 0.02
