"""Looking up pairs that do not collide."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.ignored import drop_ignored, is_listed
from engine.tables import BODY, empty

pytestmark = pytest.mark.kernel

pairs = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), max_size=20)


@settings(max_examples=150, deadline=None)
@given(listed=pairs, asked=pairs)
def test_same_as_a_set(listed: list, asked: list) -> None:
    table = np.array(sorted(set(listed)), np.int64).reshape(-1, 2)
    for first, second in asked + listed:
        assert is_listed(table, first, second) == ((first, second) in set(listed))


@settings(max_examples=100, deadline=None)
@given(found=pairs, listed=pairs, extra=st.integers(0, 3))
def test_the_rest_keeps_its_order(found: list, listed: list, extra: int) -> None:
    # ranks, rows and serials all differ
    order = np.array([3, 1, 4, 0, 5, 9, 2, 6, 8, 7])
    bodies = empty(10, BODY)
    for rank, row in enumerate(order):
        bodies["serial"][row] = 10 + 3 * rank
    table = np.array(sorted({(10 + 3 * i, 10 + 3 * j) for i, j in listed}), np.int64).reshape(-1, 2)
    written = np.array(found + [(0, 0)] * extra, np.int64).reshape(-1, 2)
    expected = [list(pair) for pair in found if pair not in set(listed)]
    kept = drop_ignored(written, len(found), order, bodies, table)
    assert written[:kept].tolist() == expected
