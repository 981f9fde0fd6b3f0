"""Sine and cosine against sixty exact digits."""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine.trigonometry import HALF_PI_1, HALF_PI_2, HALF_PI_3, cos_sin
from tests.naive.trigonometry import PI, ulps_off
from tests.naive.trigonometry import cos_sin as exact_cos_sin

pytestmark = pytest.mark.kernel

ULPS = 0.75


def assert_exact(angle: float) -> None:
    for value, exact in zip(cos_sin(angle), exact_cos_sin(angle), strict=True):
        assert ulps_off(float(value), exact) <= ULPS


@settings(max_examples=400, deadline=None)
@given(angle=st.floats(-1e6, 1e6))
@example(angle=5e-324)
@example(angle=1e-160)
@example(angle=math.pi / 4)
def test_within_three_quarters_of_an_ulp(angle: float) -> None:
    assert_exact(angle)


@settings(max_examples=300, deadline=None)
@given(quarters=st.integers(-600_000, 600_000), ulps=st.integers(-3, 3))
@example(quarters=1, ulps=0)
@example(quarters=594_473, ulps=0)
def test_just_beside_the_zeros(quarters: int, ulps: int) -> None:
    angle = float(quarters * PI / 2)
    assert_exact(angle + ulps * math.ulp(angle))


@settings(max_examples=200, deadline=None)
@given(angle=st.floats(allow_nan=False, allow_infinity=False))
@example(angle=1e300)
@example(angle=-1.7976931348623157e308)
@example(angle=1e7)
@example(angle=4e15)
def test_bounded_whatever_the_angle(angle: float) -> None:
    c, s = cos_sin(angle)
    assert abs(c) <= 1.0
    assert abs(s) <= 1.0
    assert c * c + s * s == pytest.approx(1.0, abs=1e-15)


def test_axes_are_exact() -> None:
    assert cos_sin(0.0) == (1.0, 0.0)
    assert math.copysign(1.0, cos_sin(0.0)[1]) == 1.0


@settings(max_examples=100, deadline=None)
@given(angle=st.floats(-1e6, 1e6))
def test_even_and_odd(angle: float) -> None:
    assert cos_sin(-angle)[0] == cos_sin(angle)[0]
    assert cos_sin(-angle)[1] == -cos_sin(angle)[1]


def test_reduction_is_exact() -> None:
    # k times either of the first two parts of pi/2 must fit in 53 bits for |k| < 2^20
    for part in (HALF_PI_1, HALF_PI_2):
        mantissa = int(math.frexp(part)[0] * 2**53)
        assert mantissa % 2**20 == 0
    error = abs(sum(Decimal(part) for part in (HALF_PI_1, HALF_PI_2, HALF_PI_3)) - PI / 2)
    assert error < 1e-36


def test_float64_whatever_the_precision() -> None:
    c, s = cos_sin(np.float64(0.3))
    assert isinstance(c, float)
    assert isinstance(s, float)
