"""Compute a recording again and compare every step, bit for bit."""

from __future__ import annotations

import argparse
import math
from collections import deque
from collections.abc import Iterator
from dataclasses import asdict
from itertools import islice
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import track

from engine import StepError
from sandbox.compiling import announced
from sandbox.frame import Frame
from sandbox.repeat import repeat
from sandbox.verbs.common import BadInput, add_json, add_recording, chosen_recording, report, say

if TYPE_CHECKING:
    from recordings import Recording

NAME = "verify"
DIFFERENT = 1  # exit code


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    recording = chosen_recording(options)
    if recording.schema == 1:
        raise BadInput(f"{options.file}: written by an older tumble: it can be played, but not be computed again")
    try:
        with announced(say):
            deque(islice(repeat(recording), 2), 0)
        text, difference = _difference(recording)
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError) as error:
        raise BadInput(f"{options.file}: cannot be computed again: {error}") from None
    steps = len(recording.steps)
    data = {
        "file": str(options.file),
        "scene": recording.scene,
        "whole": recording.whole,
        "steps": steps,
        "identical": difference is None,
        "difference": difference,
    }
    identical = f"{steps} steps identical" + ("" if recording.whole else " (of a file cut short)")
    report(options, data, identical if difference is None else f"different: {text}")
    return 0 if difference is None else DIFFERENT


def _difference(recording: Recording) -> tuple[str, dict[str, Any] | None]:
    """The first difference as text and for JSON; None if there is none."""
    from recordings import compare

    reached = [recording.start_step]
    try:
        found = compare(recording, _computed(recording, reached))
    except StepError as error:
        return str(error), {"step": reached[-1] + 1, "message": str(error)}
    if found is None:
        return "", None
    return str(found), {name: _json_ready(value) for name, value in asdict(found).items()}


def _computed(recording: Recording, reached: list[int]) -> Iterator[Frame]:
    """The frames computed again, with a progress bar; `reached` notes the last one's step."""
    console = Console(stderr=True)
    total = len(recording.steps) + 1
    frames = repeat(recording)
    for frame in track(frames, "verifying", total, console=console, disable=not console.is_terminal, transient=True):
        reached[-1] = frame.step
        yield frame


def _json_ready(value: Any) -> Any:
    """JSON has no NaN and no infinity: they become text."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
