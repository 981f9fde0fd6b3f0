"""The dynamic tree against comparing every pair, over random histories."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import engine
from engine.broad_phase.dynamic_tree import DynamicTree
from tests.engine.broad_phase import crowd as crowd_module
from tests.engine.broad_phase.crowd import ACTIONS, DYNAMIC, KINEMATIC, STATIC, Crowd
from tests.engine.broad_phase.tree_check import check
from tests.naive.broad_phase import overlapping_pairs

pytestmark = pytest.mark.kernel

Script = list[tuple[str, int]]
scripts = st.lists(st.tuples(st.sampled_from(ACTIONS), st.integers(0, 40)), max_size=12)
seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=60)
@given(seed=seeds, spread=st.sampled_from([1.0, 8.0, 30.0]), script=scripts)
def test_any_history(seed: int, spread: float, script: Script) -> None:
    crowd = Crowd(seed, spread)
    for action, number in [("spawn", 30), *script]:
        crowd.act(action, number)


@settings(max_examples=30)
@given(seed=seeds, script=scripts)
def test_pairs_follow_from_fat_boxes_alone(seed: int, script: Script) -> None:
    """A tree begun with the fat boxes of another goes on as that one does, whatever its history was."""
    crowd = Crowd(seed, 8.0)
    crowd.act("spawn", 30)
    for action, number in script:
        crowd.act(action, number)
    twin = DynamicTree()
    twin.restore(crowd.rows, crowd.serials, crowd.groups, crowd.tree.fat_bounds())
    check(twin, crowd.bounds, crowd.groups)
    for _ in range(3):
        assert twin.pairs[: twin.pair_count].tolist() == crowd.tree.pairs[: crowd.tree.pair_count].tolist()
        assert (twin.fat_bounds() == crowd.tree.fat_bounds()).all()
        crowd.drift(10)
        changed = crowd.tree.update(crowd.bounds)
        assert twin.update(crowd.bounds) == changed


@settings(max_examples=30)
@given(seed=seeds, script=scripts)
def test_tight_overlaps_do_not_depend_on_history(seed: int, script: Script) -> None:
    """Of a tree with a history and one without, the pairs whose tight boxes overlap are the same, in the same order."""
    crowd = Crowd(seed, 8.0)
    crowd.act("spawn", 30)
    for action, number in script:
        crowd.act(action, number)
    fresh = DynamicTree()
    fresh.sync(crowd.rows, crowd.serials, crowd.groups)
    fresh.update(crowd.bounds)
    tight = [(crowd.rows[i], crowd.rows[j]) for i, j in overlapping_pairs(crowd.bounds, crowd.groups != DYNAMIC)]
    for tree in (crowd.tree, fresh):
        assert [pair for pair in map(tuple, tree.pairs[: tree.pair_count].tolist()) if pair in set(tight)] == tight


def boxes(*corners: tuple[float, float, float, float]) -> np.ndarray:
    return np.array(corners, np.float32).reshape(-1, 4).T.copy()


def tree_of(bounds: np.ndarray, groups: list[int]) -> DynamicTree:
    tree = DynamicTree()
    numbers = np.arange(len(groups))
    tree.sync(numbers, numbers, np.array(groups, np.uint8))
    tree.update(bounds)
    return tree


def found(tree: DynamicTree) -> list[tuple[int, int]]:
    return [(int(a), int(b)) for a, b in tree.pairs[: tree.pair_count]]


def test_who_meets_whom() -> None:
    """Six boxes on one place: every pair of which one is dynamic."""
    groups = [STATIC, DYNAMIC, KINEMATIC, STATIC, DYNAMIC, KINEMATIC]
    tree = tree_of(boxes(*[(0, 0, 1, 1)] * 6), groups)
    assert found(tree) == [(i, j) for i in range(6) for j in range(i + 1, 6) if DYNAMIC in (groups[i], groups[j])]


def test_first_is_who_was_created_first_whatever_its_row() -> None:
    tree = DynamicTree()
    tree.sync(np.array([7, 2, 5]), np.array([10, 11, 40]), np.ones(3, np.uint8))
    assert tree.update(boxes((0, 0, 1, 1), (0, 0, 1, 1), (0, 0, 1, 1)))
    assert found(tree) == [(7, 2), (7, 5), (2, 5)]


def test_a_row_with_another_serial_is_another_piece() -> None:
    bounds = boxes((0, 0, 1, 1), (0.5, 0, 1.5, 1), (5, 0, 6, 1))
    tree = tree_of(bounds, [DYNAMIC] * 3)
    assert found(tree) == [(0, 1)]
    tree.sync(np.array([0, 2, 1]), np.array([0, 2, 3]), np.ones(3, np.uint8))
    assert found(tree) == [], "pairs of what is gone are dropped at once"
    assert tree.update(bounds[:, [0, 2, 1]].copy()), "the pairs have changed, though they are the same rows again"
    assert found(tree) == [(0, 1)]


def test_what_is_gone_is_gone_at_once() -> None:
    """A sync alone drops its pairs, and the next update says so, though nothing has moved."""
    bounds = boxes((0, 0, 1, 1), (0.5, 0, 1.5, 1), (1, 0, 2, 1))
    everything = [(0, 1), (0, 2), (1, 2)]
    for rows, groups, left in (
        ([0, 2], [DYNAMIC, DYNAMIC], [(0, 2)]),  # destroyed
        ([0, 1, 2], [DYNAMIC, STATIC, DYNAMIC], [(0, 2)]),  # no longer pushed
        ([0, 5, 2], [DYNAMIC, DYNAMIC, DYNAMIC], [(0, 2)]),  # in another row
        ([0, 1, 2], [DYNAMIC, DYNAMIC, DYNAMIC], everything),
    ):
        tree = tree_of(bounds, [DYNAMIC] * 3)
        assert found(tree) == everything
        serials = [0, 2] if len(rows) == 2 else [0, 1, 2]
        tree.sync(np.array(rows), np.array(serials), np.array(groups, np.uint8))
        assert found(tree) == left
        assert tree.update(bounds[:, serials].copy()) == (left != everything)
        assert len(found(tree)) == (1 if len(rows) == 2 else 3)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_pair_lives_until_its_fat_boxes_part(side: float) -> None:
    """One box creeps away from another: the pair is there exactly as long as the fat boxes share a point."""
    tree = tree_of(boxes((0, 0, 1, 1), (0.9, 0, 1.9, 1)), [DYNAMIC, DYNAMIC])
    outlived = False
    for step in range(400):
        shift = side * step * 0.01 if side > 0 else side * (1.8 + step * 0.01)
        bounds = boxes((0, 0, 1, 1), (0.9 + shift, 0, 1.9 + shift, 1))
        before = found(tree)
        changed = tree.update(bounds)
        fat = tree.fat_bounds()
        meet = fat[0, 0] <= fat[1, 2] and fat[1, 0] <= fat[0, 2]
        assert found(tree) == ([(0, 1)] if meet else [])
        assert changed == (found(tree) != before)
        outlived |= bool(meet) and not overlapping_pairs(bounds, np.zeros(2))
    assert outlived
    assert found(tree) == []


def test_nothing_happens_inside_a_fat_box() -> None:
    tree = tree_of(boxes((0, 0, 1, 1), (3, 0, 4, 1)), [DYNAMIC, DYNAMIC])
    fat = tree.fat_bounds()
    assert np.allclose(fat[0], [-0.1, -0.1, 1.1, 1.1], atol=1e-5)
    assert not tree.update(boxes((0.09, -0.09, 1.09, 0.91), (3, 0, 4, 1)))
    assert (tree.fat_bounds() == fat).all()
    tree.update(boxes((0.11, 0, 1.11, 1), (3, 0, 4, 1)))
    assert (tree.fat_bounds()[0] != fat[0]).any()
    assert (tree.fat_bounds()[1] == fat[1]).all()


def test_what_cannot_move_has_no_margin() -> None:
    bounds = boxes((0, 0, 1, 1), (0, 0, 1, 1), (0, 0, 0.08, 0.08))
    fat = tree_of(bounds, [STATIC, KINEMATIC, DYNAMIC]).fat_bounds()
    assert (fat[0] == bounds[:, 0]).all()
    assert np.allclose(fat[1], [-0.1, -0.1, 1.1, 1.1], atol=1e-5)
    assert np.allclose(fat[2], [-0.01, -0.01, 0.09, 0.09], atol=1e-6), "an eighth of a small box"


@pytest.mark.parametrize("far", [1e4, 1e6, 1e8, 1e12])
def test_margins_far_from_the_origin(far: float) -> None:
    """A step of float32 there is larger than 0.1 m, yet a fat box is larger than the tight one."""
    place = np.float32(far)
    bounds = np.array([[place, -place, np.nextafter(place, np.inf), -place]], np.float32).T.copy()
    fat = tree_of(bounds, [DYNAMIC]).fat_bounds()[0]
    assert (fat[:2] < bounds[:2, 0]).all()
    assert (fat[2:] > bounds[2:, 0]).all()
    assert (np.abs(fat - bounds[:, 0]) <= 0.1 + 3e-6 * far).all()


def test_infinite_boxes() -> None:
    endless = np.inf
    rng = np.random.default_rng(0)
    lower = rng.uniform(-50, 50, (2, 60))
    bounds = np.concatenate([lower, lower + 1]).astype(np.float32)
    bounds[:, 3] = [-endless, -endless, endless, 0]
    bounds[:, 7] = [-endless, -endless, endless, endless]
    bounds[:, 11] = [0, -3, endless, 3]
    groups = np.ones(60, np.uint8)
    groups[[3, 20]] = 0
    tree = tree_of(bounds, groups.tolist())
    check(tree, bounds, groups)
    for _ in range(30):
        moving = np.setdiff1d(np.arange(60), [3, 7, 11])
        bounds[:, moving] += np.tile(rng.normal(0, 0.3, (2, len(moving))), (2, 1)).astype(np.float32)
        tree.update(bounds)
        check(tree, bounds, groups)


def test_no_pieces_and_one() -> None:
    tree = tree_of(np.empty((4, 0), np.float32), [])
    assert found(tree) == []
    assert tree.fat_bounds().shape == (0, 4)
    tree.sync(np.array([4]), np.array([9]), np.ones(1, np.uint8))
    assert not tree.update(boxes((0, 0, 1, 1)))
    tree.sync(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0, np.uint8))
    assert not tree.update(np.empty((4, 0), np.float32))


def test_bounds_of_another_number_are_refused() -> None:
    tree = tree_of(boxes((0, 0, 1, 1)), [DYNAMIC])
    with pytest.raises(ValueError, match="2"):
        tree.update(boxes((0, 0, 1, 1), (0, 0, 1, 1)))


def test_same_pairs_without_compilation() -> None:
    root = Path(engine.__file__).parents[1]
    environment = {**os.environ, "PYTHONPATH": str(root), "NUMBA_DISABLE_JIT": "1"}
    environment.pop("NUMBA_JIT_COVERAGE", None)
    output = subprocess.run(
        [sys.executable, crowd_module.__file__], env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert json.loads(output) == json.loads(json.dumps(crowd_module.history()))
