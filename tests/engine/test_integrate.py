"""Motion without contacts, exactly: symplectic Euler has closed forms, in steps or in substeps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, Box, Circle, World
from engine.trigonometry import cos_sin
from tests.engine.worlds import DT, PRECISIONS, run

pytestmark = pytest.mark.kernel


either = pytest.mark.parametrize("solver", SOLVERS)
METHODS = [("soft_step", 1), ("soft_step", 4), ("soft_step", 7), ("sequential_impulses", 1)]


@pytest.mark.parametrize(("solver", "substeps"), METHODS)
@pytest.mark.parametrize("dt", [1 / 60, 1 / 240, 0.1])
def test_free_fall_lags_by_g_h_t_over_two(dt: float, solver: str, substeps: int) -> None:
    world, h = World(precision="double", solver=solver, substeps=substeps), dt / substeps
    body = world.create_body(Box(1, 2), position=(3, 7), velocity=(2, 5))
    for step in range(1, 301):
        world.step(dt)
        t = step * dt
        assert body.velocity.y == pytest.approx(5 - 10 * t, rel=1e-12, abs=1e-12)
        parabola = 7 + 5 * t - 5 * t * t
        assert body.position.y - parabola == pytest.approx(-10 * h * t / 2, rel=1e-9, abs=1e-10)
        assert body.position.x == pytest.approx(3 + 2 * t, rel=1e-12)


@either
def test_error_of_free_fall_halves_with_the_time_step(solver: str) -> None:
    errors = []
    for steps in (30, 60, 120):
        world = World(precision="double", solver=solver)
        body = world.create_body(Circle(1))
        run(world, steps, 1 / steps)
        errors.append(body.position.y + 5)
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=1e-9)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=1e-9)


@either
def test_spin_is_uniform_and_the_angle_is_unwrapped(solver: str) -> None:
    world = World(precision="double", solver=solver)
    body = world.create_body(Box(1, 2), angle=0.5, angular_velocity=-7.5)
    run(world, 600)
    assert body.angular_velocity == -7.5
    assert body.angle == pytest.approx(0.5 - 7.5 * 10, rel=1e-12)
    assert tuple(body.direction) == cos_sin(body.angle)


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_direction_follows_the_angle(precision: str, solver: str) -> None:
    world = World(precision=precision, solver=solver)
    body = world.create_body(Box(1, 2), angular_velocity=3)
    for _ in range(5):
        c, s = cos_sin(body.angle)
        real = np.float32 if precision == "single" else np.float64
        assert tuple(body.direction) == (real(c), real(s))
        world.step(DT)
    body.angle = 1.0
    assert body.direction.x == pytest.approx(math.cos(1.0), abs=1e-7)


@either
def test_force_and_torque_act_for_one_step(solver: str) -> None:
    world = World(gravity=(0, 0), precision="double", solver=solver)
    body = world.create_body(Box(1, 2), mass=4)
    body.force, body.torque = (8, -2), 5
    world.step(DT)
    expected = (8 / 4 * DT, -2 / 4 * DT)
    assert tuple(body.velocity) == pytest.approx(expected, rel=1e-14)
    assert body.angular_velocity == pytest.approx(5 / Box(1, 2).inertia(4) * DT, rel=1e-14)
    assert tuple(body.force) == (0, 0)
    assert body.torque == 0
    world.step(DT)
    assert tuple(body.velocity) == pytest.approx(expected, rel=1e-14)


@either
def test_static_bodies_stay(solver: str) -> None:
    world = World(solver=solver)
    body = world.create_body(Box(1, 1), position=(1, 2), angle=3, kind="static")
    body.apply_force((100, 100), (0, 0))
    run(world, 10)
    assert (tuple(body.position), body.angle, tuple(body.velocity)) == ((1, 2), 3, (0, 0))
    assert (body.force, body.torque) == ((0, 0), 0)


@either
def test_kinematic_bodies_go_on_whatever_pulls_or_hits_them(solver: str) -> None:
    world = World(precision="double", solver=solver)
    body = world.create_body(Box(4, 1), position=(1, 2), kind="kinematic", velocity=(0.5, 0.25), angular_velocity=0.1)
    world.create_body(Box(1, 1), position=(1, 3.2), density=100)
    body.apply_force((100, 100), (0, 0))
    body.apply_impulse((100, 100))
    run(world, 60)
    assert tuple(body.velocity) == (0.5, 0.25)
    assert tuple(body.position) == pytest.approx((1.5, 2.25), rel=1e-12)
    assert (body.angle, body.angular_velocity) == (pytest.approx(0.1, rel=1e-12), 0.1)
    body.velocity, body.angular_velocity = (0, -1), 0
    world.step(DT)
    assert tuple(body.position) == pytest.approx((1.5, 2.25 - DT), rel=1e-12)
    assert world.bodies[1].position.y > 3.2, "and carry what lies on them"


@either
def test_gravity_is_a_vector_and_may_change(solver: str) -> None:
    world = World(gravity=(3, 0), precision="double", solver=solver)
    body = world.create_body(Circle(1))
    world.step(DT)
    world.gravity = (0, 6)
    world.step(DT)
    assert tuple(body.velocity) == pytest.approx((3 * DT, 6 * DT), rel=1e-14)


@pytest.mark.parametrize(("solver", "substeps"), METHODS)
def test_every_step_may_have_its_own_length(solver: str, substeps: int) -> None:
    world = World(precision="double", solver=solver, substeps=substeps)
    body = world.create_body(Circle(1))
    v = y = 0.0
    for dt in (0.1, 0.1, 0.02, 0.0, 0.1, 0.3, 0.3):
        world.step(dt)
        for _ in range(substeps):
            v -= 10 * dt / substeps
            y += v * dt / substeps
        assert (body.velocity.y, body.position.y) == pytest.approx((v, y), rel=1e-14)


@either
def test_mass_does_not_change_how_it_falls(solver: str) -> None:
    world = World(precision="double", solver=solver)
    for k, mass in enumerate((1e-6, 1.0, 1e9)):
        world.create_body(Circle(0.1), mass=mass, position=(k, 0))
    run(world, 100)
    assert len(set(world.positions[:, 1].tolist())) == 1
