"""Golden hashes: what every scene has come to after some steps, with every solver that knows its effects.

They say that nothing has changed, not that it is right: that is for the other tests. `make golden` writes them again
after a change that was meant.
"""

from __future__ import annotations

import json
from pathlib import Path

from engine import SOLVERS, TooLarge, World
from sandbox.scenes import SCENES, find_scene

FILE = Path(__file__).with_name("hashes.json")
STEPS = 60
BENCHMARK_STEPS = 20  # of thousands of bodies
DIRECT_STEPS = 5  # that solve dense systems
DT = 1.0 / 60.0
NONE = "refused"


def cases() -> list[tuple[str, str]]:
    """(scene, solver)"""
    return [(scene, solver) for scene in SCENES for solver in SOLVERS]


def golden_hash(scene: str, solver: str) -> str:
    """The state hash after its steps; NONE where the scene calls for what the solver lacks, or is too large for it."""
    try:
        world = start(scene, solver)
    except ValueError as error:
        assert "solver" in str(error), error
        return NONE
    for _ in range(steps_of(scene, solver)):
        try:
            world.step(DT)
        except TooLarge:
            return NONE
    return world.state_hash()


def steps_of(scene: str, solver: str) -> int:
    """Fewer where they take long."""
    if solver == "direct":
        return DIRECT_STEPS
    return BENCHMARK_STEPS if scene.startswith("Benchmark/") else STEPS


def start(scene: str, solver: str) -> World:
    """The scene with that solver, and that solver's own substeps and iterations."""
    own = find_scene(scene).defaults().solver == solver
    return find_scene(scene).make(**({} if own else {"solver": solver, "substeps": None, "iterations": None}))


def load() -> dict[str, dict[str, str]]:
    return json.loads(FILE.read_text()) if FILE.exists() else {}


def main() -> None:
    hashes: dict[str, dict[str, str]] = {}
    for scene, solver in cases():
        hashes.setdefault(scene, {})[solver] = golden_hash(scene, solver)
    before = load()
    FILE.write_text(json.dumps(hashes, indent=1) + "\n")
    for scene, solver in cases():
        old, new = before.get(scene, {}).get(solver), hashes[scene][solver]
        if old != new:
            print(f"{scene}, {solver}: {'new' if old is None else 'changed'}")


if __name__ == "__main__":
    main()
