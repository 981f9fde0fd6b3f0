"""Every scene comes to the same bits as when its golden hash was written, with every solver."""

from __future__ import annotations

import pytest

from engine import SOLVERS
from tests.golden import hashes


def test_every_scene_and_solver_has_a_golden_hash() -> None:
    known = {(scene, solver) for scene, of_scene in hashes.load().items() for solver in of_scene}
    assert known == set(hashes.cases()), "make golden"


@pytest.mark.parametrize(("scene", "solver"), hashes.cases(), ids=[", ".join(case) for case in hashes.cases()])
def test_golden_hash(scene: str, solver: str) -> None:
    assert hashes.golden_hash(scene, solver) == hashes.load()[scene][solver]


@pytest.mark.parametrize("solver", SOLVERS)
def test_scenes_differ(solver: str) -> None:
    found = [of_scene[solver] for of_scene in hashes.load().values() if of_scene[solver] != hashes.NONE]
    assert len(set(found)) == len(found)
