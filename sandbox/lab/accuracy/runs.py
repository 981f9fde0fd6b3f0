"""One run of an experiment: its history, what it cost, and the rows that come of it."""

from __future__ import annotations

import math
import time
from typing import Any, NamedTuple

import numpy as np

from engine import SOLVERS, Snapshot, StepError, TooLarge, World
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.series import Point, matters
from sandbox.lab.experiments import Experiment, Watch
from sandbox.simulation import TIME_STEP


class NotApplicable(Exception):
    """A solver or a peer has not what an experiment needs; the message says what."""


class TooSlow(Exception):
    """A run that takes longer than there is time for."""


class Watched(NamedTuple):
    """What was seen of a run."""

    history: np.ndarray  # (steps, k); shorter where the state was lost
    solves: int | None


def unable(experiment: Experiment, solver: str) -> str:
    """Why one of our solvers cannot run it, "" if it can."""
    lacking = [name for name in experiment.needs if name in SOLVERS[solver].lacks]
    return f"it has no {', no '.join(lacking)}" if lacking else ""


def step_count(experiment: Experiment, point: Point) -> int:
    return round(experiment.seconds / TIME_STEP) * point.setting.steps


class Begun(NamedTuple):
    """A run at its start, to which it can be taken back: that is done faster than it is made."""

    experiment: Experiment
    point: Point
    world: World
    observe: Watch
    start: Snapshot


def built(experiment: Experiment, point: Point) -> tuple[World, Watch]:
    """The filled world, and what to watch in it. NotApplicable if its solver refuses what is in it."""
    world = point.series.world(point.setting)
    try:
        return world, experiment.build(world)
    except ValueError as error:
        raise NotApplicable(str(error)) from None


def begin(experiment: Experiment, point: Point) -> Begun:
    """The filled world, before its first step. NotApplicable as above."""
    world, observe = built(experiment, point)
    return Begun(experiment, point, world, observe, world.snapshot())


def watch(experiment: Experiment, point: Point) -> Watched:
    """A run's history, and how many constraints were solved in it."""
    return follow(begin(experiment, point))


def follow(run: Begun, until: float = math.inf) -> Watched:
    """The same of a run that is begun. TooSlow if it has not ended by then, as time.monotonic has it."""
    world, dt = run.world, run.point.setting.dt
    history, constraints = [], 0
    for _ in range(step_count(run.experiment, run.point)):
        if time.monotonic() > until:
            raise TooSlow
        try:
            world.step(dt)
        except (ValueError, TooLarge) as error:
            raise NotApplicable(str(error)) from None
        except StepError:
            break
        history.append(run.observe(world))
        constraints += len(world.contact_records()) + world.joint_count
    return Watched(np.array(history), constraints * passes(world))


def cost(run: Begun) -> float:
    """CPU time of a simulated second, from the run's start [ms]."""
    world, dt, done = run.world, run.point.setting.dt, 0
    world.restore(run.start)
    before = time.process_time()
    try:
        for _ in range(step_count(run.experiment, run.point)):
            world.step(dt)
            done += 1
    except StepError:
        pass
    return 1e3 * (time.process_time() - before) / (max(done, 1) * dt)


def passes(world: World) -> int:
    """How often a step visits each constraint."""
    settings = world.settings
    return round(settings.iterations * settings.substeps * SOLVERS[settings.solver].visits)


def rows_of(experiment: Experiment, point: Point, watched: Watched, times: list[float]) -> list[Row]:
    """A row for each of the experiment's measures that has a value. times: of the timed runs [ms]."""
    series, setting = point.series, point.setting
    world = series.world(setting)
    lost = len(watched.history) < step_count(experiment, point)
    rows = []
    for one in experiment.measures:
        error = float("inf") if lost else error_of(one.error, watched.history, setting.dt)
        if error is None:
            continue
        rows.append(
            Row(
                scene=experiment.name,
                solver=series.solver,
                settings=shown_settings(point, world),
                precision=series.precision,
                measure=one.name,
                error=error,
                cost_ms=float(np.median(times)),
                spread_ms=max(times) - min(times),
                solves=watched.solves,
                series=series.name,
                label=setting.label,
                predicted=one.predicted(world, setting.dt) if series.solver in SOLVERS else None,
            )
        )
    return rows


def error_of(measure: Any, history: np.ndarray, dt: float) -> float | None:
    """The error, infinite where a history says nothing; None where it rests on what a peer does not tell."""
    with np.errstate(all="ignore"):
        error = float(measure(history, dt))
    if np.isnan(error):
        return None if np.isnan(history).any() else float("inf")
    return error


def shown_settings(point: Point, world: World) -> dict[str, Any]:
    """What the run was made with, as JSON has it."""
    solver, setting = point.series.solver, point.setting
    if solver not in SOLVERS:
        return {"dt": setting.dt, **{name: value for name, value in setting.world.items() if name != "stiffness"}}
    about = SOLVERS[solver]
    names = [name for name in ("substeps", "iterations", "stiffness") if matters(name, about)]
    return {"dt": setting.dt, **{name: getattr(world.settings, name) for name in names}}
