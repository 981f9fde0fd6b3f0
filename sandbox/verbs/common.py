"""What several verbs share: arguments, bad input, and reports as text or JSON."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine import World, validate
from engine.settings import MOST, describe
from engine.threads import MOST as MOST_THREADS
from sandbox.scenes import Scene, UnknownScene, find_scene
from sandbox.verbs.writable import hindrance

if TYPE_CHECKING:
    from recordings import Recording


SETTINGS = ("solver", "substeps", "iterations", "stiffness", "precision", "broad_phase")


class BadInput(Exception):
    """The user can mend it: the message is the one line he sees, and the exit code is 2."""


def scene_named(name: str) -> Scene:
    """A scene by name."""
    try:
        return find_scene(name)
    except UnknownScene as error:
        raise BadInput(str(error)) from None


def time_step(text: str) -> float:
    """A time step as "1/60" or "0.01" [s]."""
    try:
        above, slash, below = text.partition("/")
        return validate.between("dt", float(above) / (float(below) if slash else 1.0), 1e-5, 1.0)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r}: must be seconds from 1e-5 to 1, such as 1/60 or 0.01") from None


def whole_number(low: int, high: int) -> Any:
    """An argparse type: a whole number from low to high."""

    def parse(text: str) -> int:
        try:
            return validate.whole("value", int(text), low, high)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r}: must be a whole number from {low} to {high}") from None

    return parse


def add_settings(parser: argparse.ArgumentParser) -> None:
    """--solver, --substeps, --iterations and so on: instead of what the scene asks for."""
    for info in describe():
        if info.name in SETTINGS:
            flag = "--" + info.name.replace("_", "-")
            about = f"{info.hint}; default: the scene's"
            if info.kind == "whole":
                parser.add_argument(flag, type=whole_number(1, MOST[info.name]), metavar="N", help=about)
            else:
                parser.add_argument(flag, choices=info.choices, help=about)


def add_threads(parser: argparse.ArgumentParser) -> None:
    """--threads: how many a step may use. Unless told otherwise one core is left, to the page or to the disk."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    spare = min(max(1, cores - 1), MOST_THREADS)
    parser.add_argument(
        "--threads", type=whole_number(1, MOST_THREADS), default=spare, metavar="N",
        help=f"that a step may use; default: all cores but one, here {spare}",
    )  # fmt: skip


def chosen_settings(options: argparse.Namespace) -> dict[str, Any]:
    """The settings that were given."""
    return {name: getattr(options, name) for name in SETTINGS if getattr(options, name) is not None}


def made(scene: Scene, settings: Mapping[str, Any]) -> World:
    """The scene's world. BadInput where it cannot be had with these settings."""
    try:
        return scene.make(**settings)
    except ValueError as error:
        raise BadInput(f"{scene.name}: {error}") from None


def add_address(parser: argparse.ArgumentParser) -> None:
    """--host, --port, --no-open: where the page is served."""
    parser.add_argument("--host", default="127.0.0.1", help="address to serve on; 0.0.0.0 lets other machines in")
    parser.add_argument("--port", type=whole_number(0, 65535), default=8080, help="default: 8080; 0 takes a free one")
    parser.add_argument("--no-open", action="store_true", help="do not open a browser")


def add_recording(parser: argparse.ArgumentParser) -> None:
    """FILE.rrd, and --partial for one that was cut short."""
    parser.add_argument("file", type=Path, metavar="FILE.rrd")
    parser.add_argument("--partial", action="store_true", help="of a truncated file, take what can be read")


def chosen_recording(options: argparse.Namespace) -> Recording:
    """The recording, with at least one step; whole, unless --partial."""
    from recordings import RecordingError, read

    try:
        recording = read(options.file)
    except RecordingError as error:
        raise BadInput(str(error)) from None
    steps = len(recording.steps)
    if not steps:
        reason = "holds no step" if recording.whole else "truncated; none of its steps can be read"
        raise BadInput(f"{options.file}: {reason}")
    if not (recording.whole or options.partial):
        raise BadInput(f"{options.file}: truncated; its first {steps} steps can be read (--partial takes them)")
    return recording


def add_json(parser: argparse.ArgumentParser) -> None:
    """--json FILE."""
    parser.add_argument("--json", metavar="FILE", help="write the report as JSON; - is standard output")


def check_json(options: argparse.Namespace) -> None:
    """BadInput if --json cannot be written: before minutes of measuring are lost."""
    if options.json not in (None, "-") and (why := hindrance(Path(options.json))):
        raise BadInput(f"--json {options.json}: {why}")


def report(options: argparse.Namespace, data: Any, text: str) -> None:
    """Prints the text, and writes the data where --json says; on standard output the JSON stands alone."""
    if options.json == "-":
        print(json.dumps(data, indent=2))
        return
    if text:
        print(text)
    if options.json is not None:
        try:
            Path(options.json).write_text(json.dumps(data, indent=2) + "\n")
        except OSError as error:
            raise BadInput(f"--json {options.json}: cannot be written: {error.strerror}") from None


def say(text: str) -> None:
    """A line for the person in front of the terminal, out of the way of what standard output is piped into."""
    print(text, file=sys.stderr, flush=True)
