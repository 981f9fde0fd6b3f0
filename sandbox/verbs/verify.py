"""Compute a recording again and compare every step, bit for bit."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console
from rich.progress import track

from engine import StepError
from sandbox.compiling import compile_all
from sandbox.frame import Frame
from sandbox.repeat import Recorded, repeat
from sandbox.verbs.common import BadInput, add_json, report, say

NAME = "verify"
DIFFERENT = 1  # exit code


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, metavar="FILE.rrd")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from recordings import RecordingError, compare, read

    try:
        recording = read(options.file)
        compile_all(say, [recording.settings.get("precision", "single")])
        found = compare(recording, _shown(recording))
        difference = None if found is None else str(found)
    except RecordingError as error:
        raise BadInput(str(error)) from None
    except StepError as error:
        difference = str(error)
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{options.file}: cannot be computed again: {error}") from None
    steps = len(recording.steps)
    data = {
        "file": str(options.file),
        "scene": recording.scene,
        "steps": steps,
        "identical": difference is None,
        "difference": difference,
    }
    report(options, data, f"{steps} steps identical" if difference is None else f"different: {difference}")
    return 0 if difference is None else DIFFERENT


def _shown(recorded: Recorded) -> Iterator[Frame]:
    """The frames computed again, with a progress bar."""
    console = Console(stderr=True)
    total = len(recorded.steps) + 1
    frames = repeat(recorded)
    return iter(track(frames, "verifying", total, console=console, disable=not console.is_terminal, transient=True))
