"""The work-precision diagram as PNG: error against CPU time, a panel a measure, a line a series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sandbox.lab.accuracy.groups import LEAST, Group, by_measure, by_series, drawable, height, solvers_of
from sandbox.lab.accuracy.pareto import front
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.style import (
    BACKDROP,
    GRID,
    MARKERS,
    SPAN,
    TEXT,
    VARIED,
    colour_of,
    kind_of,
    main_series,
)

NEAR = 0.03  # of points whose labels would lie on each other [decades]
COLUMNS = 3
INCHES = 4.8  # a panel


def draw(rows: Sequence[Row], path: Path) -> None:
    """Writes the diagram as PNG."""
    figure_of(rows).savefig(path, facecolor=BACKDROP)


def figure_of(rows: Sequence[Row]) -> Any:
    """The diagram, as matplotlib has it."""
    import matplotlib as mpl  # half a second, and needed by this alone
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    groups, solvers = by_measure(rows), solvers_of(rows)
    columns = min(COLUMNS, len(groups))
    lines = math.ceil(len(groups) / columns)
    with mpl.rc_context({"font.size": 9, "text.color": TEXT, "axes.labelcolor": TEXT, "axes.edgecolor": GRID}):
        size = (INCHES * columns, 0.8 * INCHES * lines + 0.5)
        figure = Figure(size, dpi=110, facecolor=BACKDROP, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(lines, columns, squeeze=False).ravel()
        for axis, group in zip(axes, groups, strict=False):
            draw_panel(axis, group, solvers)
        for axis in axes[len(groups) :]:
            axis.axis("off")
        draw_legend(figure, rows, solvers)
    return figure


def draw_panel(axis: Any, group: Group, solvers: Sequence[str]) -> None:
    """One measure."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set(xscale="log", yscale="log", facecolor=BACKDROP)
    axis.set_title(f"{group.scene}\n{group.says}", fontsize=9, color=TEXT)
    axis.set_xlabel("CPU time of a simulated second [ms]")
    axis.set_ylabel("error")
    axis.grid(color=GRID, linewidth=0.6)
    axis.xaxis.set(major_locator=LogLocator(subs=(1, 2, 5)), major_formatter=FuncFormatter("{:g}".format))
    axis.xaxis.set(minor_formatter=NullFormatter())
    axis.tick_params(colors=TEXT, which="both")
    bold, best = main_series(group.rows), front(drawable(group.rows))
    for name, line in by_series(drawable(group.rows)).items():
        draw_line(axis, line, colour_of(line[0].solver, solvers), kind_of(name), name in bold)
    if best:
        places = [(row.cost_ms, height(row)) for row in best]
        axis.scatter(*zip(*places, strict=True), s=70, facecolors="none", edgecolors=TEXT, linewidths=0.9, zorder=4)
    widen(axis)


def draw_line(axis: Any, line: Sequence[Row], colour: str, kind: str, bold: bool) -> None:
    """One series, its labels and what was predicted for it; all but the bold ones stay in the background."""
    axis.plot(
        [row.cost_ms for row in line], [height(row) for row in line], color=colour, marker=MARKERS[kind],
        markersize=4, linewidth=1.8 if bold else 0.8, alpha=1.0 if bold else 0.5,
    )  # fmt: skip
    if bold:
        for place, label in labels(line):
            axis.annotate(label, place, (3, 4), textcoords="offset points", color=colour, fontsize=7)
    known = [(row.cost_ms, max(row.predicted, LEAST)) for row in line if row.predicted is not None]
    if known and (bold or kind == "fixed"):
        axis.plot(*zip(*known, strict=True), color=colour, linestyle="--", linewidth=0.9, alpha=0.8)


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
        place = (row.cost_ms, height(row))
        near = found and max(abs(math.log10(a / b)) for a, b in zip(place, found[-1][0], strict=True)) < NEAR
        if not near:
            found.append((place, row.label))
    return found


def draw_legend(figure: Any, rows: Sequence[Row], solvers: Sequence[str]) -> None:
    """What colours and markers mean."""
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=colour_of(name, solvers), linewidth=1.8, label=name) for name in solvers]
    kinds = {kind_of(row.series) for row in rows}
    handles += [
        Line2D([], [], color=TEXT, marker=MARKERS[kind], linestyle="", markersize=4, label=name)
        for kind, name in VARIED.items()
        if kind in kinds
    ]
    handles.append(Line2D([], [], color=TEXT, linestyle="--", linewidth=0.9, label="predicted"))
    figure.legend(
        handles=handles, loc="outside lower left", frameon=False, labelcolor=TEXT, fontsize=8, ncols=4
    )  # fmt: skip
