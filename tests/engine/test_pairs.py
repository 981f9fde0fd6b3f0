"""Which pairs of near shapes become arbiters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import SHAPE_KINDS
from engine.narrow_phase import COLLIDER_OF
from engine.pairs import drop_joined, is_listed, may_touch
from engine.tables import BODY, SHAPE, empty

pytestmark = pytest.mark.kernel

pairs = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), max_size=20)
OWNERS = np.array([3, 1, 4, 0, 3, 2, 2, 1, 0, 4])  # rows of the bodies of ten shapes


@settings(max_examples=150, deadline=None)
@given(listed=pairs, asked=pairs)
def test_same_as_a_set(listed: list, asked: list) -> None:
    table = np.array(sorted(set(listed)), np.int64).reshape(-1, 2)
    for first, second in asked + listed:
        assert is_listed(table, first, second) == ((first, second) in set(listed))


def as_table(found: list, extra: int) -> np.ndarray:
    """The pairs, and rows behind them that do not count."""
    return np.array(found + [(0, 0)] * extra, np.int64).reshape(-1, 2)


@settings(max_examples=100, deadline=None)
@given(found=pairs, listed=st.sets(st.tuples(st.integers(0, 4), st.integers(0, 4))), extra=st.integers(0, 3))
def test_joined_bodies_are_dropped_and_the_rest_keeps_its_order(found: list, listed: set, extra: int) -> None:
    # rows of shapes, rows of bodies and serials all differ, and a pair comes in either order
    shapes, bodies = empty(10, SHAPE), empty(5, BODY)
    shapes["body"] = OWNERS
    bodies["serial"] = serials = np.array([14, 11, 30, 12, 29])
    table = sorted({(min(pair), max(pair)) for pair in ((int(serials[a]), int(serials[b])) for a, b in listed)})
    written = as_table(found, extra)
    kept = drop_joined(written, len(found), shapes, bodies, np.array(table, np.int64).reshape(-1, 2))
    joined = [{int(serials[OWNERS[a]]), int(serials[OWNERS[b]])} for a, b in found]
    asked = [set(pair) for pair in table]
    expected = [list(pair) for pair, owners in zip(found, joined, strict=True) if owners not in asked]
    assert written[:kept].tolist() == expected


@settings(max_examples=100, deadline=None)
@given(found=pairs, kinds=st.lists(st.integers(0, 5), min_size=10, max_size=10))
def test_shapes_of_one_body_and_two_lines_never_touch(found: list, kinds: list) -> None:
    shapes = empty(10, SHAPE)
    shapes["body"], shapes["kind"] = OWNERS, kinds
    lines = {SHAPE_KINDS.index("segment"), SHAPE_KINDS.index("chain")}
    for a, b in found:
        expected = OWNERS[a] != OWNERS[b] and not {kinds[a], kinds[b]} <= lines
        assert may_touch(shapes[a], shapes[b], COLLIDER_OF) == expected


def test_every_two_shapes_meet_but_lines() -> None:
    lines = {"segment", "chain"}
    for i, first in enumerate(SHAPE_KINDS):
        for j, second in enumerate(SHAPE_KINDS):
            assert (COLLIDER_OF[i, j] < 0) == ({first, second} <= lines), (first, second)
            assert COLLIDER_OF[i, j] == COLLIDER_OF[j, i]
