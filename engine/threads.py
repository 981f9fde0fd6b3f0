"""Threads that help with a step: they take parts of it as long as there are any, and nobody waits for them to come.

A piece of shared work is a kernel that any number of threads may run at once, each until no part is left to take. The
thread that steps the world runs it too, so the work is done even if no helper gets a processor in time. Helpers are
Python threads, which need the interpreter only to begin: inside a kernel they do not hold it. All worlds of a process
share them, in whatever threads these are stepped.

numba's own parallel regions are not used. They end only when each of their threads has had its turn, which on a machine
with other work takes a time slice for every region (docs/decisions.md has figures); and some of the ways in which numba
may run them crash where two Python threads enter at once.
"""

from __future__ import annotations

import logging
import os
import queue
import threading
from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from engine.atomics import count_up, linger, new_counters, read_now, rest, wait_for
from engine.jit import kernel

log = logging.getLogger("tumble.threads")

MOST = 64  # more do not help: stages are shorter than what it takes to meet
MOST_WAITING = 4  # jobs for each helper: beyond that they get no processor, and would keep what is long done
WORTH_SHARING = 256  # bodies, or pairs: of fewer, one thread is done before others have come

TAKEN, DONE = 0, 1  # counters of work in parts: how many were taken, how many are done
CLOSED, ENTERED, LEFT = 0, 1, 2  # counters of a program: whether it is over, how many helpers came and went


def usable(threads: int, things: int) -> int:
    """How many of the threads asked for pay for so many things to do."""
    return 1 if numba.config.DISABLE_JIT or things < WORTH_SHARING else threads


def shares(count: int, parts: int, unit: int = 1) -> np.ndarray:
    """(parts + 1,) int64: where each part of so many things begins, a multiple of `unit`; and the end."""
    firsts = np.arange(parts + 1) * (count // unit) // parts * unit
    firsts[-1] = count
    return firsts


# --- inside a kernel -------------------------------------------------------------------------------------------------


@kernel
def take_part(board, parts):
    """The number of a part of the work that is now this thread's, -1 if none is left."""
    number = count_up(board, TAKEN)
    return number if number < parts else -1


@kernel
def wait_for_all(board, parts):
    """Until all parts are done."""
    wait_for(board, DONE, parts)


@kernel
def enter(board):
    """Whether a helper still comes in time. If so, nothing is touched by others until it has called `leave`."""
    count_up(board, ENTERED)
    if read_now(board, CLOSED) == 0:
        return True
    count_up(board, LEFT)
    return False


@kernel
def leave(board):
    """The helper touches nothing any more."""
    count_up(board, LEFT)


@kernel
def close(board):
    """No helper comes any more; returns when those who came have left."""
    count_up(board, CLOSED)
    looks = 0
    while read_now(board, LEFT) < read_now(board, ENTERED):
        looks += 1
        rest(looks)


# --- the helpers -----------------------------------------------------------------------------------------------------


class _Helpers:
    """The helpers of this process."""

    def __init__(self) -> None:
        self.jobs: queue.SimpleQueue[tuple[Callable[..., Any], tuple]] = queue.SimpleQueue()
        self.posted = new_counters(1)  # grows with every job: who looks at it need not sleep
        self.count = 0
        self.growing = threading.Lock()

    def grow(self, count: int) -> None:
        """So many helpers at least."""
        with self.growing:
            while self.count < count:
                self.count += 1
                threading.Thread(target=self._help, name=f"tumble-helper-{self.count}", daemon=True).start()

    def _help(self) -> None:
        while True:
            work, arguments = self.jobs.get()
            try:
                work(*arguments)
            except Exception:
                log.exception("a helper failed before it took a part; others do the work")
            del work, arguments  # nothing of a world is kept while waiting
            seen = int(self.posted[0])
            if self.jobs.empty():
                linger(self.posted, seen)


_helpers = _Helpers()


def share(threads: int, work: Callable[..., Any], *arguments: Any) -> None:
    """Runs work(leads, *arguments) in so many threads; leads: True in this one, which returns when all is done."""
    helpers = _helpers
    if helpers.count < threads - 1:
        helpers.grow(threads - 1)
    for _ in range(threads - 1):
        if helpers.jobs.qsize() < MOST_WAITING * helpers.count:
            helpers.jobs.put((work, (False, *arguments)))
    count_up_outside(helpers.posted)
    work(True, *arguments)


@kernel
def count_up_outside(posted):
    """Tells helpers that linger."""
    count_up(posted, 0)


def _after_fork() -> None:
    """A forked process has none of its parent's threads."""
    _helpers.__init__()  # type: ignore[misc]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
