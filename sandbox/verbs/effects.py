"""List the effects that a scene calls for, and what each costs."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from engine import StepError
from sandbox.compiling import announced
from sandbox.lab.ablation import ablations, compare_all, everything_idle, step_time
from sandbox.lab.compile_costs import CompileError, compile_costs
from sandbox.lab.effects_report import Report, as_markdown, as_text, make_rows
from sandbox.scenes import Scene
from sandbox.simulation import TIME_STEP
from sandbox.verbs.common import BadInput, add_json, report, say, scene_named

NAME = "effects"
DEFAULT_SCENE = "The Talk/Pyramid"
SETTLED = 60  # steps until the scene is under way


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", nargs="*", help=f"default: {DEFAULT_SCENE}; several with --markdown")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables as a page of the documents")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    scenes = [scene_named(name) for name in options.scene] or [scene_named(DEFAULT_SCENE)]
    if len(scenes) > 1 and not options.markdown:
        raise BadInput("several scenes: only with --markdown")
    if len(scenes) > 1 and options.json:
        raise BadInput("--json: of one scene only")
    if options.markdown is not None and not options.markdown.parent.is_dir():  # before a minute of measuring is lost
        raise BadInput(f"--markdown {options.markdown}: its folder does not exist")
    try:
        with announced(say):
            reports = [examine(scene) for scene in scenes]
    except (StepError, CompileError) as error:
        raise BadInput(str(error)) from None
    if options.markdown is not None:
        write_page(options.markdown, as_markdown(reports))
    report(options, [row.to_dict() for row in reports[0].rows], "\n\n".join(as_text(one) for one in reports))
    return 0


def write_page(file: Path, text: str) -> None:
    """Writes the page."""
    try:
        file.write_text(text)
    except OSError as error:
        raise BadInput(f"--markdown {file}: cannot be written: {error.strerror}") from None


FOREVER = 1e6  # [s]


def examine(scene: Scene) -> Report:
    """Runs the scene for a second, and measures its effects from there on, while nothing falls asleep."""
    world = scene.make(sleep_time=FOREVER)
    for _ in range(SETTLED):
        world.step(TIME_STEP)
    statuses, snapshot, idle = world.effects, world.snapshot(), everything_idle(world)
    say(f"{scene.name}: compiling the engine from nothing, in a process of its own, to see what each effect takes")
    compiling = compile_costs(snapshot)
    say(f"{scene.name}: stepping it with each effect and without it")
    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task(scene.name, total=1.0)
        wanted = [idle, *ablations(world)]
        costs = compare_all(snapshot, wanted, progress=lambda done: progress.update(task, completed=done))
    rows = make_rows(statuses, costs, compiling)
    return Report(scene.name, world.body_count, step_time(snapshot), costs[idle.name], rows)
