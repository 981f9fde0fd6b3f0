"""The stability rows as a table for a terminal: a line a case, a column a solver."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rich.table import Table

from engine import SOLVERS
from sandbox.lab.stability import Row, cheapest
from sandbox.lab.tables import rendered


def as_text(rows: Sequence[Row]) -> str:
    """A line a case, a column a solver; then every default that fails, and how many hold."""
    table = Table(box=None, pad_edge=False)
    table.add_column("", no_wrap=True)
    names = solvers_in(rows)
    for name in names:
        table.add_column(name, no_wrap=True)
    for case, cells in by_case(rows).items():
        table.add_row(case, *(cell_text(cells.get(name, [])) for name in names))
    parts = [rendered(table), failures(rows), *shares(rows)]
    return "\n".join(part for part in parts if part)


def cell_text(rows: Sequence[Row]) -> str:
    """The cheapest setting that holds and its time: "4.1 ms", "fails", "substeps 8: 9.2 ms"."""
    if not rows:
        return "-"
    if rows[0].passed is None:
        return "[dim]not applicable[/]"
    best = cheapest(rows)
    if best is None:
        return "[red]fails[/]"
    text = f"{best.ms:.3g} ms" if best.default else f"{best.label}: {best.ms:.3g} ms"
    return text if rows[0].passed else f"[yellow]{text}[/]"


def failures(rows: Sequence[Row]) -> str:
    """A line for each default of ours that fails."""
    lines = []
    for row in rows:
        if row.default and row.passed is False and row.solver in SOLVERS:
            lines.append(f"{row.case}, {row.solver}: {row.claim}: {number(row.value)}, limit {limits(row)}")
    return "\n".join(lines)


def shares(rows: Sequence[Row]) -> list[str]:
    """How many cases hold with each solver's defaults."""
    lines = []
    for name in solvers_in(rows):
        held, tried, every = share(rows, name)
        percent = f"{100.0 * held / tried:.0f} %" if tried else "none"
        lines.append(f"With the defaults of {name}: {held} of {tried} hold, {percent}; {every - tried} not applicable.")
    return lines


def share(rows: Sequence[Row], solver: str) -> tuple[int, int, int]:
    """(cases that hold with its defaults, cases that it can have, all that were asked of it)."""
    defaults = [row for row in rows if row.default and row.solver == solver]
    can = [row for row in defaults if row.passed is not None]
    return sum(bool(row.passed) for row in can), len(can), len(defaults)


def solvers_in(rows: Sequence[Row]) -> list[str]:
    """In the order in which they were tried."""
    return list(dict.fromkeys(row.solver for row in rows))


def by_case(rows: Sequence[Row]) -> Mapping[str, Mapping[str, list[Row]]]:
    """Rows of the same case and solver."""
    groups: dict[str, dict[str, list[Row]]] = {}
    for row in rows:
        groups.setdefault(row.case, {}).setdefault(row.solver, []).append(row)
    return groups


def limits(row: Row) -> str:
    """Such as "0.0391", or "12.2 to 14.9"."""
    return " to ".join(number(limit) for limit in (row.at_least, row.at_most) if math.isfinite(limit))


def number(value: float) -> str:
    """To three digits."""
    return f"{value:.3g}" if math.isfinite(value) else "lost"
