"""How the simulation is doing, in numbers."""

from __future__ import annotations

import html
import time

import numpy as np
import viser

from sandbox.frame import Frame
from web.panels.desk import Desk
from web.theme import PLOT_LINES

INTERVAL = 0.2  # s between two updates: faster cannot be read
SMOOTHING = 0.15  # share of a new frame in the shown stage times

_ROW = '<div style="display:flex;justify-content:space-between"><span style="opacity:.6">{}</span><span>{}</span></div>'
_STAGE = (
    '<div style="display:grid;grid-template-columns:7px 1fr auto;gap:6px;align-items:center;white-space:nowrap">'
    '<i style="height:7px;border-radius:2px;background:{colour}"></i>'
    '<span style="opacity:.6;overflow:hidden;text-overflow:ellipsis">{name}</span><span>{ms:.2f}</span></div>'
)
_SHARE = '<i style="width:{share:.1f}%;background:{colour}"></i>'
_BAR = (
    '<div style="grid-column:1/3;display:flex;height:7px;margin:6px 0 5px;border-radius:3px;overflow:hidden">{}</div>'
)
_WARNING = (
    '<div style="margin:0 0 4px;padding:0 9px;border-radius:5px;border-left:3px solid {colour};'
    'background:{colour}22">{text}</div>'
)
_COLUMNS = (
    '<div style="display:grid;grid-template-columns:125px 160px 1fr;gap:18px">'
    "<div>{}</div><div>{}</div>"
    '<div style="display:grid;grid-template-columns:1fr 1fr;gap:0 14px;align-content:start;font-size:.9em">{}</div>'
    "</div>"
)
_PAGE = '<div style="padding:2px 14px 8px;font-size:.85em;line-height:1.5;font-variant-numeric:tabular-nums">{}</div>'


class StatusPanel:
    def __init__(self, desk: Desk) -> None:
        with desk.hud.add_tab("Status", viser.Icon.ACTIVITY):
            self._view = desk.gui.add_html(status_html(None, {}))
        self._page = desk.page
        self._next = 0.0
        self._warnings = ""
        self._notice = ""
        self._stage_ms: dict[str, float] = {}

    def update(self, frame: Frame) -> None:
        self._stage_ms = {
            name: ms if name not in self._stage_ms else self._stage_ms[name] * (1 - SMOOTHING) + ms * SMOOTHING
            for name, ms in frame.stage_ms.items()
        }
        self._tell(frame.status.notice)
        warnings = _warnings(frame)
        now = time.monotonic()
        # A paused session sends a last frame and no further one: that one must not fall into the interval.
        if now >= self._next or warnings != self._warnings or frame.status.paused:
            self._next, self._warnings = now + INTERVAL, warnings
            self._view.content = status_html(frame, self._stage_ms)

    def _tell(self, notice: str) -> None:
        """What the session has to say once, as a message that goes away."""
        if notice != self._notice:
            self._notice = notice
            if notice:
                self._page.notify("tumble", notice)


def status_html(frame: Frame | None, stage_ms: dict[str, float], is_live: bool = True) -> str:
    """A table of numbers; of a recording, without how fast the session was."""
    if frame is None:
        return _PAGE.format("waiting for the first frame")
    status, numbers = frame.status, frame.diagnostics
    asked = round(status.speed / frame.dt) if frame.dt > 0.0 else 0
    course = [
        ("time", f"{frame.time:.2f} s"),
        ("steps", f"{frame.step:,}"),
        ("steps/s", "paused" if status.paused else f"{status.steps_per_second:.0f} of {asked}"),
        ("ms per step", f"{sum(stage_ms.values()):.2f}"),
    ]
    content = [
        ("bodies", f"{len(frame.serials):,}"),
        ("asleep", f"{np.count_nonzero(frame.asleep):,}"),
        ("contacts", f"{len(frame.contacts):,}"),
        ("joints", f"{len(frame.joints):,}"),
        ("deepest overlap", f"{1000.0 * numbers.max_penetration:.2f} mm"),
    ]
    columns = _COLUMNS.format(_rows(course if is_live else course[:2]), _rows(content), _stages(stage_ms))
    return _PAGE.format(_warnings(frame) + columns)


def _rows(rows: list[tuple[str, str]]) -> str:
    return "".join(_ROW.format(name, value) for name, value in rows)


def _stages(stage_ms: dict[str, float]) -> str:
    """A bar divided as the step's time is, and what its parts are."""
    total = sum(stage_ms.values()) or 1.0
    colours = [PLOT_LINES[index % len(PLOT_LINES)] for index in range(len(stage_ms))]
    stages = list(zip(stage_ms.items(), colours, strict=True))
    bar = "".join(_SHARE.format(share=100.0 * ms / total, colour=colour) for (_, ms), colour in stages)
    names = "".join(_STAGE.format(name=html.escape(name), ms=ms, colour=colour) for (name, ms), colour in stages)
    return _BAR.format(bar) + names


def _warnings(frame: Frame) -> str:
    """What needs attention. Text from elsewhere is escaped: this is HTML."""
    status, text = frame.status, ""
    if status.failure:
        text += _WARNING.format(colour="#d4646c", text=html.escape(status.failure))
    if status.behind and frame.dt > 0.0:
        asked, done = round(status.speed / frame.dt), status.steps_per_second
        text += _WARNING.format(colour="#d6a04c", text=f"cannot keep real time: {done:.0f} of {asked} steps/s")
    return text
