"""The same bits, compiled or not; and no kernel compiled for more types than there are."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import engine
from tests.engine import tiny_worlds

ROOT = Path(engine.__file__).parents[1]

# Kernels that differ by whether a table is there: "joints or None".
TABLE_OR_NONE = {"engine.solvers.sequential_impulses.solve": 2}


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


@pytest.mark.parametrize("name", tiny_worlds.variants())
def test_same_bits_with_and_without_compilation(reports: dict[bool, dict], name: str) -> None:
    plain, compiled = reports[False]["worlds"][name], reports[True]["worlds"][name]
    assert len(plain) == len(compiled) == tiny_worlds.STEPS
    for step, (a, b) in enumerate(zip(plain, compiled, strict=True), 1):
        assert a == b, f"step {step}: {sorted(table for table in a if a[table] != b[table])} differ"
    assert len({row["bodies.bodies"] for row in plain}) > tiny_worlds.STEPS // 2, "something moves"


def test_sine_and_cosine_have_the_same_bits(reports: dict[bool, dict]) -> None:
    assert reports[False]["trigonometry"] == reports[True]["trigonometry"]


def test_every_world_is_another(reports: dict[bool, dict]) -> None:
    assert len({rows[-1]["hash"] for rows in reports[True]["worlds"].values()}) == len(tiny_worlds.variants())


def test_signature_budget(reports: dict[bool, dict]) -> None:
    # one signature a precision, for each pattern of absent tables; more would be a trap like dt=1 beside dt=1.0
    counts = reports[True]["signatures"]
    assert counts["engine.solvers.sequential_impulses.solve"] == 4
    assert counts["engine.integrate.update_positions"] == 2
    too_many = {name: count for name, count in counts.items() if count > 2 * TABLE_OR_NONE.get(name, 1)}
    assert not too_many, too_many
