"""How long the code of effects takes to compile: what leaving them out saves.

In a process of its own with an empty cache: first a step without any effect, then one with each alone. Compiling is
timed kernel by kernel, each without the kernels compiled on its behalf. An effect costs the kernels that are its own,
and what a kernel that it changes takes longer than without it.

As a program: reads a snapshot from the file that is its argument, and prints {effect: seconds} as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from engine import EFFECTS, SOLVERS, Snapshot, World
from engine.compilation import timed_compilation
from engine.effects import Effect
from sandbox.lab.ablation import ON_REQUEST, begin
from sandbox.simulation import TIME_STEP

STEPS = 2  # the second one has contacts to keep
ROOT = Path(__file__).parents[2]


class CompileError(Exception):
    """The process ended without a result; the message is one line."""


def compile_costs(snapshot: Snapshot) -> dict[str, float]:
    """What compiling each effect takes, by name [s], in the world of this snapshot. Takes as long as compiling all of
    the engine does, and a little more: half a minute.
    """
    with tempfile.TemporaryDirectory(prefix="tumble-") as folder:
        file = Path(folder, "snapshot")
        file.write_bytes(snapshot.to_bytes())
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(Path(folder, "cache")), "PYTHONPATH": str(ROOT)}
        environment.pop("NUMBA_DISABLE_JIT", None)
        done = subprocess.run(
            [sys.executable, "-m", __name__, str(file)], env=environment, capture_output=True, text=True, check=False
        )
    if done.returncode:
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise CompileError(f"compiling in a process of its own failed: {lines[-1]}")
    return {name: float(seconds) for name, seconds in json.loads(done.stdout).items()}


NAMELESS = "<lambda>"  # many have this name: what others of them took is no measure


def costs_here(snapshot: Snapshot) -> dict[str, float]:
    """The same, in this process, which must not have compiled any of it."""
    world = World(precision=snapshot.settings.precision)
    world.restore(snapshot)
    lacking = SOLVERS[snapshot.settings.solver].lacks
    known = [effect for effect in EFFECTS if effect.name not in lacking]
    before = {"": compiled(world, snapshot, frozenset())}
    costs = {}
    for effect in known:
        needed = frozenset({effect.needs} if effect.needs else ())
        times = compiled(world, snapshot, needed | {effect.name}, effect)
        base = {**before[""], **before.get(effect.needs, {})}
        base = {name: seconds for name, seconds in base.items() if not name.endswith(NAMELESS)}
        costs[effect.name] = max(sum(seconds - base.get(name, 0.0) for name, seconds in times.items()), 0.0)
        before[effect.name] = times
    return costs


def compiled(world: World, snapshot: Snapshot, names: frozenset[str], effect: Effect | None = None) -> dict[str, float]:
    """How long each kernel takes [s] that is compiled for steps with the code of these effects, and of no other."""
    everything = frozenset(effect.name for effect in EFFECTS)
    begin(world, snapshot, (names, everything - names))
    with timed_compilation() as times:
        for _ in range(STEPS):
            world.step(TIME_STEP)
        if effect is not None and effect.name in ON_REQUEST:
            ON_REQUEST[effect.name](world)
    return times


if __name__ == "__main__":
    json.dump(costs_here(Snapshot.from_bytes(Path(sys.argv[1]).read_bytes())), sys.stdout)
