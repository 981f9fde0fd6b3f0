"""Helpers for lanes: their meaning, and that they never change the width of a number.

That eight lanes mean the same as one, whatever the numbers: tests/engine/test_simd.py.
"""

from __future__ import annotations

import numpy as np
import pytest
from numba.core import types

from engine import lanes
from engine.jit import kernel
from engine.rows import at
from engine.simd import WIDTH, Lanes, mask
from tests.engine.eights import as_block

pytestmark = pytest.mark.kernel

REALS = (np.float32, np.float64)


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


@pytest.mark.parametrize("real", REALS)
def test_const_is_of_the_lanes_width(real: type) -> None:
    table = np.zeros(2, real)
    tenth(table)
    assert table[1] == real(0.1)
    assert type(lanes.const(0.1, real(1.0))) is real


@kernel
def counted(table):
    table[1] = lanes.const(2.75, table[0])


@pytest.mark.parametrize("whole", [np.int32, np.int64])
def test_const_of_whole_numbers_cuts(whole: type) -> None:
    table = np.zeros(2, whole)
    counted(table)
    assert table[1] == 2
    assert type(lanes.const(7.0, whole(1))) is whole


def test_const_refuses_what_is_no_lane() -> None:
    for stranger in (types.boolean, types.complex64, types.none, mask):
        assert lanes._const(types.float64, stranger) is None
    assert lanes._const(types.float64, Lanes(types.float32)) is not None


def test_const_outside_kernels_is_as_inside() -> None:
    eight = np.arange(8.0)
    single = lanes.const(eight, np.float32(0))
    assert single.dtype == np.float32
    assert lanes.const(0.1, single) == np.float32(0.1)
    assert type(lanes.const(0.1, single)) is np.float32


@kernel
def said_to_all(given, number):
    row = at(given, 0)
    row.b = lanes.const(0.1, row.a)
    row.a = lanes.const(number, row.a)


@pytest.mark.parametrize("real", REALS)
def test_const_is_said_to_all_eight(real: type) -> None:
    given = as_block({name: np.zeros(WIDTH, real) for name in "ab"})
    said_to_all(given, 2.3)
    assert given["b"][0].tolist() == [real(0.1)] * WIDTH
    assert given["a"][0].tolist() == [real(2.3)] * WIDTH


@kernel
def divided(a, b):
    return lanes.over(a, b)


@np.errstate(all="ignore")
@pytest.mark.parametrize("real", REALS)
def test_over_what_is_nothing(real: type) -> None:
    assert divided(real(3), real(2)) == 1.5
    for zero in (0.0, -0.0):
        for a in (1.0, 0.0, np.inf, np.nan):
            assert divided(real(a), real(zero)) == 0.0
    assert divided(real(1), real(np.inf)) == 0.0
    assert divided(real(-1), np.finfo(real).tiny * real(0.25)) < -1e37, "a tiny number is no zero"
    assert np.isnan(divided(real(1), real(np.nan)))


@kernel
def truths(a, b):
    return lanes.holds_somewhere(a > b), lanes.select(a > b, a, b), lanes.sqrt(b)


def test_one_lane_is_somewhere() -> None:
    assert truths(2.0, 1.0) == (True, 2.0, 1.0)
    assert truths(1.0, 4.0) == (False, 4.0, 2.0)
    assert truths(np.nan, 4.0) == (False, 4.0, 2.0)
    assert type(lanes.holds_somewhere(np.array([False, True]))) is bool


@pytest.mark.parametrize("real", REALS)
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
