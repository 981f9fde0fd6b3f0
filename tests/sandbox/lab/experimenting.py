"""Runs of experiments, as the tests of the laboratory make them."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from engine import EFFECTS, SOLVERS, World
from sandbox.lab.experiments import EXPERIMENTS, Experiment
from sandbox.simulation import TIME_STEP

# What the passes of a solver may leave out: all of it runs in all experiments, so that it is compiled once.
PASSES = frozenset(effect.name for effect in EFFECTS if effect.apply is None) - {
    "chains", "breaking joints", "continuous collision", "bullets", "joined without colliding", "events", "sleeping",
    "diagnostics", "filters", "wind",
}  # fmt: skip


def able(experiment: Experiment, solver: str) -> bool:
    """Whether the solver has what the experiment needs."""
    return not set(experiment.needs) & set(SOLVERS[solver].lacks)


def empty_world(solver: str = "soft_step", precision: str = "double", **settings: Any) -> World:
    """As the experiments begin, nothing falling asleep."""
    world = World(gravity=(0.0, -10.0), solver=solver, precision=precision, sleeping=False, **settings)
    world._state.forced = frozenset(PASSES - set(SOLVERS[solver].lacks))
    return world


def history_of(experiment: Experiment, world: World, steps: int = 1) -> np.ndarray:
    """What was watched in the experiment, in steps of 1/60 s over `steps`."""
    watch = experiment.build(world)
    rows = []
    for _ in range(round(experiment.seconds / TIME_STEP) * steps):
        world.step(TIME_STEP / steps)
        rows.append(watch(world))
    return np.array(rows)


@cache
def errors_of(name: str, solver: str = "soft_step", steps: int = 1, settings: tuple = ()) -> dict[str, float]:
    """Each measure's error, by what it measures; settings: pairs of name and value."""
    experiment = EXPERIMENTS[name]
    history = history_of(experiment, empty_world(solver, **dict(settings)), steps)
    return {measure.what: float(measure.error(history, TIME_STEP / steps)) for measure in experiment.measures}


def error_of(name: str, what: str, solver: str = "soft_step", steps: int = 1, **settings: Any) -> float:
    """The error of one measure."""
    return errors_of(name, solver, steps, tuple(sorted(settings.items())))[what]


def predicted(name: str, what: str, solver: str = "soft_step", steps: int = 1, **settings: Any) -> float | None:
    """What is said of it beforehand."""
    (measure,) = (one for one in EXPERIMENTS[name].measures if one.what == what)
    return measure.predicted(empty_world(solver, **settings), TIME_STEP / steps)


def scale_of(name: str, what: str) -> float:
    (measure,) = (one for one in EXPERIMENTS[name].measures if one.what == what)
    return measure.scale
