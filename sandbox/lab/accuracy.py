"""What accuracy costs: each experiment's error, and the CPU time that it took, over the settings of both solvers."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import SOLVERS, World
from sandbox.lab.experiments import Experiment
from sandbox.simulation import TIME_STEP

REPEATS = 3  # of timed runs; settings take turns, so that what slows the machine for a while slows all of them

Progress = Callable[[], None]  # is told of every run that was made
Say = Callable[[str], None]


@dataclass(frozen=True)
class Setting:
    """One point of a line: a world's settings, and how many steps make 1/60 s."""

    label: str
    world: dict[str, Any]
    steps: int = 1

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return TIME_STEP / self.steps


@dataclass(frozen=True)
class Series:
    """Settings of which only one thing changes: a line of the diagram."""

    name: str
    solver: str
    settings: tuple[Setting, ...]
    precision: str = "single"

    def world(self, setting: Setting) -> World:
        """An empty world with that setting, in which nothing sleeps: that would end an experiment."""
        gravity = (0.0, -10.0)
        return World(
            gravity=gravity, solver=self.solver, precision=self.precision, sleeping=False, **setting.world
        )  # fmt: skip


def over(name: str, values: Sequence[int], **fixed: Any) -> tuple[Setting, ...]:
    """Settings of which one takes several values."""
    return tuple(Setting(str(value), {name: value, **fixed}) for value in values)


SUBSTEPS = (1, 2, 4, 8, 16, 32)
# Below 4 substeps, and at 4, a fixed stiffness is cut off where it follows.
SERIES = (
    Series("sequential_impulses, iterations", "sequential_impulses", over("iterations", (1, 2, 5, 10, 20, 50))),
    Series(
        "sequential_impulses, steps in 1/60 s",
        "sequential_impulses",
        tuple(Setting(str(steps), {"iterations": 10}, steps) for steps in (1, 2, 4, 8)),
    ),
    Series("soft_step, substeps", "soft_step", over("substeps", SUBSTEPS)),
    Series("soft_step, substeps, stiffness fixed", "soft_step", over("substeps", SUBSTEPS[2:], stiffness="fixed")),
    Series("soft_step, iterations in 4 substeps", "soft_step", over("iterations", (1, 2, 3, 4), substeps=4)),
    Series("soft_step, substeps, double precision", "soft_step", over("substeps", SUBSTEPS), "double"),
)


@dataclass(frozen=True)
class Row:
    """One point of a diagram: an experiment's error with one setting, and what it cost."""

    scene: str
    solver: str
    settings: dict[str, Any]
    precision: str
    measure: str
    error: float
    cost_ms: float  # CPU time of a simulated second [ms]
    solves: int  # constraints visited: passes x substeps x steps x (contacts + joints), of the whole run
    series: str
    label: str
    predicted: float | None  # the error that is known beforehand

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        names = ("scene", "solver", "settings", "precision", "measure", "error", "cost_ms", "solves")
        values = {name: getattr(self, name) for name in names}
        return {**values, "error": self.error if np.isfinite(self.error) else None}


@dataclass(frozen=True)
class Point:
    """A setting of a series, run in one experiment."""

    series: Series
    setting: Setting


def measure(
    experiments: Sequence[Experiment], series: Sequence[Series] = SERIES, *, repeats: int = REPEATS, progress: Progress
) -> list[Row]:
    """All rows, an experiment after the other. Every setting is run once to be measured, which also warms it up."""
    rows = []
    for experiment in experiments:
        points = points_of(experiment, series)
        found = []
        for point in points:
            found.append(watch(experiment, point))
            progress()
        costs: list[list[float]] = [[] for _ in points]
        for repeat in range(repeats):
            order = range(len(points))
            for k in order if repeat % 2 == 0 else reversed(order):
                costs[k].append(cost(experiment, points[k]))
                progress()
        for point, (history, solves), times in zip(points, found, costs, strict=True):
            rows += rows_of(experiment, point, history, solves, float(np.median(times)))
    return rows


def points_of(experiment: Experiment, series: Sequence[Series]) -> list[Point]:
    """The settings with which it can be run: of a solver that lacks what it needs, none."""
    able = [one for one in series if not set(experiment.needs) & set(SOLVERS[one.solver].lacks)]
    return [Point(one, setting) for one in able for setting in one.settings]


def runs_of(experiments: Sequence[Experiment], series: Sequence[Series] = SERIES, repeats: int = REPEATS) -> int:
    """How many runs `measure` makes of them."""
    return sum(len(points_of(experiment, series)) * (1 + repeats) for experiment in experiments)


def watch(experiment: Experiment, point: Point) -> tuple[np.ndarray, int]:
    """A run's history, and how many constraints were solved in it."""
    world = point.series.world(point.setting)
    observe = experiment.build(world)
    history, constraints = [], 0
    for _ in range(step_count(experiment, point.setting)):
        world.step(point.setting.dt)
        history.append(observe(world))
        constraints += len(world.contact_records()) + world.joint_count
    return np.array(history), constraints * passes(world)


def cost(experiment: Experiment, point: Point) -> float:
    """CPU time of a simulated second [ms]."""
    world = point.series.world(point.setting)
    experiment.build(world)
    steps, dt = step_count(experiment, point.setting), point.setting.dt
    before = time.process_time()
    for _ in range(steps):
        world.step(dt)
    return 1e3 * (time.process_time() - before) / (steps * dt)


def step_count(experiment: Experiment, setting: Setting) -> int:
    return round(experiment.seconds / TIME_STEP) * setting.steps


def passes(world: World) -> int:
    """How often a step visits each constraint: the soft step does so with its bias and again without."""
    settings = world.settings
    return settings.iterations * settings.substeps * (2 if SOLVERS[settings.solver].has_substeps else 1)


def rows_of(experiment: Experiment, point: Point, history: np.ndarray, solves: int, cost_ms: float) -> list[Row]:
    """A row for each of the experiment's measures."""
    series, setting = point.series, point.setting
    world = series.world(setting)
    shown = {name: getattr(world.settings, name) for name in ("substeps", "iterations", "stiffness")}
    if not SOLVERS[series.solver].has_substeps:
        shown = {"iterations": shown["iterations"]}
    return [
        Row(
            scene=experiment.name,
            solver=series.solver,
            settings={"dt": setting.dt, **shown},
            precision=series.precision,
            measure=one.name,
            error=float(one.error(history, setting.dt)),
            cost_ms=cost_ms,
            solves=solves,
            series=series.name,
            label=setting.label,
            predicted=one.predicted(world, setting.dt),
        )
        for one in experiment.measures
    ]
