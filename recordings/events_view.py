"""What happened, to look at: hits as points that grow with their speed, and a log of all but what merely moved."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import rerun as rr

from recordings import schema
from recordings.columns import Sheet, time_columns
from recordings.shot import Shot

_ABOVE = 0.12  # over the bodies, as far as contacts are, and a little more [m]
_RADIUS = 0.003  # of a hit of 1 m/s, in heights of the view; it grows with the root of the speed
_LARGEST = 0.03  # in heights of the view
_NAMED = 8  # events of one kind that a line of the log names; of the rest it says how many


class HitsView:
    """Each hit as a point in the step that it happened in."""

    def __init__(self, view_height: float) -> None:
        self._height = view_height  # [m]
        self._shown = False

    def sheets(self, shots: list[Shot]) -> Iterator[Sheet]:
        """One sheet; none while there is nothing to show and was nothing before."""
        counts = np.array([len(shot.events.hit) for shot in shots])
        if counts.any() or self._shown:
            hits = np.concatenate([shot.events.hit for shot in shots])
            places = np.column_stack([hits["x"], hits["y"], np.full(len(hits), _ABOVE)]).astype(np.float32)
            radii = self._height * np.minimum(_RADIUS * np.sqrt(hits["speed"]), _LARGEST)
            columns = rr.Points3D.columns(positions=places, radii=radii.astype(np.float32)).partition(counts)
            times = time_columns([shot.step for shot in shots], [shot.time for shot in shots])
            yield Sheet(schema.HIT_POINTS, times, list(columns))
        self._shown = bool(counts[-1])


def happened_sheets(shots: list[Shot]) -> Iterator[Sheet]:
    """A line in the log for each kind of events of each step."""
    lines = [(shot.step, shot.time, *line) for shot in shots for line in _lines(shot)]
    if lines:
        steps, times, texts, levels = zip(*lines, strict=True)
        columns = rr.TextLog.columns(text=texts, level=levels)
        yield Sheet(schema.HAPPENED, time_columns(steps, times), list(columns))


def _lines(shot: Shot) -> Iterator[tuple[str, str]]:
    """Texts and levels of one step."""
    for kind, named in _TEXTS.items():
        rows = getattr(shot.events, kind)
        if len(rows):
            more = f" and {len(rows) - _NAMED} more" if len(rows) > _NAMED else ""
            listed = ", ".join(named(row) for row in rows[:_NAMED])
            yield f"{kind.replace('_', ' ')}  {listed}{more}", "WARN" if kind == "broken" else "INFO"


def _pair(row: np.void) -> str:
    return f"{row['body1']}-{row['body2']}"


def _hit(row: np.void) -> str:
    return f"{_pair(row)} at ({row['x']:.3g}, {row['y']:.3g}) with {row['speed']:.3g} m/s"


def _body(row: np.void) -> str:
    return str(row["body"])


def _broken(row: np.void) -> str:
    return f"joint {row['joint']} of {_pair(row)} by {row['force']:.3g} N, {row['torque']:.3g} N m"


_TEXTS: dict[str, Callable[[np.void], str]] = {
    "begin": _pair, "end": _pair, "hit": _hit, "fell_asleep": _body, "woke": _body, "broken": _broken,
}  # fmt: skip
