"""Open the sandbox: a living scene in the browser."""

from __future__ import annotations

import argparse
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from sandbox.compiling import compiling_rest, rehearse
from sandbox.lab.ablation import measure
from sandbox.lab.compile_costs import compile_costs
from sandbox.recorder import RecordingStart
from sandbox.session import Session
from sandbox.signals import interruptible, stop_requested
from sandbox.simulation import TIME_STEP
from sandbox.verbs.common import (
    BadInput,
    add_address,
    add_settings,
    add_threads,
    chosen_settings,
    made,
    say,
    scene_named,
)
from sandbox.verbs.effects import SETTLED
from sandbox.viewer import Viewer

if TYPE_CHECKING:
    from web import Cost

NAME = "run"
DEFAULT_SCENE = "The Talk/Pyramid"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", nargs="?", default=DEFAULT_SCENE, help=f"default: {DEFAULT_SCENE}")
    add_address(parser)
    add_settings(parser)
    add_threads(parser)
    parser.add_argument("--record-dir", type=Path, default=Path("runs"), metavar="DIR", help="default: runs")


def open_recorder(path: Path, start: RecordingStart) -> Viewer:
    """Writes a recording; rerun is loaded when the first one begins."""
    from recordings import Writer

    return Writer(path, start)


def effect_costs(session: Session) -> Iterator[dict[str, Cost]]:
    """What each effect costs in the scene that runs, with its settings: in a world of its own.

    First what it costs in a step, within seconds; a minute or more later also what it takes to compile.
    """
    from web import Cost

    world = session.scene.make(**session.frame.settings.to_dict())
    for _ in range(SETTLED):
        world.step(TIME_STEP)
    snapshot, names = world.snapshot(), [effect.name for effect in world.effects]
    stepping = measure(world)
    yield {name: Cost(stepping.get(name)) for name in names}
    compiling = compile_costs(snapshot)
    yield {name: Cost(stepping.get(name), compiling.get(name)) for name in names}


def run(options: argparse.Namespace) -> int:
    from web import App, ListenError

    scene = scene_named(options.scene)
    settings = chosen_settings(options)
    made(scene, settings)
    with interruptible():
        rehearse(scene, say, threads=options.threads, **settings)
    with stop_requested() as stop:
        session = Session(
            scene.name, open_recorder=open_recorder, record_dir=options.record_dir, threads=options.threads, **settings
        )
        try:
            app = App(session, host=options.host, port=options.port, measure_effects=lambda: effect_costs(session))
        except ListenError as error:
            raise BadInput(str(error)) from None
        session.start()
        print(f"tumble is at {app.url}   (Ctrl-C ends it)", flush=True)
        if not options.no_open:
            webbrowser.open(app.url)
        with compiling_rest(settings.get("precision", scene.defaults().precision)):
            stop.wait()
        session.close()
        app.close()
    return 0
