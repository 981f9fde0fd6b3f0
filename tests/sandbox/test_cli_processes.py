"""The command as a process: signals, pipes, and a kill."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

import recordings
from sandbox import cli
from tests.sandbox.watching import PATIENCE, until

TUMBLE = [sys.executable, "-m", "sandbox.cli"]
ROOT = Path(__file__).parents[2]
STARTED: list[subprocess.Popen[str]] = []


@pytest.fixture(autouse=True)
def none_is_left() -> Iterator[None]:
    """A test that fails half way leaves no process behind."""
    yield
    while STARTED:
        STARTED.pop().kill()


def start(*arguments: object) -> subprocess.Popen[str]:
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    command = [*TUMBLE, *map(str, arguments)]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT, env=buffered
    )
    STARTED.append(process)
    return process


def ended(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    try:
        out, err = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    assert "Traceback" not in out + err
    return process.returncode, out, err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_run_ends_cleanly(number: signal.Signals, tmp_path: Path) -> None:
    process = start("run", "--no-open", "--port", 0, "--record-dir", tmp_path)
    assert process.stdout is not None
    line = process.stdout.readline()
    found = re.search(r"http://127\.0\.0\.1:\d+/", line)
    assert found, line
    with urllib.request.urlopen(found[0], timeout=PATIENCE) as answer:
        assert answer.status == 200
    asked = time.perf_counter()
    process.send_signal(number)
    code, _, err = ended(process)
    assert time.perf_counter() - asked < 0.5 * PATIENCE
    assert code == 0, err
    assert "rror" not in err


def test_ctrl_c_before_anything_is_there() -> None:
    """In the second in which the engine is imported: the import is held up to hit it."""
    code = """
import builtins, sys
real = builtins.__import__
def slow(name, *rest, **more):
    if name.startswith("engine"):
        builtins.__import__ = real
        print("importing", flush=True)
        real("time").sleep(60)
    return real(name, *rest, **more)
builtins.__import__ = slow
from sandbox.cli import main
sys.exit(main(["run", "--no-open", "--port", "0"]))
"""
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "importing\n"
    process.send_signal(signal.SIGINT)
    assert ended(process) == (cli.INTERRUPTED, "", "")


def test_a_reader_that_goes_away_is_no_error() -> None:
    process = start("scenes", "--json", "-")
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    assert (process.wait(PATIENCE), process.stderr.read()) == (0, "")


def test_a_recording_survives_a_kill(tmp_path: Path) -> None:
    file = tmp_path / "x.rrd"
    part = tmp_path / "x.rrd.part"
    process = start("record", "Pyramid", "-o", file, "--steps", 10_000_000)
    try:
        until(lambda: part.exists() and part.stat().st_size > 4_000_000)
        process.kill()
    finally:
        code, _, _ = ended(process)
    assert code == -signal.SIGKILL
    assert not file.exists()
    steps = len(recordings.read(part).steps)
    assert steps > 10
    assert cli.main(["verify", str(part)]) == cli.BAD_INPUT, "it was cut short"
    assert cli.main(["verify", str(part), "--partial"]) == 0
