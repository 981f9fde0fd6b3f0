"""Frames come as fast as the simulation runs; browsers get only the latest one, at a rate that they can draw.

What happened in the others is told with it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace

from sandbox.frame import Frame
from sandbox.gathering import Gathering
from web.guard import log

RATES = ((2_000, 60.0), (10_000, 30.0))  # up to so many pieces of bodies, so many frames a second
RATE_BEYOND = 15.0
EARLY = 0.8  # of the interval is waited, else a 60 Hz source would now and then just miss a 60 Hz display


class Publisher:
    """A thread that hands the latest frame to `draw`. `put` returns at once, whatever the browsers do."""

    def __init__(self, draw: Callable[[Frame], None]) -> None:
        self._draw = draw
        self._changed = threading.Condition()
        self._frame: Frame | None = None
        self._events = Gathering()  # also of the frames that are not drawn
        self._is_new = False
        self._closed = False
        self._complaint = ""
        self.rate_limit = RATES[0][1]  # Hz, what the user asks for at most
        self._thread = threading.Thread(target=self._run, name="tumble-page", daemon=True)
        self._thread.start()

    @property
    def frame(self) -> Frame | None:
        return self._frame

    def put(self, frame: Frame) -> None:
        with self._changed:
            self._frame = frame
            self._events.add(frame.events, frame.events_lost)
            self._is_new = True
            self._changed.notify()

    def again(self) -> None:
        """Draw the latest frame once more: what is shown of it has changed."""
        with self._changed:
            self._is_new = self._frame is not None
            self._changed.notify()

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify()
        if self._thread is not threading.current_thread():
            self._thread.join(timeout=2.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._is_new or self._closed)
                if self._closed or self._frame is None:
                    return
                events, lost = self._events.take()
                frame, self._is_new = replace(self._frame, events=events, events_lost=lost), False
            start = time.monotonic()
            self._draw_safely(frame)
            pause = start + EARLY / self._rate(frame) - time.monotonic()
            if pause > 0.0:
                time.sleep(pause)

    def _draw_safely(self, frame: Frame) -> None:
        """A fault in one picture must not end all others; it is told once, not sixty times a second."""
        try:
            self._draw(frame)
        except Exception as error:  # noqa: BLE001 - as said above
            complaint = f"{type(error).__name__}: {error}"
            if complaint != self._complaint:
                log.error("a frame could not be drawn: %s", complaint, exc_info=log.isEnabledFor(10))
            self._complaint = complaint

    def _rate(self, frame: Frame) -> float:
        pieces = len(frame.shape_serials)
        return min(self.rate_limit, next((rate for most, rate in RATES if pieces <= most), RATE_BEYOND))
