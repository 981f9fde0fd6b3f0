"""Machine instructions of a plain pyramid's step, counted by valgrind: with more effects in the engine, and with fewer.

    python -m tests.engine.effects.instructions

takes some minutes; the tests count Python's own instructions instead (test_on_demand.py). A run of many steps less one
of few leaves the steps alone. What varies from run to run is how Python starts: about three in a thousand.
"""

from __future__ import annotations

import gc
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from engine import World
from tests.engine.effects.plain_pyramid import effect_sets, pyramid, use

FEW, MANY = 300, 10300  # steps: starting Python varies by some million instructions
ROOT = Path(__file__).parents[3]


def run_steps(name: str, steps: int) -> World:
    """What is counted."""
    use(effect_sets()[name])
    world = pyramid()
    gc.disable()  # it comes when so much was allocated since the process began, and looks at everything there is
    for _ in range(steps):
        world.step(1 / 60)
    return world


def command(name: str, steps: int) -> list[str]:
    return [sys.executable, "-m", __spec__.name, name, str(steps)]


def counted(name: str, steps: int, environment: dict[str, str]) -> int:
    """Instructions of a process that makes so many steps."""
    valgrind = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    process = subprocess.run(
        [*valgrind, *command(name, steps)], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    found = re.search(r"I\s+refs:\s+([\d,]+)", process.stderr)
    assert found is not None, process.stderr
    return int(found[1].replace(",", ""))


def main() -> int:
    if shutil.which("valgrind") is None:
        print("valgrind is not installed: apt-get install valgrind", file=sys.stderr)
        return 2
    # valgrind knows fewer instructions than new processors have; one order of hashes
    plain = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "PYTHONHASHSEED": "0"}
    environment = {**os.environ, **plain, "PYTHONPATH": str(ROOT)}
    for name in effect_sets():
        subprocess.run(command(name, MANY), cwd=ROOT, env=environment, check=True)  # compiled, and on disk
        count = counted(name, MANY, environment) - counted(name, FEW, environment)
        print(f"{name:12}: {count / (MANY - FEW):,.0f} instructions a step", flush=True)
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 3:
        run_steps(sys.argv[1], int(sys.argv[2]))
    else:
        sys.exit(main())
