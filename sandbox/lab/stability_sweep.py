"""Cases times solvers, on several processes, within a time: the same rows in the same order, however many work."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Future, wait

from sandbox.lab.accuracy.workers import Processes, WorkersError, cores
from sandbox.lab.stability import Row, try_cell

Cell = tuple[str, str]  # case, solver
Progress = Callable[[], object]  # is told of every cell that is done

MOST_WORKERS = 4


def workers() -> int:
    """As many as there are cores, up to a few."""
    return min(cores(), MOST_WORKERS)


def sweep(
    cells: Sequence[Cell], budget: float, progress: Progress, *, defaults_only: bool = False, jobs: int = 1
) -> dict[Cell, list[Row]]:
    """The rows of each cell; none where the time [s] was not enough for its first. jobs: processes; 1: this one.

    WorkersError if one of the processes dies.
    """
    deadline = time.time() + budget
    found: dict[Cell, list[Row]] = {}
    if jobs == 1:
        for cell in cells:
            found[cell] = try_cell(*cell, defaults_only, deadline) if time.time() < deadline else []
            progress()
        return found
    pool = Processes(min(jobs, len(cells)))
    try:
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
    except BrokenExecutor:
        raise WorkersError("a process that tried cases was ended from outside: for want of memory?") from None
    finally:
        pool.close()  # at once, whatever is under way: Ctrl-C waits for no case
    return {cell: found[cell] for cell in cells}
