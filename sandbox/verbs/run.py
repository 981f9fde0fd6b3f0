"""Open the sandbox: a living scene in the browser."""

from __future__ import annotations

import argparse
import webbrowser
from pathlib import Path

from sandbox.compiling import compile_all
from sandbox.recorder import RecordingStart
from sandbox.session import Session
from sandbox.signals import interruptible, stop_requested
from sandbox.verbs.common import BadInput, add_address, add_settings, chosen_settings, say, scene_named
from sandbox.viewer import Viewer

NAME = "run"
DEFAULT_SCENE = "The Talk/Pyramid"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", nargs="?", default=DEFAULT_SCENE, help=f"default: {DEFAULT_SCENE}")
    add_address(parser)
    add_settings(parser)
    parser.add_argument("--record-dir", type=Path, default=Path("runs"), metavar="DIR", help="default: runs")


def open_recorder(path: Path, start: RecordingStart) -> Viewer:
    """Writes a recording; rerun is loaded when the first one begins."""
    from recordings import Writer

    return Writer(path, start)


def run(options: argparse.Namespace) -> int:
    from web import App, ListenError

    scene = scene_named(options.scene)
    settings = chosen_settings(options)
    with interruptible():
        compile_all(say, [settings.get("precision", "single")])
    with stop_requested() as stop:
        session = Session(scene.name, open_recorder=open_recorder, record_dir=options.record_dir, **settings)
        try:
            app = App(session, host=options.host, port=options.port)
        except ListenError as error:
            raise BadInput(str(error)) from None
        session.start()
        print(f"tumble is at {app.url}   (Ctrl-C ends it)", flush=True)
        if not options.no_open:
            webbrowser.open(app.url)
        stop.wait()
        session.close()
        app.close()
    return 0
