"""The revolute joint: it holds, it swings, it gives way as a spring does, it keeps its bodies apart or not."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from engine import SOLVERS, Box, Circle, RevoluteJoint, World
from tests.engine.worlds import DT, PRECISIONS, run, talk

pytestmark = pytest.mark.kernel

either = pytest.mark.parametrize("solver", SOLVERS)


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


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_holds(precision: str, solver: str) -> None:
    world, joint = pendulum(precision, 1.5, solver=solver)
    farthest = 0.0
    for _ in range(300):
        world.step(DT)
        farthest = max(farthest, apart(joint))
    assert 0 < farthest < 0.02


@either
@pytest.mark.parametrize("angle", [0.05, 1.0])
def test_period_of_a_pendulum(angle: float, solver: str) -> None:
    length, inertia = 2.0, 0.5 * 0.2**2  # per mass, about the bob's own centre
    world, joint = pendulum("double", angle, length, solver=solver)
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
    # what projects velocities once a step loses of them what the rod turns: w^2 dt / 2 a second, of the first order
    assert period == pytest.approx(small / a, rel={"ngs": 3e-3, "direct": 3e-3, "avbd": 2e-2}.get(solver, 2e-3))


@either
def test_hanging_still_it_carries_the_weight(solver: str) -> None:
    world, joint = pendulum("double", 0.0, solver=solver)
    run(world, 5 if solver == "sequential_impulses" else 120)
    assert joint.impulse.y == pytest.approx(3 * 10 * DT, rel=1e-9)
    assert joint.impulse.x == pytest.approx(0.0, abs=1e-12)


def test_one_impulse_stops_both_anchors() -> None:
    # K P = -dv, solved exactly for one joint in one pass: afterwards the anchors move as one
    world = talk(gravity=(0, 0), precision="double", iterations=1)
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


def test_after_a_soft_step_both_anchors_move_as_one() -> None:
    world = World(gravity=(0, 0), precision="double")
    a = world.create_body(Box(1, 3), position=(0, 0), velocity=(1, 2), angular_velocity=3, mass=2)
    b = world.create_body(Box(2, 1), position=(2, 1), velocity=(-3, 1), angular_velocity=-1, mass=5)
    joint = world.create_joint_revolute(a, b, anchor=(1, 0.2), collide_connected=False)
    momentum = world.diagnostics().momentum
    world.step(DT)
    ends = [tuple(body.velocity_at(end)) for body, end in zip((a, b), joint.anchors, strict=True)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-4)  # how far the angles within a step lag behind: angle^3 / 12
    assert tuple(world.diagnostics().momentum) == pytest.approx(tuple(momentum), rel=1e-14)


@pytest.mark.parametrize("passes", [1, 20])
def test_softness_is_a_spring_with_a_damper(passes: int) -> None:
    # x'' = -g - (k x + d x') / m by implicit Euler, step by step, whatever the number of passes
    mass, k, d, g = 2.0, 40.0, 3.0, 10.0
    softness, bias_factor = 1 / (DT * (d + DT * k)), DT * k / (d + DT * k)
    world = talk(precision="double", iterations=passes, gravity=(0, -g))
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


SPRING = {"mass": 2.0, "k": 40.0, "d": 3.0}


def hanging_on_a_spring(mass: float, k: float, d: float, **settings) -> tuple[World, RevoluteJoint]:
    """A disc on a spring k [N/m] with a damper d [N s/m], at rest where the spring is slack."""
    world = World(precision="double", **settings)
    pin = world.create_body(Box(0.1, 0.1), kind="static")
    bob = world.create_body(Circle(0.2), mass=mass)
    softness, bias_factor = 1 / (DT * (d + DT * k)), DT * k / (d + DT * k)
    return world, world.create_joint_revolute(
        pin, bob, anchor=(0, 0), softness=softness, bias_factor=bias_factor, collide_connected=False
    )


@pytest.mark.parametrize(
    ("solver", "substeps"), [("soft_step", 1), ("soft_step", 4), ("soft_step", 9), ("sequential_impulses", 1)]
)
def test_a_spring_hangs_as_low_as_the_weight_pulls_it(solver: str, substeps: int) -> None:
    world, joint = hanging_on_a_spring(2.0, 40.0, 12.0, solver=solver, substeps=substeps, sleeping=False)
    run(world, 400)
    assert joint.body2.position.y == pytest.approx(-2.0 * 10 / 40, rel=1e-6)  # m g / k
    assert joint.impulse.y == pytest.approx(2.0 * 10 * DT, rel=1e-6)


def test_a_spring_in_substeps_comes_nearer_to_the_oscillator() -> None:
    # m x'' = -m g - k x - d x', from rest at x = 0
    mass, k, d = SPRING.values()
    decay, sag = d / (2 * mass), mass * 10 / k
    omega = math.sqrt(k / mass - decay * decay)
    errors = []
    for substeps in (1, 4, 16):
        world, joint = hanging_on_a_spring(**SPRING, substeps=substeps)
        worst = 0.0
        for step in range(1, 181):
            world.step(DT)
            t = step * DT
            swing = math.cos(omega * t) + decay / omega * math.sin(omega * t)
            worst = max(worst, abs(joint.body2.position.y - sag * (math.exp(-decay * t) * swing - 1)))
        errors.append(worst)
    assert errors[0] < 0.15 * sag
    assert errors[1] < 0.4 * errors[0]
    assert errors[2] < 0.4 * errors[1]


@pytest.mark.parametrize("settings", [{}, {"substeps": 8}, {"stiffness": "fixed", "joint_hertz": 20.0}])
def test_a_rigid_joint_gives_way_as_its_frequency_says(settings: dict) -> None:
    # a spring of m_eff w^2 in each joint, w = 2 pi f; f a quarter of the substep rate where it follows
    hertz = settings.get("joint_hertz", settings.get("substeps", 4) / DT / 4)
    omega = 2 * math.pi * hertz
    world, joint = pendulum("double", 0.0, **settings)
    run(world, 240)
    assert -2.0 - joint.body2.position.y == pytest.approx(10 / omega**2, rel=1e-3)

    # a plank on two pins: at its ends it gives way with 1/m_eff = 1/m + a^2/I, and each carries half of the weight
    world = World(precision="double", joint_solving="iterated", **settings)
    plank, pins = Box(2, 0.2), [world.create_body(Circle(0.1), position=(x, 0), kind="static") for x in (-1, 1)]
    body = world.create_body(plank, mass=3)
    for pin in pins:
        world.create_joint_revolute(pin, body, anchor=tuple(pin.position), collide_connected=False)
    run(world, 240)
    effective = 1 / (1 / 3 + 1 / plank.inertia(3))
    assert -body.position.y == pytest.approx(3 * 10 / 2 / (effective * omega**2), rel=0.02)


def test_bias_factor_is_what_a_soft_step_removes() -> None:
    # in n substeps, each its part of the rate
    for factor in (0.0, 0.2, 0.7, 1.0):
        world = World(gravity=(0, 0), precision="double")
        pin = world.create_body(Box(0.1, 0.1), kind="static")
        bob = world.create_body(Circle(0.2), position=(0, 0))
        joint = world.create_joint_revolute(pin, bob, anchor=(0, 0), bias_factor=factor, collide_connected=False)
        bob.position = (1, -2)
        world.step(DT)
        left = (1 - factor / 4) ** 4
        assert tuple(bob.position) == pytest.approx((left, -2 * left), abs=1e-12)
        assert tuple(bob.velocity) == pytest.approx((0, 0), abs=1e-9), "relaxed"
        assert joint.bias_factor == factor
        world.position_correction = False
        world.step(DT)
        assert tuple(bob.position) == pytest.approx((left, -2 * left), abs=1e-12)


def test_bias_factor_is_what_a_step_removes() -> None:
    for factor in (0.0, 0.2, 0.7, 1.0):
        world = talk(gravity=(0, 0), precision="double")
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
    settled = talk(precision="double", iterations=60)
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


def test_default_bias_factor_is_the_solvers_own() -> None:
    # Box2D Lite's in the talk's solver; soft_step's are springs; others correct positions, whatever the factor
    pulled = {}
    for factor in (None, float(np.float32(0.2))):
        for solver in SOLVERS:
            world, joint = pendulum("double", 0.3, solver=solver)
            joint.bias_factor = factor
            assert joint.bias_factor == factor
            joint.body2.position += (0.1, 0.1)
            pulled[factor, solver] = run(world, 5).state_hash()
    assert len(set(pulled.values())) == 7
    for solver in ("ngs", "xpbd", "avbd", "direct"):
        assert pulled[None, solver] == pulled[float(np.float32(0.2)), solver]
    assert pulled[None, "sequential_impulses"] == pulled[float(np.float32(0.2)), "sequential_impulses"]


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_collide_connected(precision: str, solver: str) -> None:
    gently = solver in ("soft_step", "sequential_impulses")  # others may part two within the step
    for collide in (True, False):
        world = World(gravity=(0, 0), precision=precision, solver=solver, position_correction=gently)
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
    assert world.positions[1, 1] == pytest.approx(height - 10 * (DT / 4) ** 2 * 40 * 41 / 2, rel=1e-12)
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


@either
@pytest.mark.parametrize("mass", [1e-12, 1e12])
def test_any_mass_hangs_on_a_joint(mass: float, solver: str) -> None:
    world = World(precision="single", solver=solver)
    pin = world.create_body(Box(1, 1), kind="static")
    bob = world.create_body(Box(1, 1), mass=mass, position=(2, 0))
    joint = world.create_joint_revolute(pin, bob, anchor=(0.6, 0), collide_connected=False)
    run(world, 60)
    assert apart(joint) < 0.02
