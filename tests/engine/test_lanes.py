"""Helpers for lanes: their meaning, and that they never change the width of a number."""

from __future__ import annotations

import numpy as np
import pytest
from numba.core import types

from engine import lanes
from engine.jit import kernel

pytestmark = pytest.mark.kernel

WIDTHS = (np.float32, np.float64)


@kernel
def tenth(table):
    table[1] = lanes.const(0.1, table[0])


@kernel
def all_of_them(a, b, table):
    table[0] = lanes.minimum(a, b)
    table[1] = lanes.maximum(a, b)
    table[2] = lanes.clamp(a, -b, b)
    table[3] = lanes.absolute(a)
    table[4] = lanes.select(a > b, a, b)


@pytest.mark.parametrize("real", WIDTHS)
def test_const_is_of_the_lanes_width(real: type) -> None:
    table = np.zeros(2, real)
    tenth(table)
    assert table[1] == real(0.1)
    assert type(lanes.const(0.1, real(1.0))) is real


def test_const_refuses_what_is_no_lane() -> None:
    assert lanes._const(types.float64, types.int64) is None


@pytest.mark.parametrize("real", WIDTHS)
@pytest.mark.parametrize(("a", "b"), [(1.5, 2.5), (-1.5, 0.5), (3.0, 2.0), (2.0, 2.0), (-0.0, 1.0)])
def test_meaning(real: type, a: float, b: float) -> None:
    table = np.zeros(5, real)
    all_of_them(real(a), real(b), table)
    assert table.tolist() == [min(a, b), max(a, b), max(-b, min(a, b)), abs(a), max(a, b)]


def test_ties_and_nan() -> None:
    # equal but not the same: zeros of either sign. The second one is kept, as for x86's own minimum and maximum.
    table = np.zeros(5)
    all_of_them(-0.0, 0.0, table)
    assert np.signbit(table).tolist()[:2] == [False, False]
    all_of_them(0.0, -0.0, table)
    assert np.signbit(table).tolist()[:2] == [True, True]
    all_of_them(np.nan, 1.0, table)
    assert table[:2].tolist() == [1.0, 1.0]
