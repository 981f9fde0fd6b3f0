"""The talk's broad phase against comparing every pair; and what each broad phase there is owes the step."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine import BROAD_PHASES
from engine.broad_phase.all_pairs import AllPairs, find_pairs
from tests.naive.broad_phase import overlapping_pairs

pytestmark = pytest.mark.kernel

STATIC, DYNAMIC, KINEMATIC = range(3)


def call(bounds: np.ndarray, fixed: np.ndarray, capacity: int) -> tuple[int, np.ndarray]:
    scratch = np.full((len(fixed) + 7) // 8 * 8, 255, np.uint8)  # of a step before
    pairs = np.full((capacity, 2), -1, np.int64)
    return find_pairs(bounds, fixed, scratch, pairs), pairs


def random_bounds(rng: np.random.Generator, count: int, spread: int) -> np.ndarray:
    """Corners at whole numbers, so that many boxes just touch."""
    lower = rng.integers(0, spread, (2, count))
    return np.concatenate([lower, lower + rng.integers(0, 4, (2, count))]).astype(np.float32)


@settings(max_examples=200, deadline=None)
@given(
    count=st.one_of(st.sampled_from([0, 1, 2, 7, 8, 9, 15, 16, 17, 23, 24, 25]), st.integers(0, 40)),
    spread=st.integers(1, 40),
    fixed_share=st.sampled_from([0.0, 0.3, 1.0]),
    seed=st.integers(0, 2**32 - 1),
)
@example(count=8, spread=1, fixed_share=0.0, seed=0)
@example(count=9, spread=1, fixed_share=0.5, seed=0)
def test_same_pairs_as_comparing_all(count, spread, fixed_share, seed) -> None:
    rng = np.random.default_rng(seed)
    bounds = random_bounds(rng, count, spread)
    fixed = (rng.random(count) < fixed_share).astype(np.uint8)
    expected = overlapping_pairs(bounds, fixed)
    found, pairs = call(bounds, fixed, count * count)
    assert [tuple(pair) for pair in pairs[:found].tolist()] == expected, "pairs must ascend by (i, j), i < j"


@settings(max_examples=60, deadline=None)
@given(count=st.integers(2, 30), capacity=st.integers(0, 50), seed=st.integers(0, 2**32 - 1))
def test_overflow_is_counted_not_written(count, capacity, seed) -> None:
    bounds = random_bounds(np.random.default_rng(seed), count, 6)
    fixed = np.zeros(count, np.uint8)
    expected = overlapping_pairs(bounds, fixed)
    guarded = np.full((capacity + 4, 2), -7, np.int64)
    scratch = np.zeros((count + 7) // 8 * 8, np.uint8)
    assert find_pairs(bounds, fixed, scratch, guarded[:capacity]) == len(expected)
    assert (guarded[capacity:] == -7).all()
    if len(expected) <= capacity:
        assert guarded[: len(expected)].tolist() == [list(pair) for pair in expected]


def test_boxes_that_share_a_corner_meet() -> None:
    bounds = np.array([[0, 0, 1, 1], [1, 1, 2, 2], [2.0000002, 1, 3, 2]], np.float32).T.copy()
    found, pairs = call(bounds, np.zeros(3, np.uint8), 9)
    assert pairs[:found].tolist() == [[0, 1]]


def test_two_fixed_bodies_never_meet() -> None:
    bounds = np.tile(np.array([[0], [0], [1], [1]], np.float32), 12)
    found, pairs = call(bounds, np.array([1] * 10 + [0, 1], np.uint8), 200)
    assert found == 11
    assert all(10 in pair for pair in pairs[:found].tolist())


# --- every broad phase ------------------------------------------------------------------------------------------------

every = pytest.mark.parametrize("name", BROAD_PHASES)


def made(name: str, rows: np.ndarray, groups: np.ndarray) -> Any:
    phase = BROAD_PHASES[name]()
    phase.sync(rows, 10 + 3 * np.arange(len(rows)), groups.astype(np.uint8))
    return phase


def pairs_of(phase: Any) -> list[tuple[int, int]]:
    return [(int(first), int(second)) for first, second in phase.pairs[: phase.pair_count]]


@every
@settings(max_examples=60, deadline=None)
@given(count=st.integers(0, 30), spread=st.integers(2, 30), seed=st.integers(0, 2**32 - 1), moves=st.integers(0, 3))
def test_what_overlaps_is_among_the_pairs_in_the_order_of_creation(name, count, spread, seed, moves) -> None:
    rng = np.random.default_rng(seed)
    rows, groups = rng.permutation(40)[:count], rng.integers(0, 3, count)
    phase = made(name, rows, groups)
    bounds = random_bounds(rng, count, spread)
    before = None
    for _ in range(moves + 1):
        changed = phase.update(bounds)
        found = pairs_of(phase)
        if before is None or found != before:
            assert changed or found == []
        else:
            assert not changed
        ranks = {int(row): rank for rank, row in enumerate(rows)}
        ordered = [(ranks[first], ranks[second]) for first, second in found]
        assert ordered == sorted(set(ordered))
        assert all(first < second for first, second in ordered)
        assert all(DYNAMIC in (groups[first], groups[second]) for first, second in ordered)
        expected = overlapping_pairs(bounds, groups != DYNAMIC)
        assert set(expected) <= set(ordered)
        if name == "all_pairs":
            assert ordered == expected
        fat = phase.fat_bounds()
        assert fat.shape == (count, 4)
        assert (fat[:, :2] <= bounds[:2].T).all()
        assert (fat[:, 2:] >= bounds[2:].T).all()
        before = found
        bounds = (bounds + np.tile(rng.integers(-2, 3, (2, count)), (2, 1))).astype(np.float32)


@every
def test_the_same_rows_with_other_groups_are_other_pairs(name: str) -> None:
    rows = np.array([4, 1, 2])
    bounds = np.tile(np.array([[0], [0], [1], [1]], np.float32), 3)
    phase = made(name, rows, np.array([DYNAMIC, STATIC, KINEMATIC]))
    assert phase.update(bounds)
    assert pairs_of(phase) == [(4, 1), (4, 2)]
    phase.sync(rows, 10 + 3 * np.arange(3), np.array([STATIC, STATIC, DYNAMIC], np.uint8))
    assert phase.update(bounds)
    assert pairs_of(phase) == [(4, 2), (1, 2)]


def test_more_pairs_than_any_first_capacity() -> None:
    phase = AllPairs()
    phase.sync(np.arange(60), np.arange(60), np.ones(60, np.uint8))
    assert phase.update(np.tile(np.array([[0], [0], [1], [1]], np.float32), 60))
    assert phase.pair_count == 60 * 59 // 2
