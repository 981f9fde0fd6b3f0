"""What a sweep found, in words and tables: for a terminal, and as a page of the documents."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

from rich.table import Table
from rich.text import Text

from engine import SOLVERS
from sandbox.lab.accuracy.groups import Group, by_measure, by_series, number, solvers_of
from sandbox.lab.accuracy.pareto import TARGETS, cheapest, front
from sandbox.lab.accuracy.rows import Row
from sandbox.lab.accuracy.running import Outcome
from sandbox.lab.accuracy.series import missing
from sandbox.lab.accuracy.tasks import REPEATS
from sandbox.lab.experiments import COPIES
from sandbox.lab.tables import rendered

PICTURES = "accuracy"  # the folder of them
NONE = "-"
WIDTH = 116  # of the page's lines of text [characters]
FEW = 8  # scenes are named, more are counted
LEVELS = ("coarse", "finer", "double precision and fixed stiffness")


def as_text(outcome: Outcome) -> str:
    """The cheapest settings for every measure, then what is not applicable and what was left out."""
    parts = [rendered(cheapest_table(by_measure(outcome.rows)))]
    return "\n\n".join([*parts, *("\n".join(lines) for lines in (not_applicable(outcome), left_out(outcome)) if lines)])


def cheapest_table(groups: Sequence[Group]) -> Table:
    """A line a measure, and one for the peers: the cheapest that reaches each part of its scale, and its cost."""
    table = Table(
        box=None, pad_edge=False, title="the cheapest that comes within ... of the scale", title_justify="left"
    )
    table.add_column("scene, measure")
    for target in TARGETS:
        table.add_column(f"{target:.0e}")
    for group in groups:
        for name, cells in cheapest_cells(group, "\n"):
            table.add_row(Text(f"{group.scene}\n  {group.measure}{name}"), *map(Text, cells))
    return table


def cheapest_cells(group: Group, between: str) -> list[tuple[str, list[str]]]:
    """The cheapest of ours that come within each target, and of the peers where there are any."""
    ours = [row for row in group.rows if row.solver in SOLVERS]
    theirs = [row for row in group.rows if row.solver not in SOLVERS]
    return [
        (name, [_cell(cheapest(rows, target), between) for target in TARGETS])
        for name, rows in (("", ours), (", peers", theirs))
        if rows
    ]


def _cell(row: Row | None, between: str) -> str:
    if row is None:
        return NONE
    return f"{row.solver}{between}{row.setting}{between}{row.cost_ms:.2g} ms"


def not_applicable(outcome: Outcome) -> list[str]:
    """What solvers lack, of settings and for experiments."""
    lines = []
    for solver in solvers_of(outcome.rows):
        if lacking := missing(solver):
            lines.append(f"not applicable: {solver} has no {', no '.join(lacking)}")
    by_reason: dict[tuple[str, str], list[str]] = {}
    for (scene, solver), reason in outcome.refused.items():
        by_reason.setdefault((solver, reason), []).append(scene)
    for (solver, reason), scenes in by_reason.items():
        lines.append(f"not applicable: {', '.join(scenes)} with {solver}: {reason}")
    return lines


def left_out(outcome: Outcome) -> list[str]:
    """What there was no time for, and what failed."""
    lines = []
    for level, name in enumerate(LEVELS):
        counts = {scene: count for (scene, of), count in outcome.left.items() if of == level and count}
        where = ", ".join(counts) if len(counts) <= FEW else f"{len(counts)} scenes"
        if counts:
            lines.append(f"left out for want of time: {sum(counts.values())} {name} settings of {where}")
    return [*lines, *(f"failed: {failure}" for failure in outcome.failures)]


# --- the page docs/accuracy.md ----------------------------------------------------------------------------------------


def as_markdown(outcome: Outcome) -> str:
    """What `tumble accuracy -o` writes into the page: the tables and the diagrams."""
    groups = by_measure(outcome.rows)
    parts = [
        f"Measured by `tumble accuracy`: {len(outcome.rows):,} errors of {len(groups)} measures. Times are medians of",
        f"{REPEATS} interleaved runs, of the process's own CPU time on a shared machine: compare them with each other.",
        f"Small scenes hold {COPIES} copies side by side, so that what is timed is the solver.",
        "",
        "### The cheapest setting that comes within a part of the scale",
        "",
        *cheapest_markdown(groups),
        "",
        "### What is not applicable",
        "",
        *(wrapped(f"- {line.removeprefix('not applicable: ')}", "  ") for line in not_applicable(outcome)),
    ]
    if lines := left_out(outcome):
        parts += ["", "### What is not in these tables", "", *(wrapped(f"- {line}", "  ") for line in lines)]
    for scene in dict.fromkeys(group.scene for group in groups):
        own = [group for group in groups if group.scene == scene]
        parts += ["", f"### {own[0].title.partition(';')[0]}", ""]
        parts += [f"![Error against CPU time]({PICTURES}/{picture_name(scene)}.svg)"]
        for group in own:
            parts += ["", *best_of(group)]
    return "\n".join(parts)


def picture_name(scene: str) -> str:
    """A file's name for it, without its ending."""
    return scene.replace(" ", "_")


def cheapest_markdown(groups: Iterable[Group]) -> list[str]:
    """A line a measure."""
    heads = " | ".join(f"{target:.0e}" for target in TARGETS)
    lines = [f"| scene, measure | {heads} | a part of |", f"|---|{'---|' * len(TARGETS)}---|"]
    for group in groups:
        for name, cells in cheapest_cells(group, "<br>"):
            lines.append(f"| {group.scene}<br>{group.measure}{name} | {' | '.join(cells)} | {group.against} |")
    return lines


def wrapped(text: str, indent: str = "") -> str:
    """A paragraph in lines that fit a window; all but the first are indented."""
    return textwrap.fill(text, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def best_of(group: Group) -> list[str]:
    """A measure's best of each solver: a line a solver."""
    lines = [
        wrapped(f"{group.says}: the best of each"),
        "",
        "| solver | setting | error | predicted | ms a second | solves |",
        "|---|---|---:|---:|---:|---:|",
    ]
    for solver in solvers_of(group.rows):
        own = front([row for row in group.rows if row.solver == solver])
        if not own:
            lines.append(f"| {solver} | | lost | | | |")
            continue
        row = own[-1]
        predicted = "" if row.predicted is None else number(row.predicted)
        solves = "" if row.solves is None else f"{row.solves:,}"
        cells = (solver, row.setting, number(row.error), predicted, f"{row.cost_ms:.2g}", solves)
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def summary(outcome: Outcome) -> str:
    """One line on how it went."""
    compiled = f", {outcome.compiled} kernels compiled" if outcome.compiled else ""
    points = len({(row.scene, row.series, row.label) for row in outcome.rows})
    lines = len(by_series(outcome.rows))
    ours = sum(solver in SOLVERS for solver in solvers_of(outcome.rows))
    return (
        f"{points} settings on {lines} lines of {ours} solvers measured in {outcome.seconds:.0f} s{compiled}"
    )  # fmt: skip
