"""The same bits, compiled or not; and no kernel compiled for more types than there are."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import engine
from engine.narrow_phase import COLLIDERS, TALK_COLLIDERS
from engine.shapes import BOUNDS
from tests.engine import tiny_worlds

ROOT = Path(engine.__file__).parents[1]

# Kernels that differ by whether a table is there, such as "joints or None": how many such patterns the worlds make.
PATTERNS = {
    "engine.solvers.sequential_impulses.solve_all": 2,  # with joints and without
    "engine.solvers.ngs.solve_all": 3,  # without joints, with them, and with bouncing besides
    "engine.solvers.direct.solve_all": 3,
    "engine.integrate.apply_forces": 3,  # gravity; with its scale and both kinds of damping; nothing
    "engine.solvers.soft_step.work.run": 8,  # these three, joints, also soft, all, sleepers, what the talk's lacks
}


@pytest.fixture(scope="module")
def reports() -> dict[bool, dict]:
    """What tiny_worlds reports from a process of its own, by whether it compiled; both at once."""
    running = {}
    for compiled in (False, True):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": str(int(not compiled))}
        environment.pop("NUMBA_JIT_COVERAGE", None)
        running[compiled] = subprocess.Popen(
            [sys.executable, tiny_worlds.__file__],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
    found = {}
    for compiled, process in running.items():
        out, errors = process.communicate()
        assert process.returncode == 0, errors
        found[compiled] = json.loads(out)
        assert found[compiled]["compiled"] is compiled
    return found


@pytest.mark.parametrize("name", tiny_worlds.cases())
def test_same_bits_with_and_without_compilation(reports: dict[bool, dict], name: str) -> None:
    plain, compiled = reports[False]["worlds"][name], reports[True]["worlds"][name]
    assert len(plain) == len(compiled) == tiny_worlds.STEPS
    for step, (a, b) in enumerate(zip(plain, compiled, strict=True), 1):
        assert a == b, f"step {step}: {sorted(table for table in a if a[table] != b[table])} differ"
    assert len({row["bodies.bodies"] for row in plain}) > tiny_worlds.STEPS // 2, "something moves"


def test_sine_and_cosine_have_the_same_bits(reports: dict[bool, dict]) -> None:
    assert reports[False]["trigonometry"] == reports[True]["trigonometry"]


def test_every_world_is_another(reports: dict[bool, dict]) -> None:
    assert len({rows[-1]["hash"] for rows in reports[True]["worlds"].values()}) == len(tiny_worlds.cases())


def test_signature_budget(reports: dict[bool, dict]) -> None:
    # one signature a precision, for each pattern of absent tables; more would be a trap like dt=1 beside dt=1.0
    counts = reports[True]["signatures"]
    assert counts["engine.integrate.update_positions"] == 2
    for name, patterns in PATTERNS.items():
        assert counts[name] == 2 * patterns, name
    # what run_substeps calls is compiled along with it, and counted where it was not found on disk
    inside = {name: max(PATTERNS.values()) for name in counts if name.startswith("engine.solvers.")}
    own = {name: count for name, count in counts.items() if not name.startswith(("engine.lanes.", "engine.vec2."))}
    too_many = {name: count for name, count in own.items() if count > 2 * (inside | PATTERNS).get(name, 1)}
    assert not too_many, too_many


def test_every_collider_and_every_way_of_bounding_was_run(reports: dict[bool, dict]) -> None:
    counts = reports[True]["signatures"]
    kernels = [*COLLIDERS, *TALK_COLLIDERS, *BOUNDS]
    names = {f"{kernel.py_func.__module__}.{kernel.py_func.__name__}" for kernel in kernels}
    assert {name for name in names if counts[name] == 2} == names
