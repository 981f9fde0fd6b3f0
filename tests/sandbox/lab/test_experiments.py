"""The experiments' errors are those of the engine: nearly nothing for an exact history, as predicted for a real one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, World
from sandbox.lab.accuracy import Point, Series, Setting, watch
from sandbox.lab.experiments import (
    AMPLITUDE,
    DROPS,
    EXPERIMENTS,
    FLIGHT,
    MASSES,
    PERIOD,
    RESTITUTION,
    THROWN_AT,
    G,
    apex_error,
    flight_error,
    impulse_error,
    period_error,
    vertex,
    zero_crossings,
)

DT = 1 / 60


def error_of(experiment: str, measure: int, solver: str = "soft_step", steps: int = 1, **settings: object) -> float:
    """Error with some settings, and what was predicted, in parts of that."""
    setting = Setting("", settings, steps)
    series = Series("", solver, (setting,), "double")
    history, _ = watch(EXPERIMENTS[experiment], Point(series, setting))
    return EXPERIMENTS[experiment].measures[measure].error(history, setting.dt)


def predicted(experiment: str, measure: int, solver: str = "soft_step", steps: int = 1, **settings: object) -> float:
    world = World(gravity=(0, -G), solver=solver, **settings)  # type: ignore[arg-type]
    found = EXPERIMENTS[experiment].measures[measure].predicted(world, DT / steps)
    assert found is not None
    return found


# --- an exact history has no error ------------------------------------------------------------------------------------


def test_flight() -> None:
    t = np.arange(1, 121) * DT
    exact = (THROWN_AT * t - 0.5 * G * t * t)[:, None]
    assert flight_error(exact, DT) < 1e-12
    assert len(t) * DT == pytest.approx(FLIGHT)


def test_period() -> None:
    # the pendulum itself, by the classical Runge-Kutta method in small steps
    scale = G * 2.0 / 4.03125
    x, v, history, parts = AMPLITUDE, 0.0, [], 20
    h = DT / parts

    def rate(state: np.ndarray) -> np.ndarray:
        return np.array([state[1], -scale * math.sin(state[0])])

    for _ in range(round(1.3 * PERIOD / DT)):
        for _ in range(parts):
            y = np.array([x, v])
            k1 = rate(y)
            k2 = rate(y + 0.5 * h * k1)
            k3 = rate(y + 0.5 * h * k2)
            k4 = rate(y + h * k3)
            x, v = y + h / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4)
        history.append([x, v, 0.0])
    assert period_error(np.array(history), DT) < 1e-9


def test_period_of_what_does_not_swing_is_lost() -> None:
    assert period_error(np.ones((50, 3)), DT) == math.inf


@pytest.mark.parametrize("phase", [0.0, 0.3, 0.9])
def test_crossings_are_found_between_steps(phase: float) -> None:
    t = np.arange(1, 200) * DT
    times = zero_crossings(np.cos(3.0 * t + phase), -3.0 * np.sin(3.0 * t + phase), DT)
    assert times == pytest.approx(((np.arange(len(times)) + 0.5) * math.pi - phase) / 3.0, abs=1e-8)
    assert len(times) == 3


def test_apex() -> None:
    t = np.arange(1, 133)[:, None] * DT
    fall = np.sqrt(2 * DROPS / G)
    back = RESTITUTION * G * fall
    exact = np.where(t < fall, DROPS - 0.5 * G * t**2, back * (t - fall) - 0.5 * G * (t - fall) ** 2)
    assert apex_error(exact, DT) < 1e-9
    assert apex_error(1.01 * exact, DT) == pytest.approx(0.01)


def test_vertex_is_between_the_samples() -> None:
    t = np.arange(20) * 0.1
    assert vertex(3.0 - 5.0 * (t - 0.93) ** 2) == pytest.approx(3.0)
    assert vertex(np.zeros(5)) == 0.0


def test_impulses() -> None:
    weights = np.array([G * sum(MASSES[k:]) for k in range(len(MASSES))])
    exact = np.tile(np.append(weights * DT, 0.0), (180, 1))
    assert impulse_error(exact, DT) < 1e-12
    exact[:, 3] *= 1.02
    assert impulse_error(exact, DT) == pytest.approx(0.02)
    exact[-30:, 3] /= 1.02  # only the end counts
    assert impulse_error(exact, DT) < 1e-12


# --- the engine's are as predicted ------------------------------------------------------------------------------------


@pytest.mark.parametrize("settings", [{"substeps": 1}, {"substeps": 4}, {"substeps": 16}])
@pytest.mark.parametrize(("experiment", "measure"), [("ballistic", 0), ("pendulum", 1), ("sliding", 0), ("stack", 1)])
def test_soft_step_errs_as_predicted(experiment: str, measure: int, settings: dict) -> None:
    error = error_of(experiment, measure, **settings)
    assert error == pytest.approx(predicted(experiment, measure, **settings), rel=0.06)


@pytest.mark.parametrize("substeps", [8, 16])
@pytest.mark.parametrize(("experiment", "measure"), [("pendulum", 1), ("stack", 1)])
def test_fixed_stiffness_has_the_predicted_floor(experiment: str, measure: int, substeps: int) -> None:
    settings = {"substeps": substeps, "stiffness": "fixed"}
    error = error_of(experiment, measure, **settings)
    assert error == pytest.approx(predicted(experiment, measure, **settings), rel=0.06)
    assert error > 2 * predicted(experiment, measure, substeps=substeps)


@pytest.mark.parametrize("steps", [1, 4])
@pytest.mark.parametrize(("experiment", "measure"), [("ballistic", 0), ("sliding", 0), ("pendulum", 1)])
def test_sequential_impulses_err_as_predicted(experiment: str, measure: int, steps: int) -> None:
    error = error_of(experiment, measure, "sequential_impulses", steps)
    assert error == pytest.approx(predicted(experiment, measure, "sequential_impulses", steps), rel=0.1)


def test_more_substeps_make_the_period_right() -> None:
    errors = [error_of("pendulum", 0, substeps=substeps) for substeps in (1, 4, 16)]
    assert errors[0] > 10 * errors[1] > 20 * errors[2]
    assert errors[2] < 1e-4


def test_more_substeps_make_bounces_right() -> None:
    errors = [error_of("bounce", 0, substeps=substeps) for substeps in (1, 4, 16)]
    assert errors[0] > 2 * errors[1] > 4 * errors[2]


def test_contacts_of_a_stack_carry_the_weight_above() -> None:
    assert error_of("stack", 0, substeps=16) < 1e-6


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_experiment_runs_with_every_solver_that_can(name: str, solver: str) -> None:
    if not set(EXPERIMENTS[name].needs) & set(SOLVERS[solver].lacks):
        for measure in range(len(EXPERIMENTS[name].measures)):
            assert error_of(name, measure, solver) < 1.0
