"""The sweep: which settings are run in which order, on whose processors, and until when."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from itertools import zip_longest

from engine import SOLVERS
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.running import Job, Outcome, Progress, Run
from sandbox.lab.accuracy.runs import unable
from sandbox.lab.accuracy.series import Point, Series
from sandbox.lab.accuracy.tasks import REPEATS, Task, compile_kernels, measure, prepare
from sandbox.lab.accuracy.workers import Workers
from sandbox.lab.experiments import Experiment

SECONDS = 420.0  # time limit of a sweep: with compiling and drawing, all stays within ten minutes
SIDE_BY_SIDE = 12  # settings of a task: enough for timed runs to take turns, few enough to end in time


def plan(experiments: Sequence[Experiment], series: Sequence[Series], repeats: int = REPEATS) -> Iterator[Task]:
    """Coarse settings of all experiments before finer ones of any; small tasks, cheap settings first."""
    levels = sorted({setting.level for line in series for setting in line.settings})
    for level in levels:
        columns = [list(_tasks(experiment, series, level, repeats)) for experiment in experiments]
        for row in zip_longest(*columns):
            yield from (task for task in row if task is not None)


def _tasks(experiment: Experiment, series: Sequence[Series], level: int, repeats: int) -> Iterator[Task]:
    points = [Point(line, setting) for line in series for setting in line.settings if setting.level == level]
    points = [
        point for point in points if point.series.solver not in SOLVERS or not unable(experiment, point.series.solver)
    ]
    points.sort(key=lambda point: point.work)
    for first in range(0, len(points), SIDE_BY_SIDE):
        yield Task(experiment.name, tuple(points[first : first + SIDE_BY_SIDE]), level, repeats)


def refusals(experiments: Sequence[Experiment], series: Sequence[Series]) -> dict[tuple[str, str], str]:
    """What is known beforehand to be not applicable."""
    solvers = dict.fromkeys(line.solver for line in series if line.solver in SOLVERS)
    found = {(one.name, solver): unable(one, solver) for one in experiments for solver in solvers}
    return {key: reason for key, reason in found.items() if reason}


def sweep(
    experiments: Sequence[Experiment],
    series: Sequence[Series],
    workers: Workers,
    *,
    seconds: float = SECONDS,
    repeats: int = REPEATS,
    stop: threading.Event | None = None,
    progress: Progress = lambda done, total, what: None,
) -> Outcome:
    """Measures as much as there is time for, or until `stop` is set. Rows come in the order of experiments and series,
    whichever was first.
    """
    run = Run(workers, seconds, stop or threading.Event(), progress)
    run.outcome.refused.update(refusals(experiments, series))
    tasks = list(plan(experiments, series, repeats))
    try:
        run.go([*preparations(experiments, series, workers.here), *(Job(measure, (task,), task) for task in tasks)])
    finally:
        workers.close()
    outcome = run.outcome
    places = {line.name: place for place, line in enumerate(series)}
    scenes = {one.name: place for place, one in enumerate(experiments)}
    measures = {one.name: [measure.name for measure in one.measures] for one in experiments}
    outcome.rows.sort(
        key=lambda row: (scenes[row.scene], measures[row.scene].index(row.measure), places[row.series], _number(row))
    )
    outcome.seconds = run.elapsed()
    return outcome


def preparations(experiments: Sequence[Experiment], series: Sequence[Series], here: bool) -> Iterator[Job]:
    """What is made once, by one worker, and found on disk by all: references of scenes, and compiled code.

    here: whether workers have one disk. Else each makes what it needs when it needs it.
    """
    if not here:
        return
    for one in experiments:
        if one.prepare is not None:
            yield Job(prepare, (one.name,), prepares=one.name)
    scenes = tuple(one.name for one in experiments)
    ours = {(line.solver, line.precision): line for line in series if line.solver in SOLVERS}
    for line in sorted(ours.values(), key=lambda line: line.precision == "double") if len(scenes) > 1 else ():
        yield Job(compile_kernels, (scenes, Point(line, line.settings[0])))


def _number(row: Row) -> float:
    return float(row.label) if row.label.replace(".", "", 1).isdigit() else 0.0
