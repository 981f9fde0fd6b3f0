"""Play a recording, in the page or in the rerun viewer."""

from __future__ import annotations

import argparse
import re
import subprocess
import webbrowser
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from engine import Diagnostics, Settings
from engine.vec2 import Vec2
from sandbox.commands import modern
from sandbox.frame import Frame, Status
from sandbox.signals import stop_requested
from sandbox.verbs.common import BadInput, add_address, add_recording, chosen_recording

NAME = "replay"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    parser.add_argument("--viewer", choices=("page", "rerun"), default="page", help="default: page")
    add_address(parser)


def run(options: argparse.Namespace) -> int:
    recording = chosen_recording(options)
    if options.viewer == "rerun":
        return _open_rerun(options.file, whole=recording.whole)
    return _serve(options, recording)


def _open_rerun(file: Path, *, whole: bool) -> int:
    """Opens the file in rerun's own viewer, which listens on this machine alone, and waits for it.

    By its path rerun opens whole files of this suffix only; from standard input it takes what there is.
    """
    package = find_spec("rerun_cli")
    if package is None or package.origin is None:
        raise BadInput("the rerun viewer is not installed: it comes with rerun-sdk")
    binary = Path(package.origin).parent / "rerun"
    source = str(file.absolute()) if whole and file.suffix == ".rrd" else "-"
    command = [str(binary), "--bind", "127.0.0.1", source]
    try:
        with file.open("rb") as content:
            ended = subprocess.run(
                command, stdin=content, stderr=subprocess.PIPE, text=True, errors="replace", check=False
            )
    except OSError as error:
        raise BadInput(f"the rerun viewer cannot be started: {error}") from None
    if ended.returncode:
        raise BadInput(f"the rerun viewer failed: {_reason(ended.stderr) or f'exit code {ended.returncode}'}")
    return 0


def _reason(log: str) -> str:
    """Of what the viewer wrote, the line that says why it failed: without colours and places in its source."""
    plain = re.sub(r"\x1b\[[0-9;]*m| at \S+\.rs:\d+", "", log)
    lines = [line.strip() for line in plain.splitlines() if line.strip()]
    errors = [line for line in lines if line.lower().startswith("error")]
    return [*lines, *errors][-1].removeprefix("Error: ") if lines else ""


def _serve(options: argparse.Namespace, recording: Any) -> int:
    from web import ListenError, ReplayApp

    try:
        frames = RecordedFrames(recording)
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{options.file}: cannot be played: {error}") from None
    with stop_requested() as stop:
        try:
            app = ReplayApp(frames, recording.view, host=options.host, port=options.port, title=options.file.name)
        except ListenError as error:
            raise BadInput(str(error)) from None
        print(f"{options.file} plays at {app.url}   (Ctrl-C ends it)", flush=True)
        if not options.no_open:
            webbrowser.open(app.url)
        stop.wait()
        app.close()
    return 0


class RecordedFrames:
    """A recording as a sequence of frames, as the page's player takes it. Times within a step were not recorded."""

    def __init__(self, recording: Any) -> None:
        self._recording = recording
        self._settings = self._settings_by_step()

    def __len__(self) -> int:
        return len(self._recording.steps)

    def frame(self, index: int) -> Frame:
        """Frame number `index`, from 0, of the recorded steps."""
        recording = self._recording
        step = int(recording.steps[index])
        state, numbers = recording.state(step), recording.diagnostics[index]
        return Frame(
            scene=recording.scene,
            step=step,
            time=state.time,
            dt=state.dt,
            serials=state.serials,
            body_kinds=state.body_kinds,
            positions=state.positions,
            angles=state.angles,
            velocities=state.velocities,
            angular_velocities=state.angular_velocities,
            asleep=state.asleep,
            shape_serials=state.shape_serials,
            owners=state.owners,
            shape_kinds=state.shape_kinds,
            sizes=state.sizes,
            places=state.places,
            corner_counts=state.corner_counts,
            corners=state.corners,
            contacts=state.contacts,
            joints=state.joints,
            events=state.events,
            diagnostics=Diagnostics(
                float(numbers["kinetic_energy"]),
                float(numbers["potential_energy"]),
                Vec2(float(numbers["momentum_x"]), float(numbers["momentum_y"])),
                float(numbers["angular_momentum"]),
                float(numbers["max_penetration"]),
                int(numbers["contact_count"]),
            ),
            settings=self._settings[index],
            commands=tuple(recording.commands.get(step, ())),
            content=hash((state.serials.tobytes(), state.shape_serials.tobytes())),
            status=Status(),
        )

    def _settings_by_step(self) -> list[Settings]:
        """The settings at every step: those of the start, changed by the commands since."""
        settings = Settings.from_dict(self._recording.settings)
        result = []
        for step in self._recording.steps:
            for command in self._recording.commands.get(int(step), ()):
                settings = _changed(settings, command)
            result.append(settings)
        return result


def _changed(settings: Settings, command: dict[str, Any]) -> Settings:
    """The settings after a recorded command."""
    match modern(command):
        case {"command": "set", "setting": name, "value": value}:
            return settings.changed({name: value})
        case {"command": "set_all", "settings": several}:
            return settings.changed(several)
    return settings
