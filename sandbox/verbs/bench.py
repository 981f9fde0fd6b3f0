"""Time the engine, alone or beside others."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import ExitStack, closing
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from engine import StepError
from sandbox.compiling import rehearse
from sandbox.lab.bench import BenchResult, bench
from sandbox.lab.bench_report import as_text
from sandbox.lab.peers import INSTALLABLE, Box2DLite, Peer, PeerError
from sandbox.lab.pyramids import BASES, pyramid
from sandbox.scenes import Scene
from sandbox.verbs.common import BadInput, add_json, report, say, scene_named, whole_number

NAME = "bench"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    bases = ", ".join(map(str, BASES))
    parser.add_argument("scene", nargs="*", help=f"default: pyramids of the talk with bases {bases}")
    parser.add_argument("--steps", type=whole_number(1, 1_000_000), default=600, metavar="N", help="default: 600")
    parser.add_argument("--peers", action="store_true", help="beside the engines of the extra tumble[peers]: pymunk")
    parser.add_argument(
        "--box2d-lite", type=Path, metavar="DIR", help="beside Box2D Lite, from a checkout in DIR; needs g++"
    )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    scenes = [scene_named(name) for name in options.scene] or [pyramid(base) for base in BASES]
    try:
        with ExitStack() as stack:
            peers = [stack.enter_context(closing(make())) for make in _peer_makers(options)]
            results = _bench_all(scenes, peers, options.steps)
    except (PeerError, StepError) as error:
        raise BadInput(str(error)) from None
    report(options, [result.to_dict() for result in results], as_text(results))
    return 0


def _peer_makers(options: argparse.Namespace) -> list[Callable[[], Peer]]:
    """How to get each engine that was asked for."""
    makers = list(INSTALLABLE) if options.peers else []
    if options.box2d_lite is not None:
        makers.append(partial(Box2DLite, options.box2d_lite))
    return makers


def _bench_all(scenes: list[Scene], peers: list[Peer], steps: int) -> list[BenchResult]:
    """One scene after the other, with a progress bar."""
    for scene in scenes:
        rehearse(scene, say)
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        results = []
        for scene in scenes:
            task = progress.add_task(scene.name, total=steps)
            results.append(bench(scene, peers, steps, partial(progress.advance, task), say))
        return results
