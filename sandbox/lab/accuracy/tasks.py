"""What a worker is given: a few settings of one experiment, measured side by side. Plain data in, plain data out.

Timed runs take turns, forwards and backwards, so that what slows the machine for a while slows all of them; a worker
makes one at a time, and only after the same run was watched, which compiles what it calls and warms it up. Its time
is the process's own: what others do on the core is not in it.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import NamedTuple

from engine.compilation import watch_compilation
from sandbox.lab.accuracy import peers
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.runs import (
    Begun,
    NotApplicable,
    TooSlow,
    Watched,
    begin,
    built,
    cost,
    follow,
    rows_of,
    unable,
)
from sandbox.lab.accuracy.series import Point
from sandbox.lab.experiments import EXPERIMENTS, Experiment
from sandbox.lab.peers import KNOBS, PeerError
from sandbox.lab.timing import no_collection
from sandbox.simulation import TIME_STEP

REPEATS = 3  # of timed runs
LONGEST = 30.0  # s of one run, beyond which it is left out
ONCE = 4.0  # s: a run that took longer is timed once only
_one_at_a_time = threading.Lock()  # where a worker has several threads: timed runs must not disturb each other


@dataclass(frozen=True)
class Task:
    """Settings of one experiment, of one level."""

    scene: str
    points: tuple[Point, ...]
    level: int = 0
    repeats: int = REPEATS


class Result(NamedTuple):
    """What came of a task."""

    rows: list[Row]
    refused: dict[str, str]  # solver: why it cannot run the experiment
    failures: list[str]  # what went wrong with others, a line each
    left: int  # settings that were not measured
    compiled: int  # kernels


def measure(task: Task, seconds: float) -> Result:
    """Runs a task; after so many seconds no further run is begun."""
    kernels: list[str] = []
    with _one_at_a_time, watch_compilation(kernels.append):
        return Measuring(task, time.monotonic() + seconds).result(kernels)


class Measuring:
    """A task under way."""

    def __init__(self, task: Task, end: float) -> None:
        self._task, self._end = task, end
        self._experiment: Experiment = EXPERIMENTS[task.scene]
        self._refused: dict[str, str] = {}
        self._failures: list[str] = []
        self._runs: dict[int, Begun] = {}  # of our own solvers, by their places in the task
        self._took: dict[int, float] = {}  # how long each was watched, by its place in the task [s]

    def result(self, kernels: list[str]) -> Result:
        found = self._watch_all()
        times: dict[int, list[float]] = {index: [] for index in found}
        with no_collection():
            for repeat in range(self._task.repeats):
                for index in found if repeat % 2 == 0 else reversed(found):
                    if self._time_is_up():
                        break
                    if repeat and self._took[index] > ONCE:
                        continue
                    times[index].append(self._cost(index))
        points = self._task.points
        rows = [
            row
            for index, watched in found.items()
            if times[index]
            for row in rows_of(self._experiment, points[index], watched, times[index])
        ]
        able = [point for point in points if point.series.solver not in self._refused]
        return Result(rows, self._refused, self._failures, len(able) - sum(map(bool, times.values())), len(kernels))

    def _watch_all(self) -> dict[int, Watched]:
        """The histories of all points, by their places in the task."""
        found = {}
        for index, point in enumerate(self._task.points):
            if self._time_is_up():
                break
            solver = point.series.solver
            if solver in self._refused:
                continue
            began = time.monotonic()
            try:
                found[index] = self._watch(index, min(self._end, began + LONGEST))
                self._took[index] = time.monotonic() - began
            except TooSlow:
                continue
            except (NotApplicable, PeerError) as error:
                self._refused[solver] = str(error)
            except Exception as error:  # noqa: BLE001 - of a peer, or of a solver under test: the others go on
                self._failures.append(
                    f"{self._task.scene}, {point.series.name} {point.setting.label}: {one_line(error)}"
                )
        return found

    def _watch(self, index: int, until: float) -> Watched:
        """Of ours also keeps the run, to be timed from its start."""
        point = self._task.points[index]
        if point.series.solver in KNOBS:
            return peers.watch_peer(self._experiment, point, until)
        if reason := unable(self._experiment, point.series.solver):
            raise NotApplicable(reason)
        self._runs[index] = begin(self._experiment, point)
        return follow(self._runs[index], until)

    def _cost(self, index: int) -> float:
        if index in self._runs:
            return cost(self._runs[index])
        return peers.cost_of_peer(self._experiment, self._task.points[index])

    def _time_is_up(self) -> bool:
        return time.monotonic() > self._end


def one_line(error: Exception) -> str:
    """What it was, without its traceback."""
    return f"{type(error).__name__}: {str(error).partition(chr(10))[0][:200]}"


def compile_kernels(scenes: tuple[str, ...], point: Point, seconds: float) -> int:
    """Makes two steps of each experiment with one setting, which leaves compiled code on disk: how many kernels."""
    end = time.monotonic() + seconds
    kernels: list[str] = []
    with watch_compilation(kernels.append):
        for scene in scenes:
            if time.monotonic() > end:
                break
            if not unable(EXPERIMENTS[scene], point.series.solver):
                try_steps(EXPERIMENTS[scene], point)
    return len(kernels)


def prepare(scene: str, seconds: float) -> str:
    """Makes what a scene is compared with, or finds it where it is kept; the scene's name. Nobody can hurry this."""
    make = EXPERIMENTS[scene].prepare
    if make is not None:
        make()
    return scene


def try_steps(experiment: Experiment, point: Point) -> None:
    """Two steps. What goes wrong does so again when it is measured, and is told then."""
    try:
        world, observe = built(experiment, point)
        for _ in range(2):
            world.step(TIME_STEP)
        observe(world)
    except (NotApplicable, ArithmeticError, ValueError, IndexError):
        pass
