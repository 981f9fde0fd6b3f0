"""The stages of a step: their order, and what is said when one of them breaks the state."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, STAGES, Box, Circle, StepError, World
from tests.engine.worlds import DT, PRECISIONS, busy, floor, run

pytestmark = pytest.mark.kernel


def test_the_talks_order() -> None:
    names = [name for name, _ in STAGES]
    assert names.index("broad phase") < names.index("narrow phase") < names.index("apply forces")
    assert names.index("apply forces") < names.index("solve constraints") < names.index("update positions")
    assert names.index("broad phase") < names.index("arbiters"), "which come and go with the pairs"


def break_forces(world: World) -> int:
    body = world.create_body(Circle(0.5), position=(50, 50), mass=1e-3)
    largest = float(np.finfo(np.float32 if world.precision == "single" else np.float64).max)
    body.apply_force((0.6 * largest, 0))
    return body.serial


def break_solver(world: World) -> int:
    # both speeds are finite, their difference is not
    largest = float(np.finfo(np.float32 if world.precision == "single" else np.float64).max)
    body = world.create_body(Circle(0.5), position=(50, 50), velocity=(0.9 * largest, 0))
    world.create_body(Circle(0.5), position=(50.9, 50), velocity=(-0.9 * largest, 0))
    return body.serial


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize(
    ("damage", "stage", "solver"),
    [
        (break_forces, "apply forces", "sequential_impulses"),
        (break_solver, "solve constraints", "sequential_impulses"),
        (break_forces, "solve constraints", "soft_step"),  # where forces act in substeps
        (break_solver, "solve constraints", "soft_step"),
    ],
)
def test_the_message_names_body_and_stage(damage, stage: str, solver: str, precision: str) -> None:
    largest = float(np.finfo(np.float32 if precision == "single" else np.float64).max)
    world = run(busy(precision, solver=solver, maximum_speed=largest), 5)
    good = world.snapshot()
    serial = damage(world)
    with pytest.raises(StepError, match=rf"^step 6, stage '{stage}': body {serial} is no longer finite: position \("):
        world.step(DT)
    world.restore(good)
    run(world, 20)
    assert world.state_hash() == run(busy(precision, solver=solver, maximum_speed=largest), 25).state_hash()


@pytest.mark.parametrize("solver", SOLVERS)
def test_positions_that_overflow_are_named(solver: str) -> None:
    world = World(gravity=(0, 0), precision="double", solver=solver, maximum_speed=1.7e308)
    world.create_body(Circle(0.5), position=(0, 50))
    body = world.create_body(Circle(0.5), position=(1.7e308, 0), velocity=(1e308, 0))
    with pytest.raises(StepError, match=rf"stage 'update positions': body {body.serial} .*position \(inf, 0\)"):
        world.step(DT * 60)


def test_the_largest_positions_are_still_finite() -> None:
    world = World(gravity=(0, 0), precision="double")
    body = world.create_body(Circle(0.5), position=(1.6e308, 1.6e308), angle=1.6e308)
    world.step(DT)
    assert tuple(body.position) == (1.6e308, 1.6e308)


def test_the_first_of_several_is_named() -> None:
    world = World(precision="double")
    floor(world)
    world.create_body(Box(1, 1), position=(0, 5))
    lost = [world.create_body(Circle(0.5), position=(10 * k, 50), mass=1e-3) for k in range(1, 3)]
    for body in lost:
        body.apply_force((0, 1e308))
    with pytest.raises(StepError, match=f"body {lost[0].serial} "):
        world.step(DT)


def test_a_broken_step_is_an_arithmetic_error() -> None:
    assert issubclass(StepError, ArithmeticError)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_spin_too_fast_is_named(solver: str) -> None:
    world = World(gravity=(0, 0), precision="double", solver=solver)
    body = world.create_body(Box(1, 1), mass=1e-3)
    body.torque = 1e308
    with pytest.raises(StepError, match=rf"angular velocity {'nan' if solver == 'avbd' else 'inf'}"):
        world.step(DT)
    assert not math.isfinite(body.angular_velocity)
