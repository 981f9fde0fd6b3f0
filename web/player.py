"""Where in a recording one is, and how that moves on with time."""

from __future__ import annotations

import threading
import time

TICK = 1.0 / 60.0  # s between two looks at the clock


class Player:
    """Where in a recording one is. Calls come from the page's thread and from the player's own."""

    def __init__(self, count: int, dt: float, start_time: float = 0.0) -> None:
        self.last = count - 1
        self.speed = 1.0  # recorded seconds per second
        self.playing = True
        self.sought = -1e9  # when somebody last chose a moment
        self._dt = dt if dt > 0.0 else TICK
        self._start_time = start_time
        self._position = 0.0  # in steps
        self._time: float | None = None
        self._lock = threading.Lock()

    def time_of(self, index: int) -> float:
        return self._start_time + index * self._dt

    def index_at(self, moment: float) -> int:
        return round((moment - self._start_time) / self._dt)

    def toggle(self) -> None:
        with self._lock:
            self.playing = not self.playing
            if self.playing and self._position >= self.last:
                self._position = 0.0

    def seek(self, index: int) -> None:
        with self._lock:
            self._position = float(min(max(index, 0), self.last))
            self.sought = time.monotonic()

    def step(self, by: int) -> None:
        with self._lock:
            self.playing = False
            self._position = float(min(max(int(self._position) + by, 0), self.last))

    def advance(self, now: float) -> int:
        """The step to show at this moment; playing stops at the end."""
        with self._lock:
            passed = 0.0 if self._time is None else now - self._time
            self._time = now
            if self.playing:
                self._position += passed * self.speed / self._dt
                if self._position >= self.last:
                    self._position, self.playing = float(self.last), False
            return int(self._position)
