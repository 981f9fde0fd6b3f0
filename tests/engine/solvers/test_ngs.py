"""ngs against a slow reference, and what it promises: no velocity from overlap, and joints that close."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Circle, World
from engine.constants import SLOP
from engine.solvers.ngs import MOST, PART, POSITION_PASSES, VELOCITY_PASSES
from tests.engine.worlds import DT, floor, run
from tests.naive.ngs import NaiveStep

G = 10.0


def new(**settings) -> World:
    return World(**{"solver": "ngs", "precision": "double", **settings})


def heap() -> World:
    """Boxes and discs on each other and on a floor, two of them pinned together, one hanging."""
    world = new(iterations=7)
    floor(world, 0.5)
    rng = np.random.default_rng(4)
    bodies = [
        world.create_body(
            Box(0.8, 0.6) if k % 2 else Circle(0.4),
            position=(0.35 * (k % 3), 0.42 + 0.72 * k),
            angle=0.1 * k,
            friction=0.5,
            velocity=tuple(rng.uniform(-0.5, 0.5, 2)),
            mass=1.0 + k,
        )
        for k in range(5)
    ]
    world.create_joint_revolute(bodies[3], bodies[4], anchor=(0.3, 3.0), collide_connected=False)
    top = world.create_body(kind="static", position=(3, 4))
    hanging = world.create_body(Box(0.2, 1), position=(3.4, 3.6), angle=0.7)
    world.create_joint_revolute(top, hanging, anchor=(3, 4))
    return world


def test_it_does_what_the_slow_reference_does() -> None:
    world, most = heap(), 0
    for step in range(40):
        most = max(most, len(world.contact_records()))
        slow = NaiveStep(world, DT)  # reads the state before the step, and the contacts afterwards
        world.step(DT)
        slow.solve(world, passes=(7 * POSITION_PASSES + VELOCITY_PASSES - 1) // VELOCITY_PASSES, part=PART, most=MOST)
        np.testing.assert_allclose(world.velocities, slow.velocities[:, :2], atol=1e-9, err_msg=f"step {step}")
        np.testing.assert_allclose(world.positions, slow.places[:, :2], atol=1e-9, err_msg=f"step {step}")
        np.testing.assert_allclose(world.angles, slow.places[:, 2], atol=1e-9)
    assert most >= 4


def test_overlap_is_pushed_out_without_a_speed() -> None:
    world = new(gravity=(0, 0))
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 0.4))
    depths = []
    for _ in range(60):
        world.step(DT)
        depths.append(0.5 - box.position.y)
        assert tuple(box.velocity) == (0, 0)
    assert depths == sorted(depths, reverse=True)
    assert depths[-1] == pytest.approx(SLOP, abs=1e-4)


def test_without_position_correction_overlap_stays() -> None:
    world = new(gravity=(0, 0), position_correction=False)
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 0.4))
    run(world, 20)
    assert box.position.y == 0.4


def test_what_falls_stops_where_it_touches() -> None:
    # while it is apart it may come just so near, so it neither sinks in nor stops above
    world = new()
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 1.0), velocity=(0, -7))
    run(world, 30)
    assert box.position.y == pytest.approx(0.5, abs=1e-5)


def test_a_joint_that_was_torn_apart_closes() -> None:
    world = new(gravity=(0, 0))
    a, b = (world.create_body(Box(1, 0.5), position=(1.1 * k, 0), angle=0.3 * k) for k in range(2))
    joint = world.create_joint_revolute(a, b, anchor=(0.5, 0.1), collide_connected=False)
    b.position = (1.3, 0.2)
    before = world.diagnostics()
    gaps = []
    for _ in range(6):
        world.step(DT)
        one, two = joint.anchors
        gaps.append(math.hypot(two.x - one.x, two.y - one.y))
    assert gaps[0] < 0.01
    assert gaps[-1] < 1e-12
    assert tuple(world.diagnostics().momentum) == tuple(before.momentum) == (0, 0)
    assert np.abs(world.velocities).max() == 0.0


@pytest.mark.parametrize("kind", ["prismatic", "weld", "distance", "wheel"])
def test_rigid_joints_hold(kind: str) -> None:
    world = new(iterations=20)
    top = world.create_body(kind="static", position=(0, 3))
    box = world.create_body(Box(0.4, 0.4), position=(0.8, 3), mass=2)
    if kind == "distance":
        world.create_joint_distance(top, box, anchor1=(0, 3), anchor2=(0.9, 3.1))
    elif kind == "weld":
        world.create_joint_weld(top, box, anchor=(0, 3))
    else:
        make = getattr(world, f"create_joint_{kind}")
        make(top, box, anchor=(0.8, 3), axis=(0.6, 0.8), **({"hertz": None} if kind == "wheel" else {}))
    away = 0.0
    for _ in range(60):
        world.step(DT)
        x, y = box.position
        if kind == "distance":
            (a, b) = world.joints[0].anchors
            away = max(away, abs(math.hypot(b.x - a.x, b.y - a.y) - math.hypot(0.9, 0.1)))
        elif kind == "weld":
            away = max(away, math.hypot(x - 0.8, y - 3), abs(box.angle))
        else:
            away = max(away, abs(0.8 * (x - 0.8) - 0.6 * (y - 3)))
    assert away < (3e-3 if kind == "weld" else 1e-6)  # whose angle and point are two constraints, that share its load
    if kind == "prismatic":  # it slides as on an incline
        assert math.hypot(*box.velocity) == pytest.approx(0.8 * G, rel=1e-6)


def test_a_limit_stops_and_a_motor_is_as_strong_as_it_is() -> None:
    world = new(gravity=(0, 0), iterations=20)
    top = world.create_body(kind="static")
    arm = world.create_body(Box(1, 0.2), position=(0.5, 0), mass=1)
    joint = world.create_joint_revolute(top, arm, anchor=(0, 0), upper=0.5, motor_speed=3.0, max_motor_torque=0.4)
    inertia = arm.inertia + arm.mass * 0.25
    world.step(DT)
    assert joint.motor_torque == pytest.approx(0.4)
    assert arm.angular_velocity == pytest.approx(0.4 * DT / inertia, rel=1e-6)
    run(world, 300)
    assert joint.angle == pytest.approx(0.5, abs=1e-9)
    assert arm.angular_velocity == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("solver", ["ngs", "direct"])
@pytest.mark.parametrize("dt", [1 / 60, 1 / 240])
def test_a_spring_takes_its_implicit_step(dt: float, solver: str) -> None:
    hertz, ratio, x, v = 2.0, 0.3, 0.2, 0.0
    world = new(gravity=(0, 0), solver=solver)
    ground = world.create_body(kind="static")
    body = world.create_body(Circle(0.2), position=(0, 0), mass=3)
    world.create_joint_prismatic(ground, body, anchor=(0, 0), axis=(1, 0), hertz=hertz, damping_ratio=ratio)
    body.position = (x, 0)
    omega = 2 * math.pi * hertz
    for _ in range(100):
        v = (v - dt * omega * omega * x) / (1 + 2 * ratio * omega * dt + dt * dt * omega * omega)
        x += dt * v
        world.step(dt)
        assert body.position.x == pytest.approx(x, abs=1e-10)


@pytest.mark.parametrize("solver", ["ngs", "direct"])
@pytest.mark.parametrize("e", [0.5, 1.0])
def test_a_ball_bounces_with_its_restitution(e: float, solver: str) -> None:
    world = new(solver=solver)
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 1.5), restitution=e)
    before = 0.0
    while ball.velocity.y <= 0:
        before = ball.velocity.y
        world.step(DT)
    assert ball.velocity.y == pytest.approx(-e * before, rel=1e-12)


@pytest.mark.parametrize("solver", ["ngs", "direct"])
@pytest.mark.parametrize("kind", ["motor", "mouse"])
def test_what_it_lacks_it_refuses_by_name(kind: str, solver: str) -> None:
    world = new(solver=solver)
    a, b = (world.create_body(Circle(0.3), position=(k, 0)) for k in range(2))
    more = {"target": (1, 0)} if kind == "mouse" else {}
    with pytest.raises(ValueError, match=f"solver = '{solver}': must be one that knows {kind} joints"):
        getattr(world, f"create_joint_{kind}")(a, b, **more)
    with pytest.raises(ValueError, match=r"^rolling_resistance = 0\.1: must be 0\.0 with the solver"):
        world.create_body(Circle(0.3), rolling_resistance=0.1)


@pytest.mark.parametrize("solver", ["ngs", "direct"])
def test_a_restored_step_is_the_same(solver: str) -> None:
    world = heap()
    world.solver = solver
    run(world, 15)
    kept = world.snapshot()
    expected = run(world, 10).state_hash()
    other = World(precision="double")
    other.restore(kept)
    assert run(other, 10).state_hash() == expected
