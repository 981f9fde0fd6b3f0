"""Watching the compiler: which kernels it really compiles, as against those it finds on disk."""

from __future__ import annotations

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
