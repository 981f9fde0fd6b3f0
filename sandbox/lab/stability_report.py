"""The stability rows as tables: for a terminal, and as a page of the documents."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.table import Table

from sandbox.lab.stability import CASES, Row, Variant
from sandbox.lab.tables import rendered
from sandbox.scenes import find_scene
from sandbox.scenes.criterion import Criterion


def as_text(rows: Sequence[Row]) -> str:
    """A table a case, under what is measured; below it where a run missed another criterion than the first."""
    parts = []
    for case, own in by_case(rows).items():
        first = find_scene(CASES[case]).shows[0]
        others = [f"  {settings_of(row.variant)}: {claim(row.criterion)}" for row in own if row.criterion is not first]
        parts.append("\n".join([f"{case}: {claim(first)}", rendered(case_table(own)), *others]))
    return "\n\n".join([*parts, summary(rows)])


def case_table(rows: Sequence[Row]) -> Table:
    """A line a run."""
    table = Table(box=None, pad_edge=False)
    for title in ("", "", "value", "limit", "ms a simulated second"):
        table.add_column(title, no_wrap=True, justify="right" if title else "left")
    for row in rows:
        passed = "[green]holds[/]" if row.passed else "[red]fails[/]"
        table.add_row(settings_of(row.variant), passed, number(row.value), limits(row), f"{row.ms:.3g}")
    return table


def summary(rows: Sequence[Row]) -> str:
    """How many hold, and what does not of each solver's defaults."""
    lines = [f"{sum(row.passed for row in rows)} of {len(rows)} hold."]
    for solver in dict.fromkeys(row.solver for row in rows):
        failed = [row.case for row in rows if row.solver == solver and row.default and not row.passed]
        text = f"{', '.join(failed)} {'fails' if len(failed) == 1 else 'fail'}" if failed else "all hold"
        lines.append(f"With the defaults of {solver}: {text}.")
    return "\n".join(lines)


def as_markdown(rows: Sequence[Row]) -> str:
    """The page docs/stability.md."""
    lines = [
        "# What holds, and what falls",
        "",
        "Made by `tumble stability -o docs`; not edited by hand. Each case is a scene with criteria from physics, run",
        "with both solvers at their defaults and at a few other settings. A pile may sink as far as its contacts give",
        "way, by statics alone, and a fifth (`sandbox/lab/structure.py`, `sandbox/lab/sag.py`): its limit differs with",
        "the settings.",
        "",
        *summary(rows).split("\n"),
    ]
    for case, own in by_case(rows).items():
        scene = find_scene(CASES[case])
        lines += ["", f"## {case}", "", f"{scene.name}: {scene.summary}", f"Measured: {claim(scene.shows[0])}."]
        lines += ["", "| settings | | value | limit | CPU ms a simulated second |", "|---|---|---:|---:|---:|"]
        for row in own:
            other = "" if row.criterion is scene.shows[0] else f": {claim(row.criterion)}"
            verdict = "holds" if row.passed else f"**fails**{other}"
            cells = (settings_of(row.variant), verdict, number(row.value), limits(row), f"{row.ms:.3g}")
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def by_case(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Rows of the same case."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.case, []).append(row)
    return groups


def claim(criterion: Criterion) -> str:
    """What is measured, with its unit and when."""
    unit = f" [{criterion.unit}]" if criterion.unit else ""
    return f"{criterion.says.rstrip(' :,')}{unit}, {criterion.when}"


def limits(row: Row) -> str:
    """Such as "0.0391", or "12.2 to 14.9"."""
    finite = [limit for limit in (row.reading.at_least, row.reading.at_most) if math.isfinite(limit)]
    return " to ".join(map(number, finite))


def settings_of(variant: Variant) -> str:
    """Such as "soft_step" or "sequential_impulses, iterations 40"."""
    parts = [variant.solver]
    parts += [f"no {name}" if value is False else f"{name} {value}" for name, value in variant.settings]
    parts += [f"dt 1/{60 * variant.steps}"] * (variant.steps != 1)
    return ", ".join(parts)


def number(value: float) -> str:
    """To three digits."""
    return f"{value:.3g}" if math.isfinite(value) else "lost"
