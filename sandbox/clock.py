"""Keeping real time: how many steps are due, how long to sleep, and whether we fall behind."""

from __future__ import annotations

import time
from collections import deque

MOST_AT_ONCE = 4  # steps without a look at the commands: a slow world stays responsive
WINDOW = 1.0  # over which the rate is measured [s]
TOLERANCE = 0.95  # of the rate asked for: below that we are behind
PATIENCE = 2.0  # a rate is judged only after so long [s]


class Clock:
    """Turns wall time into due steps. `now` is for tests."""

    def __init__(self, dt: float, now: float | None = None) -> None:
        self.dt = dt
        self.speed = 1.0
        self._owed = 0.0  # wall time not yet stepped, times speed [s]
        self._stamps: deque[float] = deque()  # wall times of the steps in the window
        self._last = time.perf_counter() if now is None else now
        self._since = self._last

    def restart(self, now: float | None = None) -> None:
        """Forgets what is owed: after a pause, a reset, a change of speed."""
        self._last = time.perf_counter() if now is None else now
        self._since = self._last
        self._owed = 0.0
        self._stamps.clear()

    def due(self, now: float | None = None) -> int:
        """Steps to take now. What cannot be caught up is dropped: the simulation slows, it does not pile up."""
        now = time.perf_counter() if now is None else now
        self._owed += (now - self._last) * self.speed
        self._last = now
        steps = int(self._owed / self.dt)
        if steps > MOST_AT_ONCE:
            self._owed = self._owed % self.dt
            return MOST_AT_ONCE
        self._owed -= steps * self.dt
        return steps

    def count(self, now: float | None = None) -> None:
        """A step was taken."""
        now = time.perf_counter() if now is None else now
        self._stamps.append(now)
        self._trim(now)

    def rate(self, now: float | None = None) -> float:
        """Steps a second: between the first and the last step of the last second, less while one is overdue."""
        now = time.perf_counter() if now is None else now
        self._trim(now)
        if len(self._stamps) < 2:
            return 0.0
        overdue = now - self._stamps[-1] - self.dt / self.speed
        return (len(self._stamps) - 1) / (self._stamps[-1] - self._stamps[0] + max(0.0, overdue))

    def behind(self, now: float | None = None) -> bool:
        """Whether the rate asked for is not reached."""
        now = time.perf_counter() if now is None else now
        return now - self._since > PATIENCE and self.rate(now) < TOLERANCE * self.speed / self.dt

    def wait(self, now: float | None = None) -> float:
        """How long until the next step is due [s]."""
        now = time.perf_counter() if now is None else now
        owed = self._owed + (now - self._last) * self.speed
        return max(0.0, (self.dt - owed) / self.speed)

    def _trim(self, now: float) -> None:
        """Forgets what is older than the window, but not the last two steps: they are the rate of a slow world."""
        while len(self._stamps) > 2 and self._stamps[0] < now - WINDOW:
            self._stamps.popleft()
