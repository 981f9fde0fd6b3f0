"""Stage times and energy over the last seconds."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

import numpy as np
import viser
from viser import uplot

from sandbox.frame import Frame
from web.panels.desk import Desk
from web.theme import PLOT_GRID, PLOT_LINES, PLOT_TEXT

INTERVAL = 0.1  # s between two points
SENDS_EVERY = 3  # points: a plot is sent as a whole each time
POINTS = 240  # the last 24 s
HEIGHT = 104  # pixels, with axis and legend: hardly higher than the window's other tabs
AXIS_WIDTH = 58  # pixels: room for six digits

Values = dict[str, float]


class PlotsPanel:
    def __init__(self, desk: Desk) -> None:
        with desk.hud.add_tab("Times [ms]", viser.Icon.CHART_LINE):
            self._stages = Plot(desk.gui)
        with desk.hud.add_tab("Energy [J]", viser.Icon.CHART_LINE):
            self._energy = Plot(desk.gui)
        self._next = 0.0
        self._count = 0
        self._times: list[Values] = []  # of the frames since the last point
        self._last: tuple[str, float] = ("", -1.0)

    def update(self, frame: Frame) -> None:
        now = time.monotonic()
        scene, last_time = self._last
        if scene != frame.scene or frame.time < last_time:
            self._times.clear()
            self._stages.clear()
            self._energy.clear()
        elif frame.time == last_time:
            return
        self._last = (frame.scene, frame.time)
        self._times.append(frame.stage_ms)
        if now >= self._next:
            self._next = now + INTERVAL
            self._add_point(frame)

    def _add_point(self, frame: Frame) -> None:
        self._stages.add(frame.time, _medians(self._times))
        self._energy.add(frame.time, _energies(frame))
        self._times.clear()
        self._count += 1
        if self._count % SENDS_EVERY == 0:
            self._stages.send()
            self._energy.send()


def _medians(times: list[Values]) -> Values:
    """Not the mean: one step in which something was compiled would flatten all others."""
    names = times[-1]
    return {name: float(np.median([stages[name] for stages in times if name in stages])) for name in names}


def _energies(frame: Frame) -> Values:
    kinetic, potential = frame.diagnostics.kinetic_energy, frame.diagnostics.potential_energy
    return {"kinetic": kinetic, "potential": potential, "total": kinetic + potential}


class Plot:
    """Lines over simulated time. Which lines is known from the values, so it follows a change of solver."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._names: tuple[str, ...] = ()
        self._points: deque[tuple[float, ...]] = deque(maxlen=POINTS)
        nothing = np.zeros(0)
        self._handle = gui.add_uplot(
            (nothing, nothing),
            series=_series(("",)),
            scales={"x": uplot.Scale(time=False)},
            axes=(_axis(36), _axis(AXIS_WIDTH)),
            legend=uplot.Legend(show=True, live=False),
            cursor=uplot.Cursor(show=False),
            height=HEIGHT,
            padding=(8, 16, 0, 0),
        )

    def clear(self) -> None:
        self._points.clear()

    def add(self, moment: float, values: Values) -> None:
        names = tuple(values)
        if not names:
            return
        if names != self._names:
            self._names = names
            self._points.clear()
            self._handle.series = _series(names)
        self._points.append((moment, *values.values()))

    def send(self) -> None:
        if self._points:
            self._handle.data = tuple(np.array(self._points, np.float64).T.copy())


def _series(names: tuple[str, ...]) -> tuple[Any, ...]:
    colours = (PLOT_LINES[index % len(PLOT_LINES)] for index in range(len(names)))
    lines = (
        uplot.Series(label=name, stroke=colour, width=1.5, points={"show": False})
        for name, colour in zip(names, colours, strict=True)
    )
    return (uplot.Series(label="t"), *lines)


def _axis(size: int) -> uplot.Axis:
    return uplot.Axis(
        stroke=PLOT_TEXT, grid={"stroke": PLOT_GRID, "width": 1}, ticks={"stroke": PLOT_GRID, "width": 1}, size=size
    )
