"""Time the engine, alone or beside others."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Callable
from contextlib import ExitStack, closing
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.progress import Progress, TaskID

from engine import StepError, validate
from engine.threads import MOST as MOST_THREADS
from sandbox.compiling import announced
from sandbox.lab.bench import Plan, bench
from sandbox.lab.bench_claims import as_text as claims_as_text
from sandbox.lab.bench_claims import claims
from sandbox.lab.bench_report import as_markdown, as_text
from sandbox.lab.bench_result import BenchResult
from sandbox.lab.bench_scenes import FEWEST_STEPS, FOLDER, MOST_STEPS, default_scenes, settling_time
from sandbox.lab.page import PageError, check_page, write_section
from sandbox.lab.peers import INSTALLABLE, Box2DLite, Peer, PeerError
from sandbox.scenes import Scene
from sandbox.verbs.common import BadInput, add_json, check_json, made, report, say, scene_named, whole_number

NAME = "bench"
LONGEST = 3600.0  # to settle [s]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", nargs="*", help=f"default: all of {FOLDER}; with --box2d-lite the talk's pyramids of four sizes"
    )
    parser.add_argument(
        "--threads", type=whole_number(1, MOST_THREADS), default=1, metavar="N", help="of every engine; default: 1"
    )
    parser.add_argument(
        "--steps",
        type=whole_number(1, 1_000_000),
        metavar="N",
        help=f"to time; default: {MOST_STEPS}, of large scenes fewer, at least {FEWEST_STEPS}",
    )
    parser.add_argument(
        "--after", type=seconds, metavar="SECONDS", help="let scenes settle for so long first; default: the scene's own"
    )
    parser.add_argument(
        "--peers", action="store_true", help="beside the engines of the extra tumble[peers]: pyb2d3 and pymunk"
    )
    parser.add_argument(
        "--box2d-lite", type=Path, metavar="DIR", help="beside Box2D Lite, from a checkout in DIR; needs g++"
    )
    parser.add_argument(
        "--markdown", type=Path, metavar="FILE", help="write the tables into a page of the documents, where it asks"
    )
    parser.add_argument(
        "--claims", action="store_true", help="instead: what 10,000 boxes asleep cost, and chains solved at once"
    )
    add_json(parser)


def seconds(text: str) -> float:
    """Simulated time."""
    try:
        return validate.between("after", float(text), 0.0, LONGEST)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: must be seconds from 0 to {LONGEST:g}") from None


def run(options: argparse.Namespace) -> int:
    if options.claims:
        with announced(say):
            found = claims()
        report(options, found, claims_as_text(found))
        return 0
    scenes = [scene_named(name) for name in options.scene] or default_scenes(talk=options.box2d_lite is not None)
    _check_files(options)
    try:
        with ExitStack() as stack:
            peers = [stack.enter_context(closing(make())) for make in _peer_makers(options)]
            results = _bench_all([_plan(scene, options) for scene in scenes], peers)
        if options.markdown is not None:
            write_section(options.markdown, NAME, as_markdown(results, _command(options)))
    except (PeerError, PageError) as error:
        raise BadInput(str(error)) from None
    report(options, [result.to_dict() for result in results], as_text(results))
    return 0


def _plan(scene: Scene, options: argparse.Namespace) -> Plan:
    after = settling_time(scene.name) if options.after is None else options.after
    return Plan(scene, after, options.steps, options.threads)


def _check_files(options: argparse.Namespace) -> None:
    """Before minutes of measuring are lost."""
    check_json(options)
    if options.markdown is not None:
        try:
            check_page(options.markdown, NAME)
        except PageError as error:
            raise BadInput(f"--markdown {error}") from None


def _peer_makers(options: argparse.Namespace) -> list[Callable[[], Peer]]:
    """How to get each engine that was asked for."""
    makers: list[Callable[[], Peer]] = [partial(make, options.threads) for make in INSTALLABLE] if options.peers else []
    if options.box2d_lite is not None:
        makers.append(partial(Box2DLite, options.box2d_lite))
    return makers


def _bench_all(plans: list[Plan], peers: list[Peer]) -> list[BenchResult]:
    """One scene after the other, with a progress bar."""
    console = Console(stderr=True)
    with (
        announced(say),
        Progress(console=console, disable=not console.is_terminal, transient=True) as progress,
    ):
        results = []
        for plan in plans:
            world = made(plan.scene, {"threads": plan.threads} if plan.threads > 1 else {})
            task = progress.add_task(plan.scene.name, total=None)
            try:
                results.append(bench(world, plan, peers, partial(_show, progress, task), say))
            except (PeerError, StepError) as error:
                raise BadInput(f"{plan.scene.name}: {error}") from None
            progress.remove_task(task)
        return results


def _show(progress: Progress, task: TaskID, done: int, total: int) -> None:
    progress.update(task, completed=done, total=total)


def _command(options: argparse.Namespace) -> str:
    """The command line that these results come from, as far as it matters."""
    words = ["tumble", NAME, *options.scene]
    for name in ("threads", "steps", "after"):
        value = getattr(options, name)
        if value is not None and not (name == "threads" and value == 1):
            words += [f"--{name}", f"{value:g}" if name == "after" else str(value)]
    if options.peers:
        words.append("--peers")
    if options.box2d_lite is not None:
        words += ["--box2d-lite", "DIR"]
    return shlex.join([*words, "--markdown", str(options.markdown)])
