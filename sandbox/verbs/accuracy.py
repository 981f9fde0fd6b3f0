"""Show what accuracy costs: errors against exact answers, and CPU time."""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from engine import SOLVERS
from sandbox.lab.accuracy import SECONDS, Outcome, all_series, sweep
from sandbox.lab.accuracy.peers import peer
from sandbox.lab.accuracy.report import PICTURES, as_markdown, as_text, picture_name, summary
from sandbox.lab.accuracy.running import Progress as Tell
from sandbox.lab.accuracy.workers import Cluster, Processes, Workers, WorkersError
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.lab.page import PageError, check_page, write_section
from sandbox.lab.peers import KNOBS, PeerError
from sandbox.signals import interruptible
from sandbox.verbs.common import BadInput, add_json, check_json, report, say
from sandbox.verbs.laboratory import add_folder, check_folder, chosen_names, prepare_folder, write_file

NAME = "accuracy"
PAGE = "accuracy.md"
HTML = "accuracy.html"
SECTION = "tumble accuracy"  # of the page
LONGEST = 1e6  # --budget [s]
LARGER = "give it a larger --budget"
TELLING = 20.0  # s between two lines on how far it is, where nobody watches a terminal


def budget(text: str) -> float:
    """An argparse type: a time limit [s]."""
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0.0 < seconds <= LONGEST:
        raise argparse.ArgumentTypeError(f"{text[:80]!r}: must be seconds above 0, at most {LONGEST:g}")
    return seconds


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", nargs="*", help=f"of {', '.join(EXPERIMENTS)}; default: all")
    parser.add_argument(
        "--solvers", nargs="+", action="extend", default=[], metavar="SOLVER",
        help=f"of {', '.join(SOLVERS)}; default: all",
    )  # fmt: skip
    parser.add_argument(
        "--budget", type=budget, default=SECONDS, metavar="SECONDS",
        help=f"time limit: coarse settings are run first, then finer ones; default: {SECONDS:g}",
    )  # fmt: skip
    parser.add_argument("--peers", action="store_true", help=f"measure {' and '.join(KNOBS)} too (the extra `peers`)")
    parser.add_argument(
        "--dask", metavar="ADDRESS", help="run on a Dask cluster, at tcp://host:port (the extra `dask`)"
    )
    add_folder(parser, f"write {PAGE}, {HTML} and the work-precision diagrams into DIR")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    experiments = [EXPERIMENTS[name] for name in chosen_names("scene", options.scene, EXPERIMENTS)]
    solvers = chosen_names("solver", options.solvers, SOLVERS)
    series = all_series(solvers, _peers() if options.peers else ())
    _check_files(options, [experiment.name for experiment in experiments])
    with interruptible(), telling() as tell:
        workers = workers_for(options)
        if options.output is not None:
            prepare_folder(options.output / PICTURES)
        outcome = sweep(experiments, series, workers, seconds=options.budget, progress=tell)
    say(summary(outcome))
    if not outcome.rows:
        raise BadInput(f"nothing was measured: {_why_nothing(outcome, options.budget)}")
    if options.output is not None:
        _write(options.output, outcome)
    report(options, [row.to_dict() for row in outcome.rows], as_text(outcome))
    return 0


def _why_nothing(outcome: Outcome, budget: float) -> str:
    if outcome.failures:
        return outcome.failures[0]
    if outcome.left:
        return _where_time_went(outcome, budget)
    return next(iter(outcome.refused.values()), "there is nothing to measure")


def _where_time_went(outcome: Outcome, budget: float) -> str:
    """What took all of the budget, and what to do."""
    scenes = [scene for scene in outcome.unprepared if scene]
    if not scenes and (outcome.compiled or "" in outcome.unprepared):
        count = f" {outcome.compiled} kernels" if outcome.compiled else ""
        return (
            f"all of the {budget:g} s went into compiling{count}; compiled code is kept, so run it once more,"
            " or give it a larger --budget"
        )
    if scenes:
        return f"making what {scenes[0]} is compared with took all of the {budget:g} s; {LARGER}"
    return f"no run ended within {budget:g} s; {LARGER}"


def workers_for(options: argparse.Namespace) -> Workers:
    """Processes here, or a cluster's."""
    if options.dask is None:
        return Processes()
    try:
        return Cluster(options.dask)
    except WorkersError as error:
        raise BadInput(f"--dask {options.dask[:80]}: {error}") from None


def _peers() -> list[str]:
    try:
        return [name for name in KNOBS if peer(name)]
    except PeerError as error:
        raise BadInput(str(error)) from None


def _check_files(options: argparse.Namespace, scenes: list[str]) -> None:
    """Before minutes of measuring are lost."""
    check_json(options)
    folder: Path | None = options.output
    pictures = [f"{PICTURES}/{picture_name(scene)}.{kind}" for scene in scenes for kind in ("svg", "png")]
    check_folder(folder, [PAGE, HTML, *pictures])
    if folder is None:
        return
    check_folder(folder / PICTURES, ())
    try:
        if folder.is_dir():
            check_page(folder / PAGE, SECTION)
    except PageError as error:
        raise BadInput(f"-o {error}") from None


def _write(folder: Path, outcome: Outcome) -> None:
    from sandbox.lab.accuracy.chart import as_svg
    from sandbox.lab.accuracy.html import as_html
    from sandbox.lab.accuracy.picture import draw

    for scene in dict.fromkeys(row.scene for row in outcome.rows):
        rows = [row for row in outcome.rows if row.scene == scene]
        file = folder / PICTURES / picture_name(scene)
        write_file(file.with_suffix(".svg"), partial(_write_text, as_svg(rows)))
        write_file(file.with_suffix(".png"), partial(draw, rows))
    write_file(folder / HTML, partial(_write_text, as_html(outcome)))
    try:
        write_section(folder / PAGE, SECTION, as_markdown(outcome))
    except PageError as error:
        raise BadInput(f"-o {error}") from None


def _write_text(text: str, file: Path) -> None:
    file.write_text(text, encoding="utf-8")


@contextmanager
def telling() -> Iterator[Tell]:
    """Shows how far it is: a bar in a terminal, else a line now and then."""
    console = Console(stderr=True)
    last = time.monotonic()
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("starting", total=None)

        def tell(done: int, total: int, what: str) -> None:
            nonlocal last
            progress.update(task, completed=done, total=total or None, description=what)
            if not console.is_terminal and time.monotonic() - last > TELLING:
                last = time.monotonic()
                say(f"{what}: {done} of {total} settings")

        yield tell
