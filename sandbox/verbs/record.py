"""Record a scene to an .rrd file, without a window."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from rich.console import Console
from rich.progress import track

from engine import StepError
from sandbox.compiling import rehearse
from sandbox.recorder import PartFile
from sandbox.signals import Stop, interruptible, stop_requested
from sandbox.simulation import TIME_STEP, Simulation
from sandbox.verbs.common import (
    BadInput,
    add_json,
    add_settings,
    add_threads,
    chosen_settings,
    made,
    report,
    say,
    scene_named,
    time_step,
    whole_number,
)
from sandbox.verbs.run import open_recorder

NAME = "record"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.rrd")
    parser.add_argument("--steps", type=whole_number(1, 10_000_000), default=600, metavar="N", help="default: 600")
    parser.add_argument("--dt", type=time_step, default=TIME_STEP, metavar="SECONDS", help="default: 1/60")
    add_settings(parser)
    add_threads(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from recordings import RecordingError

    settings = chosen_settings(options)
    scene = scene_named(options.scene)
    made(scene, settings)
    simulation = Simulation(scene, options.dt, threads=options.threads, **settings)
    if not options.output.parent.is_dir():
        raise BadInput(f"{options.output}: its folder does not exist")
    if options.output.exists() and not options.output.is_file():  # a folder, a device: nothing to put a file over
        raise BadInput(f"{options.output}: is no file that could be written anew")
    with interruptible():
        rehearse(simulation.scene, say, threads=options.threads, **settings)
    with stop_requested() as stop:
        started = time.perf_counter()
        try:
            file = PartFile(options.output, open_recorder, simulation)
            failure = _record(simulation, file, options.steps, stop)
            if failure or stop.requested:
                file.abandon()
                raise BadInput(f"{failure or 'interrupted'}; what was recorded is in {file.part}")
            file.finish()
        except (RecordingError, OSError) as error:
            raise BadInput(f"{options.output}: {error}") from None
    seconds = time.perf_counter() - started
    data = {
        "scene": simulation.scene.name,
        "file": str(options.output),
        "steps": options.steps,
        "simulated_seconds": simulation.world.time,
        "seconds": seconds,
        "bytes": options.output.stat().st_size,
        "state_hash": simulation.world.state_hash(),
    }
    megabytes = data["bytes"] / 1e6
    report(options, data, f"{options.output}: {options.steps} steps, {megabytes:.1f} MB, {seconds:.1f} s")
    return 0


def _record(simulation: Simulation, file: PartFile, steps: int, stop: Stop) -> str:
    """Steps and writes; why it ended early, or nothing."""
    console = Console(stderr=True)
    label = f"recording {simulation.scene.name}"
    for _ in track(range(steps), label, console=console, disable=not console.is_terminal, transient=True):
        if stop.requested:
            return ""
        try:
            simulation.step()
        except StepError as error:
            return str(error)
        file.show(simulation.frame())
    return ""
