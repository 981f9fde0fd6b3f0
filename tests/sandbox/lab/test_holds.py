"""What docs/solvers.md says that solvers hold is what the laboratory prints."""

from __future__ import annotations

from pathlib import Path

import pytest

from sandbox.lab import holds

SAID = (Path(__file__).parents[3] / "docs" / "solvers.md").read_text(encoding="utf-8").splitlines()
QUICK = [what for what in holds.ROWS if not what.startswith(("tower of 20", "tower of 40", "chain", "ball"))]


def test_every_row_stands_in_the_document() -> None:
    for what in (*holds.ROWS, *holds.MORE):
        assert any(each.startswith(f"| {what} |") for each in SAID), what


@pytest.mark.parametrize("what", QUICK)
def test_solvers_hold_what_is_said(what: str) -> None:
    assert holds.row(what) in SAID


@pytest.mark.parametrize("what", [what for what in holds.MORE if what.startswith("`avbd`")])
def test_momentum_is_kept_as_far_as_iterations_have_converged(what: str) -> None:
    assert holds.line([what, holds.MORE[what]()]) in SAID


def test_more_iterations_keep_more_momentum() -> None:
    lost = [5.0 - float(holds.head_on(solver="avbd", iterations=iterations)) for iterations in (10, 50, 1000)]
    assert lost[0] > 5 * lost[1] > lost[2] == 0.0


def test_what_falls_is_told() -> None:
    assert holds.tower(5, 0.6, solver="soft_step") == "falls"
    assert holds.heavy_on_light(400, solver="xpbd") == "falls through"
