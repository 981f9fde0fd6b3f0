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
        """Steps a second, over the last second."""
        now = time.perf_counter() if now is None else now
        self._trim(now)
        span = min(WINDOW, max(now - self._since, self.dt))
        return len(self._stamps) / span

    def behind(self, now: float | None = None) -> bool:
        """Whether the rate asked for is not reached."""
        now = time.perf_counter() if now is None else now
        asked = self.speed / self.dt
        short = TOLERANCE * asked - self.rate(now) > 1.0  # one step may fall on either side of the window's edge
        return now - self._since > PATIENCE and short

    def wait(self, now: float | None = None) -> float:
        """How long until the next step is due [s]."""
        now = time.perf_counter() if now is None else now
        owed = self._owed + (now - self._last) * self.speed
        return max(0.0, (self.dt - owed) / self.speed)

    def _trim(self, now: float) -> None:
        while self._stamps and self._stamps[0] <= now - WINDOW:
            self._stamps.popleft()
