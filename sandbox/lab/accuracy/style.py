"""How diagrams look: the page's colours, in the dark and in the light."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from engine import SOLVERS
from sandbox.lab.accuracy.rows import Row

# The page's colours (web/theme.py), restated: the laboratory does not import the page. A test compares them.
BACKDROP = "#23262d"
LINES = ("#6e9ec7", "#d6b574", "#7eb2a8", "#cd7d86", "#a888bc", "#9db47c", "#d89270", "#8390cc")
TEXT = "#9aa4b5"
GRID = "#2b313c"

DARK = {"paper": BACKDROP, "text": TEXT, "strong": "#e4e8ef", "grid": "#353c49", "card": "#2a2e37"}
LIGHT = {"paper": "#ffffff", "text": "#5b6575", "strong": "#1d232d", "grid": "#e4e8ee", "card": "#f6f7f9"}
MARKERS = {
    "": "o",
    "steps": "s",
    "iterations": "D",
    "fixed": "v",
    "double": "^",
}  # of what is varied, as matplotlib has them
VARIED = {
    "": "substeps",
    "steps": "time step",
    "iterations": "iterations",
    "fixed": "fixed stiffness",
    "double": "double",
}
SPAN = 4.0  # of an axis of prices, at least
CLOSE = 16.0  # of points whose labels would lie on each other [pixels]


def colour_of(solver: str, solvers: Sequence[str]) -> str:
    """A solver keeps its colour whichever others are shown; peers come after ours."""
    known = [*SOLVERS, *(name for name in solvers if name not in SOLVERS)]
    return LINES[known.index(solver) % len(LINES)]


def kind_of(series: str) -> str:
    """What a series varies, "" for the first of its solver's."""
    varied = series.partition(", ")[2]
    if "double" in varied or "fixed" in varied:
        return "double" if "double" in varied else "fixed"
    return next((word for word in ("iterations", "steps") if varied.startswith(word)), "")


def main_series(rows: Iterable[Row]) -> set[str]:
    """The line of each solver that is drawn boldly: its first."""
    first: dict[str, str] = {}
    for row in rows:
        first.setdefault(row.solver, row.series)
    return set(first.values())


def variables(colours: dict[str, str]) -> str:
    return ";".join(f"--{name}:{value}" for name, value in colours.items())


def style(scope: str) -> str:
    """CSS of diagrams, in the light and in the dark."""
    dark = f"@media(prefers-color-scheme:dark){{{scope}{{{variables(DARK)}}}}}"
    return f"{scope}{{{variables(LIGHT)}}}{dark}{CHART}"


def dark_style(scope: str) -> str:
    """The same for a page that is always dark."""
    return f"{scope}{{{variables(DARK)}}}{CHART}"


CHART = (
    ".paper{fill:var(--paper)}"
    ".chart text{fill:var(--text);font-size:11px}.chart .title{fill:var(--strong);font-size:14px;font-weight:600}"
    ".chart .says{font-size:12px}.chart .end{text-anchor:end}.chart .mid{text-anchor:middle}"
    ".chart .grid{stroke:var(--grid);stroke-width:1;fill:none}"
    ".chart .line{stroke:var(--line);stroke-width:.8;fill:none;opacity:.5}"
    ".chart .main .line{stroke-width:2;opacity:.95}"
    ".chart .floor{stroke:var(--line);stroke-width:1.1;stroke-dasharray:5 4;fill:none;opacity:.6}"
    ".chart .dot{fill:var(--line);opacity:.65}.chart .main .dot,.chart .best .dot{opacity:1}"
    ".chart .ring{fill:none;stroke:var(--strong);stroke-width:1.1}"
    ".chart .point .label{fill:var(--line);font-size:10px}.chart .point{cursor:default}"
    ".chart .point:hover .dot{stroke:var(--strong);stroke-width:2.5}"
)
