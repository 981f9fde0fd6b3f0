"""The accuracy rows as tables: for a terminal, and as a page of the documents."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.table import Table

from sandbox.lab.accuracy import REPEATS, Row
from sandbox.lab.experiments import COPIES, EXPERIMENTS, Measure
from sandbox.lab.tables import rendered

PICTURE = "accuracy.png"


def as_text(rows: Sequence[Row]) -> str:
    """A table a measure, under its title."""
    return "\n\n".join(f"{title}\n{rendered(measure_table(group))}" for title, group in by_measure(rows))


def measure_table(rows: Sequence[Row]) -> Table:
    """A series a group of lines: its settings, their errors, those that are predicted, and what they cost."""
    lines = by_series(rows)
    width = max(len(line) for line in lines.values())
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    for _ in range(width):
        table.add_column(justify="right", no_wrap=True)
    for name, line in lines.items():
        table.add_row(name, *(f"{row.label}:" for row in line))
        table.add_row("  error", *(number(row.error) for row in line))
        if any(row.predicted is not None for row in line):
            table.add_row("  predicted", *("" if row.predicted is None else number(row.predicted) for row in line))
        table.add_row("  ms a simulated second", *(f"{row.cost_ms:.2g}" for row in line))
    return table


def as_markdown(rows: Sequence[Row]) -> str:
    """The page docs/accuracy.md."""
    parts = [
        "# What accuracy costs",
        "",
        "Made by `tumble accuracy -o docs`; not edited by hand. Five small scenes with an exact answer, each run with",
        "both solvers over their settings. Error against CPU time of a simulated second, both logarithmic; a line is a",
        "series of settings of which one changes, and its points are labelled with that. Dashed: the error that is",
        "predicted, from the integrator's order or from how far a soft constraint gives way.",
        "`sandbox/lab/experiments.py` has the scenes, `sandbox/lab/references.py` the closed forms.",
        "",
        f"![Error against CPU time, a panel a measure]({PICTURE})",
        "",
        f"Times are medians of {REPEATS} interleaved runs, on one core of a shared machine: compare them with each",
        f"other. Each world holds {COPIES} bodies side by side, so that what is timed is the solver.",
    ]
    for title, group in by_measure(rows):
        parts += ["", f"## {title}", "", *markdown_table(group)]
    return "\n".join(parts) + "\n"


def markdown_table(rows: Sequence[Row]) -> list[str]:
    """A line a setting."""
    lines = ["| series | setting | error | predicted | ms a second | solves |", "|---|---:|---:|---:|---:|---:|"]
    for row in rows:
        predicted = "" if row.predicted is None else number(row.predicted)
        cells = (row.series, row.label, number(row.error), predicted, f"{row.cost_ms:.2g}", f"{row.solves:,}")
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def by_measure(rows: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    """Rows of the same measure, under its title."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row.scene, row.measure), []).append(row)
    return [(title_of(*key), group) for key, group in groups.items()]


def by_series(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Rows of one measure by their series."""
    lines: dict[str, list[Row]] = {}
    for row in rows:
        lines.setdefault(row.series, []).append(row)
    return lines


def title_of(scene: str, measure: str) -> str:
    """Such as "ballistic: a ball thrown upwards: height after 2 s [m]"."""
    experiment = EXPERIMENTS[scene]
    return f"{scene}: {experiment.says}; {says(measure_of(scene, measure))}"


def measure_of(scene: str, measure: str) -> Measure:
    return next(one for one in EXPERIMENTS[scene].measures if one.name == measure)


def says(measure: Measure) -> str:
    """What it measures, with the unit that its name ends with."""
    return f"{measure.says} [{measure.name.rpartition('[')[2]}"


def number(value: float) -> str:
    """An error, to two digits."""
    return f"{value:.1e}" if math.isfinite(value) else "lost"
