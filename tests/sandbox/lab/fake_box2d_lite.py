"""A checkout, a compiler and a driver that only look like Box2D Lite's: tests need neither g++ nor its sources."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from sandbox.lab.peers.box2d_lite import PARTS

STEP_CPU, STEP_WALL = 2.0, 3.0  # what each step takes, so it says [ms]

DRIVER = f"""#!{sys.executable}
import sys

bodies = []
for line in sys.stdin:
    word, *values = line.split()
    if word == "bodies":
        bodies = [sys.stdin.readline().split() for _ in range(int(values[0]))]
    elif word == "joints":
        joints = [sys.stdin.readline().split() for _ in range(int(values[0]))]
    elif word == "step":
        print("{STEP_CPU} {STEP_WALL}\\n" * int(values[0]), end="", flush=True)
    elif word == "positions":
        print("".join(f"{{body[3]}} {{body[4]}}\\n" for body in bodies), end="", flush=True)
"""

BROKEN_DRIVER = f"""#!{sys.executable}
import sys

sys.stdin.readline()
sys.exit(7)
"""


def make_checkout(folder: Path) -> Path:
    """A folder with the files that a checkout is recognised by."""
    for part in PARTS:
        (folder / part).parent.mkdir(parents=True, exist_ok=True)
        (folder / part).write_text("")
    return folder


def install_compiler(monkeypatch: pytest.MonkeyPatch, folder: Path, script: str) -> None:
    """Puts a g++ first on the path that is this shell script."""
    folder.mkdir(exist_ok=True)
    compiler = folder / "g++"
    compiler.write_text("#!/bin/sh\n" + script)
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


def install_driver(monkeypatch: pytest.MonkeyPatch, folder: Path, driver: str = DRIVER) -> None:
    """Puts a g++ first on the path whose result is this driver; its arguments are kept beside it."""
    folder.mkdir(exist_ok=True)
    (folder / "driver").write_text(driver)
    (folder / "driver").chmod(0o755)
    script = f"""
echo "$@" > '{folder}/arguments'
while [ "$1" != -o ]; do shift; done
cp '{folder}/driver' "$2"
"""
    install_compiler(monkeypatch, folder, script)
