"""The work-precision diagram as SVG: a panel a measure, a line a series, each point with a title that tells all of it.

Error against price, both logarithmic. Colours stand for solvers, markers for what is varied; bold is the line of the
setting that one would turn first. Dashed: the error that is predicted. Rings: what no other setting beats in both.
"""

from __future__ import annotations

import html
import math
from collections.abc import Sequence
from dataclasses import dataclass

from sandbox.lab.accuracy.groups import LEAST, Group, by_measure, by_series, drawable, height, number, solvers_of
from sandbox.lab.accuracy.pareto import Price, front, milliseconds
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.style import CLOSE, SPAN, VARIED, colour_of, kind_of, main_series, style

WIDTH, HEIGHT = 560, 400  # of a panel [pixels]
LEFT, RIGHT, TOP, BOTTOM = 62, 14, 44, 46  # around its axes
PRICES = {"ms": "CPU time of a simulated second [ms]", "solves": "constraints solved in the run"}


@dataclass(frozen=True)
class Axes:
    """From numbers to pixels, logarithmic."""

    x: tuple[float, float]  # least and greatest, as powers of ten
    y: tuple[float, float]

    def place(self, price: float, error: float) -> tuple[float, float]:
        across = (math.log10(price) - self.x[0]) / (self.x[1] - self.x[0])
        up = (math.log10(max(error, LEAST)) - self.y[0]) / (self.y[1] - self.y[0])
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - up * (HEIGHT - TOP - BOTTOM)


def as_svg(rows: Sequence[Row], css: str = "") -> str:
    """A picture by itself: all measures of a scene under each other, with a legend. css: in place of its own."""
    groups, solvers = by_measure(rows), solvers_of(rows)
    key, key_height = legend(solvers)
    tall = HEIGHT * len(groups) + key_height
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {tall}" width="{WIDTH}" height="{tall}" '
        f'class="chart" font-family="system-ui,sans-serif"><style>{css or style(".chart")}</style>'
        f'<rect class="paper" width="{WIDTH}" height="{tall}"/>'
    ]
    for number_, group in enumerate(groups):
        parts.append(f'<g transform="translate(0 {number_ * HEIGHT})">{panel(group, solvers)}</g>')
    parts.append(f'<g transform="translate({LEFT} {tall - key_height})">{key}</g></svg>\n')
    return "".join(parts)


def inline(group: Group, solvers: Sequence[str], price: Price = milliseconds, axis: str = "ms") -> str:
    """A panel as it stands in a page that has the style."""
    return (
        f'<svg class="chart {axis}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="{html.escape(group.title)}">{panel(group, solvers, price, axis)}</svg>'
    )


def panel(group: Group, solvers: Sequence[str], price: Price = milliseconds, axis: str = "ms") -> str:
    """The inside of one diagram."""
    rows = [row for row in drawable(group.rows) if price(row)]
    title = f'<text class="title" x="{LEFT}" y="18">{html.escape(group.scene)}</text>' + (
        f'<text class="says" x="{LEFT}" y="34">{html.escape(group.says)}</text>'
    )
    if not rows:
        return f'{title}<text class="says" x="{LEFT}" y="80">nothing to draw: no run came to an end</text>'
    axes = axes_of(rows, price)
    best = {id(row) for row in front(rows, price)}
    bold = main_series(group.rows)
    lines = "".join(
        _line(line, solvers, axes, price, best, name in bold)
        for name, line in sorted(by_series(rows).items(), key=lambda item: item[0] in bold)
    )
    return title + _grid(axes, axis, group) + lines


def axes_of(rows: Sequence[Row], price: Price) -> Axes:
    """Room for all points; at least two octaves of price, so that noise does not look like news."""
    prices = [float(price(row) or 1.0) for row in rows]
    errors = [height(row) for row in rows]
    errors += [max(row.predicted, LEAST) for row in rows if row.predicted is not None]
    low, high = min(prices), max(prices)
    if high < SPAN * low:
        middle = math.sqrt(low * high)
        low, high = middle / math.sqrt(SPAN), middle * math.sqrt(SPAN)
    bottom, top = math.log10(min(errors)), math.log10(max(errors))
    if top - bottom < 1.0:
        bottom, top = bottom - 0.5, top + 0.5
    return Axes((math.log10(low) - 0.06, math.log10(high) + 0.1), (bottom - 0.12, top + 0.12))


