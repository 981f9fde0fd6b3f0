"""A sweep under way: jobs that are handed to workers while there is time, and what came of them."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from dataclasses import dataclass, field
from typing import Any

from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.tasks import Result, Task, one_line
from sandbox.lab.accuracy.workers import Workers

GRACE = 20.0  # s after the limit in which a run that is under way may end
TRIES = 2  # of a job whose worker dies
LOOK = 0.2  # s between two looks at the clock

Progress = Callable[[int, int, str], None]  # settings measured, of how many, and what is being done


@dataclass
class Outcome:
    """What came of a sweep."""

    rows: list[Row] = field(default_factory=list)
    refused: dict[tuple[str, str], str] = field(default_factory=dict)  # (scene, solver): why it cannot run it
    left: Counter[tuple[str, int]] = field(default_factory=Counter)  # (scene, level): settings without time
    failures: list[str] = field(default_factory=list)  # what went wrong, a line each
    compiled: int = 0  # kernels
    unprepared: list[str] = field(default_factory=list)  # scenes; "" is compiling: what there was no time to make first
    seconds: float = 0.0


@dataclass
class Job:
    """A call for a worker, which is told the time that is left besides."""

    function: Callable[..., Any]
    arguments: tuple
    task: Task | None = None  # that is measured
    prepares: str = ""  # the scene whose tasks wait for this
    tries: int = 0


class Run:
    """The clock, what waits and what is in the air. stop: ends it early."""

    def __init__(self, workers: Workers, seconds: float, stop: threading.Event, progress: Progress) -> None:
        self.outcome = Outcome()
        self._workers, self._seconds, self._stop, self._progress = workers, seconds, stop, progress
        self._started = time.monotonic()
        self._waiting: list[Job] = []
        self._flying: dict[Future[Any], Job] = {}
        self._unprepared: set[str] = set()
        self._done = self._total = 0

    def elapsed(self) -> float:
        return time.monotonic() - self._started

    def go(self, jobs: Sequence[Job]) -> None:
        """Does the jobs in their order, as far as there is time; what it must leave out, it counts."""
        self._waiting = list(jobs)
        self._unprepared = {job.prepares for job in jobs if job.prepares}
        self._total = sum(len(job.task.points) for job in jobs if job.task is not None)
        while self._submit() or self._flying:
            ended, _ = wait(self._flying, LOOK, FIRST_COMPLETED)
            for future in ended:
                self._land(self._flying.pop(future), future)
            self._progress(self._done, self._total, "measuring" if self._done else "preparing")
            if self._stop.is_set() or self.elapsed() > self._seconds + GRACE:
                break  # `sweep` ends what is still under way
        for job in (*self._waiting, *self._flying.values()):
            self._leave(job.task)
            if job.task is None:
                self.outcome.unprepared.append(job.prepares)
        if self._flying and self.elapsed() > self._seconds + GRACE:
            self.outcome.unprepared.append("")  # runs look at the clock at each step: what does not end is compiling

    def _submit(self) -> bool:
        """Hands out jobs until every worker has one; whether any is under way."""
        while len(self._flying) < self._workers.slots and self.elapsed() < self._seconds:
            job = next((job for job in self._waiting if not self._must_wait(job)), None)
            if job is None:
                break
            try:
                future = self._workers.submit(job.function, *job.arguments, self._seconds - self.elapsed())
            except BrokenExecutor:
                self._workers.restart()
                continue
            self._waiting.remove(job)
            self._flying[future] = job
        return bool(self._flying)

    def _must_wait(self, job: Job) -> bool:
        return job.task is not None and job.task.scene in self._unprepared

    def _land(self, job: Job, future: Future[Any]) -> None:
        """A job has ended, one way or another."""
        job.tries += 1
        try:
            self._take(job, future.result())
        except BrokenExecutor:
            if job.tries < TRIES:
                self._waiting.insert(0, job)
            else:
                self._fail(job, "its worker died, and another one with it")
        except Exception as error:  # noqa: BLE001 - of a worker, wherever that is: the others go on
            self._fail(job, one_line(error))

    def _take(self, job: Job, result: Any) -> None:
        if isinstance(result, int):
            self.outcome.compiled += result
        elif job.prepares:
            self._unprepared.discard(job.prepares)
        elif isinstance(result, Result) and job.task is not None:
            task = job.task
            self._done += len(task.points)
            self.outcome.rows += result.rows
            self.outcome.failures += result.failures
            self.outcome.compiled += result.compiled
            self.outcome.refused.update({(task.scene, solver): why for solver, why in result.refused.items()})
            self._leave(task, result.left)

    def _fail(self, job: Job, why: str) -> None:
        """It is not tried again; the tasks of a scene that could not be prepared wait to the end, and are left out."""
        scene = job.task.scene if job.task is not None else job.prepares
        self.outcome.failures.append(f"{scene or 'compiling'}: {why}")
        if job.task is not None:
            self._done += len(job.task.points)
        self._leave(job.task)

    def _leave(self, task: Task | None, count: int | None = None) -> None:
        if task is not None and count != 0:
            self.outcome.left[task.scene, task.level] += len(task.points) if count is None else count
