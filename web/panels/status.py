"""How the simulation is doing, in numbers."""

from __future__ import annotations

import html
import time

import viser

from sandbox.frame import Frame
from web.panels.desk import Desk
from web.theme import PLOT_LINES

INTERVAL = 0.2  # s between two updates: faster cannot be read
SMOOTHING = 0.15  # share of a new frame in the shown stage times

_ROW = '<div style="display:flex;justify-content:space-between"><span style="opacity:.6">{}</span><span>{}</span></div>'
_BAR = (
    '<div style="display:grid;grid-template-columns:1fr 44px 3.2em;gap:8px;align-items:center;font-size:.86em">'
    '<span style="opacity:.6;white-space:nowrap;overflow:hidden;text-overflow:ellipsis">{name}</span>'
    '<span style="height:4px;border-radius:2px;background:#8883">'
    '<i style="display:block;height:4px;border-radius:2px;width:{share:.0f}%;background:{colour}"></i></span>'
    '<span style="text-align:right">{ms:.2f}</span></div>'
)
_WARNING = (
    '<div style="margin:6px 0;padding:6px 9px;border-radius:5px;border-left:3px solid {colour};'
    'background:{colour}22">{text}</div>'
)
_PAGE = '<div style="padding:4px 14px 10px;font-size:.85em;line-height:1.55;font-variant-numeric:tabular-nums">{}</div>'


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
    rows = [
        ("time", f"{frame.time:.2f} s"),
        ("steps", f"{frame.step:,}"),
        ("steps/s", "paused" if status.paused else f"{status.steps_per_second:.0f} of {asked}"),
        ("bodies", f"{len(frame.serials):,}"),
        ("contacts", f"{len(frame.contacts):,}"),
        ("deepest overlap", f"{1000.0 * numbers.max_penetration:.2f} mm"),
        ("ms per step", f"{sum(stage_ms.values()):.2f}"),
    ]
    if not is_live:
        rows = [row for row in rows if row[0] not in ("steps/s", "ms per step")]
    text = _warnings(frame) + "".join(_ROW.format(html.escape(name), value) for name, value in rows)
    return _PAGE.format(text + _bars(stage_ms))


def _bars(stage_ms: dict[str, float]) -> str:
    total = sum(stage_ms.values()) or 1.0
    return "".join(
        _BAR.format(name=html.escape(name), share=100.0 * ms / total, ms=ms, colour=PLOT_LINES[index % len(PLOT_LINES)])
        for index, (name, ms) in enumerate(stage_ms.items())
    )


def _warnings(frame: Frame) -> str:
    """What needs attention. Text from elsewhere is escaped: this is HTML."""
    status, text = frame.status, ""
    if status.failure:
        text += _WARNING.format(colour="#d4646c", text=html.escape(status.failure))
    if status.behind and frame.dt > 0.0:
        asked, done = round(status.speed / frame.dt), status.steps_per_second
        text += _WARNING.format(colour="#d6a04c", text=f"cannot keep real time: {done:.0f} of {asked} steps/s")
    return text
