"""The work-precision diagram: error against CPU time, a panel a measure, a line a series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.lab.accuracy import Row
from sandbox.lab.accuracy_report import by_measure, by_series, measure_of, says

# The page's colours (web/theme.py), restated: the laboratory does not import the page. A test compares them.
BACKDROP = "#23262d"
LINES = ("#6e9ec7", "#d6b574", "#7eb2a8", "#cd7d86", "#a888bc", "#9db47c")
TEXT = "#9aa4b5"
GRID = "#2b313c"
MARKERS = ("o", "s", "D", "v", "^", "P")
LEAST = 1e-9  # what is less is drawn as this: an error may be zero
SPAN = 4.0
CLOSE = 0.03  # of points whose labels would lie on each other [decades]
COLUMNS = 4
INCHES = 4.4  # a panel


def draw(rows: Sequence[Row], path: Path) -> None:
    """Writes the diagram as PNG."""
    figure_of(rows).savefig(path, facecolor=BACKDROP)


def as_image(rows: Sequence[Row]) -> np.ndarray:
    """(H, W, 3) uint8: the diagram."""
    figure = figure_of(rows)
    figure.canvas.draw()
    return np.array(figure.canvas.buffer_rgba())[:, :, :3]


def figure_of(rows: Sequence[Row]) -> Any:
    """The diagram, as matplotlib has it."""
    import matplotlib as mpl  # half a second, and needed by this alone
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    panels = by_measure(rows)
    columns = min(COLUMNS, len(panels) + 1)
    lines = math.ceil((len(panels) + 1) / columns)  # the last cell holds the legend
    with mpl.rc_context({"font.size": 9, "text.color": TEXT, "axes.labelcolor": TEXT, "axes.edgecolor": GRID}):
        figure = Figure((INCHES * columns, 0.85 * INCHES * lines), dpi=110, facecolor=BACKDROP, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(lines, columns, squeeze=False).ravel()
        names = list(dict.fromkeys(row.series for row in rows))
        for axis, (_, group) in zip(axes, panels, strict=False):
            draw_panel(axis, group, names)
        for axis in axes[len(panels) :]:
            axis.axis("off")
        draw_legend(axes[-1], names)
    return figure


def draw_panel(axis: Any, rows: Sequence[Row], names: Sequence[str]) -> None:
    """One measure."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    first = rows[0]
    axis.set(xscale="log", yscale="log", facecolor=BACKDROP)
    axis.set_title(f"{first.scene}\n{says(measure_of(first.scene, first.measure))}", fontsize=9, color=TEXT)
    axis.set_xlabel("CPU time of a simulated second [ms]")
    axis.set_ylabel("error")
    axis.grid(color=GRID, linewidth=0.6)
    axis.xaxis.set(major_locator=LogLocator(subs=(1, 2, 5)), major_formatter=FuncFormatter("{:g}".format))
    axis.xaxis.set(minor_formatter=NullFormatter())
    axis.tick_params(colors=TEXT, which="both")
    for name, line in by_series(rows).items():
        colour, marker = look_of(name, names)
        drawn = [row for row in line if math.isfinite(row.error)]
        cost = [row.cost_ms for row in drawn]
        axis.plot(
            cost, [max(row.error, LEAST) for row in drawn], color=colour, marker=marker, markersize=4, linewidth=1.4
        )
        for place, label in labels(drawn):
            axis.annotate(label, place, (3, 3), textcoords="offset points", color=colour, fontsize=7)
        known = [(row.cost_ms, row.predicted) for row in line if row.predicted is not None]
        if known:
            axis.plot(*zip(*known, strict=True), color=colour, linestyle="--", linewidth=0.9, alpha=0.8)
    widen(axis)


def widen(axis: Any) -> None:
    """Makes the times span two octaves at least: noise shall not look like news."""
    low, high = axis.get_xlim()
    if high < SPAN * low:
        middle = math.sqrt(low * high)
        axis.set_xlim(middle / math.sqrt(SPAN), middle * math.sqrt(SPAN))


def labels(rows: Sequence[Row]) -> list[tuple[tuple[float, float], str]]:
    """Where to write which label: none where it would lie on the one before."""
    found: list[tuple[tuple[float, float], str]] = []
    for row in rows:
        place = (row.cost_ms, max(row.error, LEAST))
        near = found and max(abs(math.log10(a / b)) for a, b in zip(place, found[-1][0], strict=True)) < CLOSE
        if not near:
            found.append((place, row.label))
    return found


def draw_legend(axis: Any, names: Sequence[str]) -> None:
    """What the lines are."""
    for name in names:
        colour, marker = look_of(name, names)
        axis.plot([], [], color=colour, marker=marker, markersize=4, linewidth=1.4, label=name)
    axis.plot([], [], color=TEXT, linestyle="--", linewidth=0.9, label="predicted, in the colour of its line")
    axis.legend(loc="center", frameon=False, labelcolor=TEXT, fontsize=9)


def look_of(name: str, names: Sequence[str]) -> tuple[str, str]:
    """Colour and marker of a series."""
    k = names.index(name)
    return LINES[k % len(LINES)], MARKERS[k % len(MARKERS)]
