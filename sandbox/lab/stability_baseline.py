"""What held when docs/stability.json was written: a case that falls now and held then is a step back."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from engine import SOLVERS
from sandbox.lab.stability import Row

BASELINE = Path(__file__).parents[2] / "docs" / "stability.json"


def held(file: Path | None = None) -> set[tuple[str, str]]:
    """(case, solver) that passed with the solver's defaults, of our solvers; empty if there is no such file."""
    file = file or BASELINE
    if not file.is_file():
        return set()
    rows = json.loads(file.read_text())
    return {
        (row["case"], row["solver"]) for row in rows if row["default"] and row["passed"] and row["solver"] in SOLVERS
    }


def steps_back(rows: Sequence[Row], file: Path | None = None) -> list[Row]:
    """Rows of our solvers' defaults that fail, or can no longer be had, where they held."""
    before = held(file)
    return [row for row in rows if row.default and not row.passed and (row.case, row.solver) in before]


def not_shown(cells: Iterable[tuple[str, str]], rows: Sequence[Row], file: Path | None = None) -> list[tuple[str, str]]:
    """Of these (case, solver) those that held, and of which no row of the defaults says whether they still do."""
    before, tried = held(file), {(row.case, row.solver) for row in rows if row.default}
    return [cell for cell in cells if cell in before and cell not in tried]
