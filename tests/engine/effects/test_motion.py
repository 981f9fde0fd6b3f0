"""Damping and gravity's scale: closed forms, with either solver."""

from __future__ import annotations

import pytest

from engine import Box, Circle, World
from tests.engine.worlds import DT, PRECISIONS, run

METHODS = [("soft_step", 1), ("soft_step", 4), ("soft_step", 9), ("sequential_impulses", 1)]
every = pytest.mark.parametrize(("solver", "substeps"), METHODS)


def still(solver: str, substeps: int, precision: str = "double", **settings: object) -> World:
    return World(**{"gravity": (0, 0), "solver": solver, "substeps": substeps, "precision": precision, **settings})


@every
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("c", [0.1, 2.0, 50.0])
def test_linear_damping(c: float, precision: str, solver: str, substeps: int) -> None:
    # implicit Euler of dv/dt = -c v: v falls by 1 / (1 + h c) in each h, never below zero
    world, h = still(solver, substeps, precision), DT / substeps
    body = world.create_body(Box(1, 2), velocity=(3, -4), angular_velocity=2, linear_damping=c)
    rounding = 1e-11 if precision == "double" else 1e-4
    for step in range(1, 61):
        world.step(DT)
        left = (1 + h * c) ** (-step * substeps)
        assert tuple(body.velocity) == pytest.approx((3 * left, -4 * left), rel=rounding, abs=1e-30)
    # x = sum of h v: a geometric series
    total = (1 - (1 + h * c) ** (-60 * substeps)) / c
    assert tuple(body.position) == pytest.approx((3 * total, -4 * total), rel=rounding)
    assert body.angular_velocity == 2.0


@every
@pytest.mark.parametrize("c", [0.1, 2.0, 50.0])
def test_angular_damping(c: float, solver: str, substeps: int) -> None:
    world, h = still(solver, substeps), DT / substeps
    body = world.create_body(Box(1, 2), velocity=(3, -4), angular_velocity=2, angular_damping=c)
    run(world, 60)
    assert body.angular_velocity == pytest.approx(2 * (1 + h * c) ** (-60 * substeps), rel=1e-11)
    assert body.angle == pytest.approx(2 * (1 - (1 + h * c) ** (-60 * substeps)) / c, rel=1e-11)
    assert tuple(body.velocity) == (3.0, -4.0)


@every
def test_a_damped_body_falls_with_g_over_c(solver: str, substeps: int) -> None:
    world = still(solver, substeps, gravity=(0, -10))
    body = world.create_body(Circle(1), linear_damping=4)
    run(world, 600)
    assert body.velocity.y == pytest.approx(-10 / 4, rel=1e-9)


@every
@pytest.mark.parametrize("scale", [0.0, 0.3, -2.0, 7.5])
def test_gravity_scale(scale: float, solver: str, substeps: int) -> None:
    world, h = still(solver, substeps, gravity=(2, -10)), DT / substeps
    body = world.create_body(Box(1, 2), mass=3, gravity_scale=scale)
    plain = world.create_body(Box(1, 2), mass=3, position=(100, 0))
    run(world, 60)
    assert tuple(body.velocity) == pytest.approx((2 * scale, -10 * scale), rel=1e-12, abs=1e-12)
    n = 60 * substeps
    fallen = -10 * h * h * n * (n + 1) / 2
    assert body.position.y == pytest.approx(scale * fallen, rel=1e-12, abs=1e-12)
    assert plain.position.y == pytest.approx(fallen, rel=1e-12)


@every
def test_it_may_change_at_any_time(solver: str, substeps: int) -> None:
    world = still(solver, substeps, gravity=(0, -10))
    body = world.create_body(Circle(1))
    run(world, 6)
    body.gravity_scale = 0.0
    speed = body.velocity.y
    run(world, 6)
    assert body.velocity.y == speed == pytest.approx(-1.0, rel=1e-12)
    body.linear_damping = 1e6
    world.step(DT)
    assert abs(body.velocity.y) < 1e-3
    body.gravity_scale, body.linear_damping = 1.0, 0.0
    assert {"gravity_scale", "linear_damping"} & set(world.snapshot().tables) == set()
    world.step(DT)
    assert not world._state.bodies.columns


def test_what_no_force_moves_is_not_slowed() -> None:
    world = World()
    body = world.create_body(Box(1, 1), kind="kinematic", velocity=(2, 1), angular_velocity=3, linear_damping=5,
                             angular_damping=5, gravity_scale=9)  # fmt: skip
    run(world, 30)
    assert (tuple(body.velocity), body.angular_velocity) == ((2, 1), 3)
