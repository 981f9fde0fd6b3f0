"""What happened lately: the last ten events, and how many of each kind there were."""

from __future__ import annotations

import html
import time
from collections import deque
from collections.abc import Callable

import numpy as np

from engine import Events
from sandbox.frame import Frame
from web.panels.desk import Desk

INTERVAL = 0.2  # s between two updates: faster cannot be read
LATEST = 10
UNLISTED = ("moved",)  # kinds that are counted alone: in most steps something moves

_PAGE = '<div style="padding:2px 14px 8px;font-size:.82em;line-height:1.5;font-variant-numeric:tabular-nums">{}</div>'
_LINE = '<div style="white-space:nowrap;overflow:hidden;text-overflow:ellipsis">{}</div>'
_COUNTS = '<div style="opacity:.7;padding-bottom:4px">{}</div>'
_OFF = "nobody asks for them: switch on tell events, under Physics"


class EventsPanel:
    def __init__(self, desk: Desk) -> None:
        with desk.gui.add_folder("Events", expand_by_default=False):
            self._view = desk.gui.add_html(_PAGE.format(_OFF))
        self._content = _PAGE.format(_OFF)
        self._next = 0.0
        self._tally = Tally()

    def update(self, frame: Frame) -> None:
        self._tally.add(frame)
        now = time.monotonic()
        # a paused session sends a last frame and no further one: that one must not fall into the interval
        if now < self._next and not frame.status.paused:
            return
        self._next = now + INTERVAL
        content = events_html(self._tally) if frame.settings.tell_events else _PAGE.format(_OFF)
        if content != self._content:
            self._content = self._view.content = content


class Tally:
    """What came since the scene began, as far as it is shown."""

    def __init__(self) -> None:
        self._at = ("", -1)
        self.clear()

    def clear(self) -> None:
        self.counts = dict.fromkeys(Events._fields, 0)
        self.lost = 0
        self.latest: deque[str] = deque(maxlen=LATEST)  # the last one first

    def add(self, frame: Frame) -> None:
        """Takes up a frame's events; another scene, or the same one begun again, starts anew."""
        scene, step = self._at
        if frame.scene != scene or frame.step < step:
            self.clear()
        self._at = (frame.scene, frame.step)
        self.lost += frame.events_lost
        for kind, rows in zip(Events._fields, frame.events, strict=True):
            self.counts[kind] += len(rows)
        self.latest.extendleft(latest_lines(frame.events, LATEST))


def latest_lines(events: Events, most: int) -> list[str]:
    """The last of them as text, in the order of their steps; those of one step in the order of Events."""
    found: list[tuple[int, str]] = []
    for kind, rows in zip(Events._fields, events, strict=True):
        if kind not in UNLISTED:
            found += [(int(row["step"]), f"{kind.replace('_', ' ')} {_TEXTS[kind](row)}") for row in rows[-most:]]
    found.sort(key=lambda line: line[0])
    return [f"{step:,}: {text}" for step, text in found[-most:]]


def events_html(tally: Tally) -> str:
    """Counts, then a line for each of the latest."""
    counts = ", ".join(f"{count:,} {kind.replace('_', ' ')}" for kind, count in tally.counts.items() if count)
    if tally.lost:
        counts += f"; {tally.lost:,} more were lost"
    lines = "".join(_LINE.format(html.escape(line)) for line in tally.latest)
    return _PAGE.format(_COUNTS.format(counts or "nothing yet") + lines)


def _pair(row: np.void) -> str:
    return f"{row['body1']} and {row['body2']}"


def _hit(row: np.void) -> str:
    return f"{_pair(row)} with {row['speed']:.2f} m/s"


def _body(row: np.void) -> str:
    return str(row["body"])


def _broken(row: np.void) -> str:
    return f"joint {row['joint']} of {_pair(row)}: {row['force']:.3g} N, {row['torque']:.3g} N m"


_TEXTS: dict[str, Callable[[np.void], str]] = {
    "begin": _pair, "end": _pair, "hit": _hit, "fell_asleep": _body, "woke": _body, "broken": _broken,
}  # fmt: skip
