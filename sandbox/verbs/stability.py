"""Try hard cases: what holds, what falls, and what that costs."""

from __future__ import annotations

import argparse
import json
from itertools import product

from rich.console import Console
from rich.progress import Progress

from engine import SOLVERS
from sandbox.compiling import compile_all
from sandbox.lab.accuracy.workers import WorkersError
from sandbox.lab.hard_cases import CASES
from sandbox.lab.stability import Row
from sandbox.lab.stability_baseline import not_shown, steps_back
from sandbox.lab.stability_ladder import PEERS
from sandbox.lab.stability_page import as_markdown
from sandbox.lab.stability_picture import draw
from sandbox.lab.stability_report import as_text
from sandbox.lab.stability_sweep import sweep, workers
from sandbox.signals import interruptible
from sandbox.verbs.common import BadInput, add_json, check_json, report, say, whole_number
from sandbox.verbs.laboratory import add_folder, check_folder, chosen_names, prepare_folder, write_file

NAME = "stability"
PAGE, FIGURES = "stability.md", "stability.json"
BUDGET = 540  # [s]
FELL = 1  # exit code: something that held when docs/stability.json was written fell, or there was no time to try it
FEW = 6  # are named, more are counted
WRITTEN = (PAGE, FIGURES, "stability.png", "stability.svg")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", nargs="*", help="names of cases; default: all. A wrong one is answered with the list")
    parser.add_argument(
        "--solvers", nargs="+", default=None, metavar="SOLVER", help=f"of {', '.join(SOLVERS)}; default: all of them"
    )
    parser.add_argument("--peers", action="store_true", help=f"other engines, too: {', '.join(PEERS)}")
    parser.add_argument("--defaults", action="store_true", help="with the defaults only, not the cheapest that holds")
    parser.add_argument(
        "--budget", type=whole_number(1, 86400), default=BUDGET, metavar="SECONDS",
        help=f"for all, compiling included: what is not done by then is left out; default: {BUDGET}",
    )  # fmt: skip
    parser.add_argument(
        "--jobs", type=whole_number(1, 64), default=workers(), metavar="N", help="processes; default: one a core"
    )
    add_folder(parser, f"write {PAGE}, {FIGURES} and the heat map as PNG and SVG into DIR")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    cases = chosen_names("case", options.case, CASES)
    solvers = chosen_names("solver", options.solvers or (), SOLVERS)
    if options.peers:
        refuse_missing()
        solvers = [*solvers, *PEERS]
    check_json(options)
    check_folder(options.output, WRITTEN)
    with interruptible():
        kernels, seconds = compile_all(say, ("single",))
        try:
            rows, untried = try_all(cases, solvers, options, options.budget - seconds)
        except WorkersError as error:
            raise BadInput(str(error)) from None
    back, gone = (
        steps_back(rows),
        not_shown(product(cases, solvers), rows),
    )  # before docs/stability.json is written anew
    if options.output is not None and rows:
        write_all(options, rows)
    report(options, [row.to_dict() for row in rows], as_text(rows) if rows else "")
    if untried:
        say(short_of_time(options.budget, untried, len(cases) * len(solvers), kernels, seconds))
    for row in back:
        say(f"{row.case} held with the defaults of {row.solver} when docs/stability.json was written, and fails now")
    if gone:
        say(f"{named(gone)} held when docs/stability.json was written, and there was no time to try again")
    if not rows and not gone:
        raise BadInput("nothing was tried")
    return FELL if back or gone else 0


def short_of_time(budget: int, untried: int, cells: int, kernels: int, seconds: float) -> str:
    """What was left out, what took the time, and what to do. kernels, seconds: of compiling and loading."""
    text = f"the {budget} s were not enough for {untried} of {cells} (--budget)"
    if kernels and untried == cells:
        text += f": all went into compiling {kernels} kernels"
    elif kernels:
        text += f", for compiling {kernels} kernels took {seconds:.0f} s of them"
    elif seconds >= budget:
        text += f": loading what is compiled alone took {seconds:.0f} s"
    again = "compiled code is kept, so run it once more, or give it" if kernels else "give it"
    return f"{text}; {again} a larger --budget"


def named(cells: list[tuple[str, str]]) -> str:
    """Each with its solver; many are counted besides."""
    shown = ", ".join(f"{case} with {solver}" for case, solver in cells[:FEW])
    return shown if len(cells) <= FEW else f"{len(cells)} cases and solvers, {shown} and others,"


def refuse_missing() -> None:
    """BadInput if another engine is not to be had."""
    from sandbox.lab.peers import PeerError, Pyb2d3, Pymunk

    for peer in (Pymunk, Pyb2d3):
        try:
            peer(1).close()
        except PeerError as error:
            raise BadInput(str(error)) from None


def try_all(cases: list[str], solvers: list[str], options: argparse.Namespace, seconds: float) -> tuple[list[Row], int]:
    """All rows, a case after the other, and how many cells there was no time for in so many seconds.

    The default solver goes first, then the other engines, then our other solvers.
    """
    turns = sorted(solvers, key=lambda name: (name != next(iter(SOLVERS)), name not in PEERS))
    cells = [(case, solver) for solver in turns for case in cases]
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("trying", total=len(cells))
        found = sweep(cells, seconds, lambda: progress.advance(task), defaults_only=options.defaults, jobs=options.jobs)
    rows = [row for case in cases for solver in solvers for row in found[case, solver]]
    return rows, sum(not rows_of_cell for rows_of_cell in found.values())


def write_all(options: argparse.Namespace, rows: list[Row]) -> None:
    """The page, its figures and the heat map, in a folder that is made if need be."""
    data = "[\n" + ",\n".join(json.dumps(row.to_dict()) for row in rows) + "\n]\n"
    prepare_folder(options.output)
    write_file(options.output / PAGE, lambda file: file.write_text(as_markdown(rows)))
    write_file(options.output / FIGURES, lambda file: file.write_text(data))
    write_file(options.output / PAGE, lambda file: draw(rows, file.parent))
