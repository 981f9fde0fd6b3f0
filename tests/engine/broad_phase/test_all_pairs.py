"""Broad phases against comparing every pair: each one there is must pass all of this."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine import BROAD_PHASES
from tests.naive.broad_phase import overlapping_pairs

pytestmark = [pytest.mark.kernel, pytest.mark.parametrize("find_pairs", BROAD_PHASES.values(), ids=BROAD_PHASES)]

Finder = Callable[..., int]


def call(find_pairs: Finder, bounds: np.ndarray, fixed: np.ndarray, capacity: int) -> tuple[int, np.ndarray]:
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
def test_same_pairs_as_comparing_all(find_pairs, count, spread, fixed_share, seed) -> None:
    rng = np.random.default_rng(seed)
    bounds = random_bounds(rng, count, spread)
    fixed = (rng.random(count) < fixed_share).astype(np.uint8)
    expected = overlapping_pairs(bounds, fixed)
    found, pairs = call(find_pairs, bounds, fixed, count * count)
    assert [tuple(pair) for pair in pairs[:found].tolist()] == expected, "pairs must ascend by (i, j), i < j"


@settings(max_examples=60, deadline=None)
@given(count=st.integers(2, 30), capacity=st.integers(0, 50), seed=st.integers(0, 2**32 - 1))
def test_overflow_is_counted_not_written(find_pairs, count, capacity, seed) -> None:
    bounds = random_bounds(np.random.default_rng(seed), count, 6)
    fixed = np.zeros(count, np.uint8)
    expected = overlapping_pairs(bounds, fixed)
    guarded = np.full((capacity + 4, 2), -7, np.int64)
    scratch = np.zeros((count + 7) // 8 * 8, np.uint8)
    assert find_pairs(bounds, fixed, scratch, guarded[:capacity]) == len(expected)
    assert (guarded[capacity:] == -7).all()
    if len(expected) <= capacity:
        assert guarded[: len(expected)].tolist() == [list(pair) for pair in expected]


def test_boxes_that_share_a_corner_meet(find_pairs) -> None:
    bounds = np.array([[0, 0, 1, 1], [1, 1, 2, 2], [2.0000002, 1, 3, 2]], np.float32).T.copy()
    found, pairs = call(find_pairs, bounds, np.zeros(3, np.uint8), 9)
    assert pairs[:found].tolist() == [[0, 1]]


def test_two_fixed_bodies_never_meet(find_pairs) -> None:
    bounds = np.tile(np.array([[0], [0], [1], [1]], np.float32), 12)
    found, pairs = call(find_pairs, bounds, np.array([1] * 10 + [0, 1], np.uint8), 200)
    assert found == 11
    assert all(10 in pair for pair in pairs[:found].tolist())
