"""Cases times solvers, on several processes, within a time: the same rows in the same order, however many work."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, wait

from sandbox.lab.stability import Row, try_cell

Cell = tuple[str, str]  # case, solver
Progress = Callable[[], object]  # is told of every cell that is done

MOST_WORKERS = 4


def workers() -> int:
    """As many as there are cores, up to a few."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, MOST_WORKERS)


def sweep(
    cells: Sequence[Cell], budget: float, progress: Progress, *, defaults_only: bool = False, jobs: int = 1
) -> dict[Cell, list[Row]]:
    """The rows of each cell; none where the time [s] was not enough for its first. jobs: processes; 1: this one."""
    deadline = time.time() + budget
    found: dict[Cell, list[Row]] = {}
    if jobs == 1:
        for cell in cells:
            found[cell] = try_cell(*cell, defaults_only, deadline) if time.time() < deadline else []
            progress()
        return found
    context = multiprocessing.get_context("spawn")  # a fork would copy locks that the engine's threads hold
    with ProcessPoolExecutor(min(jobs, len(cells)), context) as pool:
        futures = {pool.submit(try_cell, *cell, defaults_only, deadline): cell for cell in cells}
        left: set[Future] = set(futures)
        while left:
            done, left = wait(left, timeout=1.0, return_when="FIRST_COMPLETED")
            for _ in done:
                progress()
            if time.time() > deadline:
                for future in left:
                    future.cancel()
        for future, cell in futures.items():
            found[cell] = [] if future.cancelled() else future.result()
    return {cell: found[cell] for cell in cells}
