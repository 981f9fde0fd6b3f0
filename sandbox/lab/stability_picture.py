"""The heat map: cases times solvers, a cell the cheapest setting that holds, its colour the time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sandbox.lab.hard_cases import FAMILIES
from sandbox.lab.stability import Row, cheapest
from sandbox.lab.stability_report import by_case, share, solvers_in

# The page's colours (web/theme.py), restated: the laboratory does not import the page.
BACKDROP, TEXT = "#23262d", "#c4cad6"
FAILS, NOT_APPLICABLE, UNTRIED = "#a8444e", "#3d4450", "#23262d"
CHEAP, DEAR = "#2f6f63", "#d6b574"
DARK = "#16181d"
COLUMN, ROW, LEFT = 1.35, 0.2, 2.3  # inches


def draw(rows: Sequence[Row], folder: Path, name: str = "stability") -> None:
    """Writes the map as PNG and as SVG into the folder."""
    import matplotlib as mpl

    figure = figure_of(rows)
    with mpl.rc_context({"svg.hashsalt": name, "svg.fonttype": "path"}):
        figure.savefig(folder / f"{name}.png", facecolor=BACKDROP, dpi=110)
        figure.savefig(folder / f"{name}.svg", facecolor=BACKDROP, metadata={"Date": None})


def figure_of(rows: Sequence[Row]) -> Any:
    """The map, as matplotlib has it."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    found, names = by_case(rows), solvers_in(rows)
    lines = lines_of(found)
    width, height = LEFT + COLUMN * len(names) + 0.3, ROW * (len(lines) + 4) + 0.5
    figure = Figure((width, height), facecolor=BACKDROP)
    FigureCanvasAgg(figure)
    axis = figure.add_axes((LEFT / width, 0.35 / height, COLUMN * len(names) / width, 1.0 - (0.35 + 4 * ROW) / height))
    axis.set(xlim=(0, len(names)), ylim=(len(lines), 0), facecolor=BACKDROP)
    colour = scale_of(rows)
    for y, line in enumerate(lines):
        if line not in found:  # a family's name
            axis.text(-0.05, y + 0.62, line, ha="right", va="center", color=TEXT, fontsize=8.5, fontweight="bold")
            continue
        axis.text(-0.05, y + 0.5, line, ha="right", va="center", color=TEXT, fontsize=7.5)
        for x, name in enumerate(names):
            draw_cell(axis, x, y, found[line].get(name, []), colour)
    for x, name in enumerate(names):
        held, tried, _ = share(rows, name)
        axis.text(
            x + 0.5,
            -1.1,
            name.replace("sequential_", "sequential\n"),
            ha="center",
            va="center",
            color=TEXT,
            fontsize=8.5,
        )
        axis.text(x + 0.5, -0.2, f"{held} of {tried} by default", ha="center", va="center", color=TEXT, fontsize=7)
    axis.axis("off")
    note = "CPU time of a simulated second with the cheapest setting that holds; framed: the default fails; hatched: "
    note += "not applicable"
    figure.text(0.02, 0.12 / height, note, color=TEXT, fontsize=7)
    return figure


def lines_of(found: Any) -> list[str]:
    """Families' names and cases, from above downwards."""
    lines = []
    for family, cases in FAMILIES.items():
        own = [case for case in cases if case in found]
        lines += [family, *own] if own else []
    return lines


def scale_of(rows: Sequence[Row]) -> Any:
    """A colour for a time [ms], by its logarithm."""
    from matplotlib.colors import LinearSegmentedColormap, LogNorm

    times = [row.ms for row in rows if row.passed and row.ms > 0.0] or [1.0]
    norm = LogNorm(min(times), max(*times, 1.01 * min(times)))
    colours = LinearSegmentedColormap.from_list("cost", [CHEAP, "#7eb2a8", DEAR])
    return lambda ms: colours(norm(max(ms, min(times))))


def draw_cell(axis: Any, x: int, y: int, rows: Sequence[Row], colour: Any) -> None:
    """A case with a solver."""
    from matplotlib.patches import Rectangle

    best = cheapest(rows)
    look: dict[str, Any] = {"facecolor": UNTRIED, "edgecolor": BACKDROP, "linewidth": 1.0}
    text, ink = "", TEXT
    if rows and rows[0].passed is None:
        look |= {"facecolor": BACKDROP, "hatch": "////", "edgecolor": NOT_APPLICABLE}
    elif rows and best is None:
        look["facecolor"], text, ink = FAILS, "fails", "white"
    elif best is not None:
        look["facecolor"], ink = colour(best.ms), DARK
        text = f"{short(best)}{digits(best.ms)} ms"
    axis.add_patch(Rectangle((x + 0.02, y + 0.04), 0.96, 0.92, **look))
    if best is not None and not rows[0].passed:
        axis.add_patch(Rectangle((x + 0.035, y + 0.1), 0.93, 0.8, fill=False, edgecolor=FAILS, linewidth=2.0))
    axis.text(x + 0.5, y + 0.52, text, ha="center", va="center", color=ink, fontsize=6.8)


def short(row: Row) -> str:
    """Such as "8 sub: " for 8 substeps; nothing for the default."""
    return "" if row.default else f"{row.label.replace('substeps ', 'sub ').replace('iterations ', 'it ')}: "


def digits(ms: float) -> str:
    """To two digits."""
    return f"{ms:.0f}" if ms >= 10.0 else f"{ms:.{max(0, 1 - math.floor(math.log10(max(ms, 1e-3))))}f}"