def _grid(axes: Axes, axis: str, group: Group) -> str:
    parts = []
    right, base = WIDTH - RIGHT, HEIGHT - BOTTOM
    for power in range(math.ceil(axes.y[0]), math.floor(axes.y[1]) + 1):
        _, y = axes.place(1.0, 10.0**power)
        parts.append(f'<path class="grid" d="M{LEFT} {y:.1f}H{right}"/>')
        parts.append(f'<text class="tick end" x="{LEFT - 6}" y="{y + 4:.1f}">1e{power}</text>')
    steps = (1, 2, 5) if axes.x[1] - axes.x[0] < 2.5 else (1,)
    for power in range(math.floor(axes.x[0]), math.ceil(axes.x[1]) + 1):
        for step in steps:
            value = step * 10.0**power
            if axes.x[0] <= math.log10(value) <= axes.x[1]:
                x, _ = axes.place(value, 1.0)
                parts.append(f'<path class="grid" d="M{x:.1f} {TOP}V{base}"/>')
                parts.append(f'<text class="tick mid" x="{x:.1f}" y="{base + 16}">{value:g}</text>')
    parts.append(f'<text class="tick end" x="{right}" y="{HEIGHT - 10}">{PRICES[axis]}</text>')
    unit = group.measure.rpartition(" ")[2]
    parts.append(f'<text class="tick" x="{LEFT}" y="{HEIGHT - 10}">error {html.escape(unit)}</text>')
    return "".join(parts)


def _line(line: Sequence[Row], solvers: Sequence[str], axes: Axes, price: Price, best: set[int], bold: bool) -> str:
    solver, kind = line[0].solver, kind_of(line[0].series)
    places = [(row, *axes.place(float(price(row) or 1.0), height(row))) for row in line]
    parts = [
        f'<g class="series{" main" if bold else ""}" data-solver="{html.escape(solver)}" '
        f'style="--line:{colour_of(solver, solvers)}">'
    ]
    if bold or kind == "fixed":
        known = [(*axes.place(float(price(row) or 1.0), row.predicted),) for row in line if row.predicted is not None]
        parts.append(_path(known, "floor"))
    parts.append(_path([(x, y) for _, x, y in places], "line"))
    last = (-math.inf, -math.inf)
    for row, x, y in places:
        is_best = id(row) in best
        ring = f'<circle class="ring" cx="{x:.1f}" cy="{y:.1f}" r="7"/>' if is_best else ""
        label = ""
        if (bold or is_best) and math.dist((x, y), last) > CLOSE:
            label, last = f'<text class="label" x="{x + 6:.1f}" y="{y - 6:.1f}">{row.label}</text>', (x, y)
        parts.append(
            f'<g class="point{" best" if is_best else ""}">{ring}{marker(kind, x, y)}{label}'
            f"<title>{html.escape(told(row))}</title></g>"
        )
    return "".join(parts) + "</g>"


def marker(kind: str, x: float, y: float) -> str:
    """What a point looks like that is of a series which varies this."""
    if kind == "":
        return f'<circle class="dot" cx="{x:.1f}" cy="{y:.1f}" r="3.4"/>'
    corners = {
        "steps": "m-3 -3h6v6h-6z",
        "iterations": "m0 -4.2l4.2 4.2l-4.2 4.2l-4.2 -4.2z",
        "fixed": "m-3.8 -2.6h7.6l-3.8 6.4z",
        "double": "m-3.8 2.6h7.6l-3.8 -6.4z",
    }
    return f'<path class="dot" d="M{x:.1f} {y:.1f}{corners[kind]}"/>'


def _path(places: Sequence[tuple[float, float]], kind: str) -> str:
    if len(places) < 2:
        return ""
    return f'<path class="{kind}" d="M{"L".join(f"{x:.1f} {y:.1f}" for x, y in places)}"/>'


def told(row: Row) -> str:
    """Everything about a point, in lines."""
    predicted = "" if row.predicted is None else f"\npredicted {number(row.predicted)}"
    counted = "" if row.solves is None else f"\n{row.solves:,} constraints solved"
    return (
        f"{row.solver}: {row.setting}\nerror {number(row.error)} ({number(row.relative)} of the scale){predicted}"
        f"\n{row.cost_ms:.3g} ms, from least to greatest {row.spread_ms:.2g}{counted}"
    )


def legend(solvers: Sequence[str]) -> tuple[str, int]:
    """Which colour is whose and which marker stands for what, and how high that is [pixels]."""
    colours = [
        (f'<circle cx="4" cy="4" r="4.5" fill="{colour_of(name, solvers)}"/>', html.escape(name)) for name in solvers
    ]
    kinds = [(f'<g style="--line:var(--text)">{marker(kind, 4, 4)}</g>', name) for kind, name in VARIED.items()]
    marks = [
        ('<path class="floor" style="--line:var(--text)" d="M-4 4H10"/>', "predicted"),
        ('<circle class="ring" cx="4" cy="4" r="5"/>', "not beaten"),
    ]
    parts, x, y = [], 0.0, 0
    for place, (mark, name) in enumerate((*colours, *kinds, *marks)):
        width = 28 + 6.0 * len(name)
        if x + width > WIDTH - LEFT or place == len(colours):
            x, y = 0.0, y + 18
        parts.append(f'<g transform="translate({x:.0f} {y})">{mark}<text class="tick" x="14" y="8">{name}</text></g>')
        x += width
    return "".join(parts), y + 22
