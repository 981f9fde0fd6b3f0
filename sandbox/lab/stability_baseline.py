"""What held when docs/stability.json was written: a case that falls now and held then is a step back."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from engine import SOLVERS
from sandbox.lab.stability import Row

BASELINE = Path(__file__).parents[2] / "docs" / "stability.json"


def held(file: Path = BASELINE) -> set[tuple[str, str]]:
    """(case, solver) that passed with the solver's defaults, of our solvers; empty if there is no such file."""
    if not file.is_file():
        return set()
    rows = json.loads(file.read_text())
    return {
        (row["case"], row["solver"]) for row in rows if row["default"] and row["passed"] and row["solver"] in SOLVERS
    }


def steps_back(rows: Sequence[Row], file: Path = BASELINE) -> list[Row]:
    """Rows of our solvers' defaults that fail, or can no longer be had, where they held."""
    before = held(file)
    return [row for row in rows if row.default and not row.passed and (row.case, row.solver) in before]
