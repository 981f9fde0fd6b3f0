"""The page docs/stability.md: what holds and what falls, what it teaches, and why what falls does."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from engine import SOLVERS
from sandbox.lab.hard_cases import CASES, FAMILIES
from sandbox.lab.hard_cases.causes import CAUSES
from sandbox.lab.stability import Row, cheapest, claim
from sandbox.lab.stability_report import by_case, limits, number, share, solvers_in

PICTURE = "stability.png"
DEFAULT_SOLVER = next(iter(SOLVERS))
WIDTH = 116  # of the lines of text [characters]


def as_markdown(rows: Sequence[Row]) -> str:
    """The page docs/stability.md."""
    return "\n".join([*heading(), *summary(rows), *lessons(rows), *fallen(rows), *all_cases(rows)]) + "\n"


def heading() -> list[str]:
    """What was done, and the picture."""
    paragraphs = (
        f"""Made by `tumble stability --peers -o docs`; not edited by hand. {len(CASES)} hard cases, each a scene with
        criteria from physics: how far springs give way by statics, give or take a fifth, how fast a fall can
        make, where a ball fits into a wedge, how far what falls, slides or turns must have come
        (`sandbox/lab/hard_cases/`, `sandbox/lab/sag.py`, `sandbox/lab/structure.py`). A limit that follows from
        the solver's stiffness differs with its settings; a solver without springs may keep in each contact the
        overlap that is left alone, 1 cm, and in each joint what the springs of the default would
        give.""",
        """Each case runs with each solver's defaults, sleeping off unless it is about that. If it holds, cheaper
        settings are tried until one fails; if not, dearer ones until one holds. A cell is the cheapest that holds,
        with its CPU time of a simulated second; "not applicable" is what a solver lacks. pyb2d3 is Box2D 3.1 with
        its own defaults (4 substeps, 30 Hz, continuous collision); pymunk is Chipmunk with its own 10 iterations,
        told to leave 1 cm of overlap alone instead of 10.""",
        f"![heat map of the cases and solvers]({PICTURE})",
    )
    lines = ["# What holds, and what falls", ""]
    for paragraph in paragraphs:
        lines += [*textwrap.wrap(flowing(paragraph), WIDTH, break_on_hyphens=False), ""]
    return lines


def summary(rows: Sequence[Row]) -> list[str]:
    """How many hold with each solver's defaults, and with any setting that was tried."""
    titles = (
        "defaults of",
        "hold",
        "of those it can have",
        "",
        "hold with some setting",
        "median CPU ms a simulated second",
    )
    lines = [f"| {' | '.join(titles)} |", "|---|---:|---:|---:|---:|---:|"]
    for name in solvers_in(rows):
        held, tried, _ = share(rows, name)
        best = [cheapest(cells.get(name, [])) for cells in by_case(rows).values()]
        ms = sorted(row.ms for row in rows if row.default and row.passed and row.solver == name)
        percent = f"{100.0 * held / tried:.0f} %" if tried else "-"
        middle = f"{ms[len(ms) // 2]:.3g}" if ms else "-"
        lines.append(f"| {name} | {held} | {tried} | {percent} | {sum(row is not None for row in best)} | {middle} |")
    return [*lines, ""]


def lessons(rows: Sequence[Row]) -> list[str]:
    """What the figures teach."""
    own = {row.case: row for row in rows if row.solver == DEFAULT_SOLVER and row.default and row.passed is not None}

    def value(case: str) -> str:
        return number(own[case].value) if case in own else "-"

    held, tried, _ = share(rows, DEFAULT_SOLVER)
    best = {case: cheapest(cells.get(DEFAULT_SOLVER, [])) for case, cells in by_case(rows).items()}
    cheaper = [case for case, row in best.items() if row is not None and not row.default and own[case].passed]
    points = (
        f"""{held} of {tried} hold with {DEFAULT_SOLVER} as it is, {len(cheaper)} of them with fewer substeps as well:
        there, four buy accuracy, for the limits shrink with the stiffness, but no stability.""",
        """What keeps a tower standing is that contacts are kept. stack_20 and higher fall in Box2D 3.1 as they fall
        here with `recycling=False`: a tower of soft contacts buckles above 14 boxes (Greenhill;
        [soft_step.md](soft_step.md)).""",
        f"""Springs say how deep things sink: stacks of 10, 20, 40 and 80 by {value("stack_10")}, {value("stack_20")},
        {value("stack_40")} and {value("stack_80")} m, four times as much for twice the height. Where that is half a
        box, as in mass_ratio_1000, a box is lost.""",
        f"""Chains that are solved at once cost little and open least: chain_end_1000 by {value("chain_end_1000")} m,
        where joints visited one by one would give way by 0.14 m.""",
        """Far from the origin nothing changes, to 10,000 km: positions are doubles, and the solver works with
        differences.""",
        "Steps of 1/20 s hold a stack as well: contacts get softer with the step, never unstable.",
    )
    return ["## What it teaches", "", *(line for point in points for line in item(point)), ""]


def flowing(text: str) -> str:
    """Without the breaks that it has here."""
    return " ".join(text.split())


def item(text: str) -> list[str]:
    """A point of a list."""
    return textwrap.wrap(flowing(text), WIDTH, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False)


def fallen(rows: Sequence[Row]) -> list[str]:
    """Each failure of the default solver's defaults, with its cause."""
    lines = [f"## What falls with the defaults of {DEFAULT_SOLVER}", ""]
    failed = [row for row in rows if row.solver == DEFAULT_SOLVER and row.default and row.passed is False]
    for row in failed:
        best = cheapest([other for other in rows if (other.case, other.solver) == (row.case, row.solver)])
        cure = f"Holds with {best.label}." if best is not None else "Holds with none of the settings tried."
        cause = CAUSES.get(row.case, "No cause is known yet.")
        lines += item(f"**{row.case}**: {row.claim}: {number(row.value)}, limit {limits(row)}. {cause} {cure}")
    return [*lines, ""] if failed else [*lines, "Nothing.", ""]


def all_cases(rows: Sequence[Row]) -> list[str]:
    """A table a family: every cell, and what a case is."""
    names = solvers_in(rows)
    found = by_case(rows)
    lines = ["## All cases", ""]
    for family, cases in FAMILIES.items():
        own = [case for case in cases if case in found]
        if not own:
            continue
        lines += [f"### {family}", "", f"| case | {' | '.join(names)} |", f"|---|{'---|' * len(names)}"]
        for case in own:
            cells = (cell_markdown(found[case].get(name, [])) for name in names)
            lines.append(f"| {case} | {' | '.join(cells)} |")
        lines.append("")
        for case in own:
            lines += item(f"{case}: {CASES[case].scene.summary} {claims(case)}")
        lines.append("")
    return lines[:-1]


def claims(case: str) -> str:
    """What is measured of it."""
    return f"Measured: {'; '.join(claim(criterion) for criterion in CASES[case].criteria)}."


def cell_markdown(rows: Sequence[Row]) -> str:
    """As `cell_text`; a default that fails where another setting holds is told."""
    if not rows:
        return "-"
    if rows[0].passed is None:
        return "not applicable"
    best = cheapest(rows)
    if best is None:
        return "**fails**"
    label = "" if best.default else f"{best.label}: "
    return f"{label}{best.ms:.3g} ms" + ("" if rows[0].passed else "; default **fails**")
