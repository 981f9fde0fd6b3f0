"""Watching the compiler: which kernels it really compiles, as against those it finds on disk; and for how long."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import event


class _Announcer(event.Listener):
    """Tells of each kernel of ours that Python code asked for; helpers compiled on its behalf are part of it."""

    def __init__(self, announce: Callable[[str], None]) -> None:
        self._announce = announce
        self._depth = 0

    def on_start(self, event: Any) -> None:
        self._depth += 1
        function = event.data["dispatcher"].py_func
        if self._depth == 1 and function.__module__.startswith("engine."):
            self._announce(f"{function.__module__}.{function.__name__}")

    def on_end(self, event: Any) -> None:
        self._depth -= 1


@contextmanager
def watch_compilation(announce: Callable[[str], None]) -> Iterator[None]:
    """While this lasts, `announce(name)` is called before each kernel that is not on disk is compiled."""
    with event.install_listener("numba:compile", _Announcer(announce)):
        yield


class _Clock(event.Listener):
    """Adds up the CPU time of each kernel's compilation; what is compiled on behalf of one counts by itself."""

    def __init__(self, times: dict[str, float]) -> None:
        self._times = times
        self._open: list[str] = []
        self._since = 0.0

    def on_start(self, event: Any) -> None:
        self._note()
        function = event.data["dispatcher"].py_func
        name = f"{function.__module__}.{function.__name__}"
        if not name.startswith("engine.") and self._open:  # numpy's and numba's functions are part of ours
            name = self._open[-1]
        self._open.append(name)

    def on_end(self, event: Any) -> None:
        self._note()
        self._open.pop()

    def _note(self) -> None:
        now = time.thread_time()
        if self._open:
            self._times[self._open[-1]] = self._times.get(self._open[-1], 0.0) + now - self._since
        self._since = now


@contextmanager
def timed_compilation() -> Iterator[dict[str, float]]:
    """While this lasts, what each kernel takes to compile adds up in a dict, by its full name [s]."""
    times: dict[str, float] = {}
    with event.install_listener("numba:compile", _Clock(times)):
        yield times
