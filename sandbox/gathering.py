"""Events of several steps on their way to somebody who looks less often: none are lost, up to a bound."""

from __future__ import annotations

from engine import Events
from engine.events import NOTHING, joined

MOST = 1_000_000  # events that wait; beyond that the steps longest ago are dropped


class Gathering:
    """Events that nobody has taken yet."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._parts: list[Events] = []
        self._count = 0
        self._lost = 0

    def add(self, events: Events, lost: int = 0) -> None:
        """Those of the next step or steps; `lost`: how many of them were dropped before."""
        count = sum(map(len, events))
        self._lost += lost
        if count:
            self._parts.append(events)
            self._count += count
        while self._count > self._most and len(self._parts) > 1:
            dropped = sum(map(len, self._parts.pop(0)))
            self._count -= dropped
            self._lost += dropped

    def take(self) -> tuple[Events, int]:
        """All that came since the last call, in order; and how many were dropped."""
        events, lost = joined(self._parts) if self._parts else NOTHING, self._lost
        self.clear()
        return events, lost

    def clear(self) -> None:
        self._parts, self._count, self._lost = [], 0, 0
