"""Ending cleanly: Ctrl-C and a polite kill set an event instead of raising in the middle of something."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Stop:
    """Set by SIGINT or SIGTERM; `wait` returns then."""

    def __init__(self) -> None:
        self._event = threading.Event()
        self.signal = 0

    def wait(self) -> None:
        while not self._event.wait(0.5):  # in bites: some platforms deliver signals only between them
            pass

    @property
    def requested(self) -> bool:
        return self._event.is_set()

    def handle(self, number: int, frame: FrameType | None) -> None:
        if self._event.is_set():  # asked twice: at once
            raise KeyboardInterrupt
        self.signal = number
        self._event.set()


@contextmanager
def stop_requested() -> Iterator[Stop]:
    """While this lasts, SIGINT and SIGTERM set the Stop it gives; a second one interrupts at once."""
    stop = Stop()
    before = {number: signal.signal(number, stop.handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def interruptible() -> Iterator[None]:
    """While this lasts, SIGTERM interrupts as Ctrl-C does: for what has nothing to finish first."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
