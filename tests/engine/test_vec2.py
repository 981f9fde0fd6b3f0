"""Vec2: the same operators outside kernels and inside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.jit import kernel
from engine.rows import at
from engine.simd import WIDTH
from engine.vec2 import Vec2, choose, cross, dot, right_of, rotate, spin, unrotate
from tests.engine.eights import REALS, as_block, as_rows, bits, floats

pytestmark = pytest.mark.kernel

real = st.floats(-1e3, 1e3)
vector = st.builds(Vec2, real, real)


@kernel
def compiled(a, b, scale):
    return a + b, a - b, a * scale, scale * a, -a


@settings(max_examples=50, deadline=None)
@given(a=vector, b=vector, scale=real)
def test_operators_mean_the_same_in_kernels(a: Vec2, b: Vec2, scale: float) -> None:
    expected = (
        (a[0] + b[0], a[1] + b[1]),
        (a[0] - b[0], a[1] - b[1]),
        (a[0] * scale, a[1] * scale),
        (scale * a[0], scale * a[1]),
        (-a[0], -a[1]),
    )
    assert compiled(a, b, scale) == expected
    assert (a + b, a - b, a * scale, scale * a, -a) == expected


@settings(max_examples=50, deadline=None)
@given(a=vector, b=vector, w=real)
def test_products(a: Vec2, b: Vec2, w: float) -> None:
    assert dot(a, b) == a[0] * b[0] + a[1] * b[1]
    assert cross(a, b) == a[0] * b[1] - a[1] * b[0]
    assert dot(right_of(a), a) == 0.0
    assert cross(a, right_of(a)) == -dot(a, a)  # -90 degrees: x turns into -y
    assert dot(spin(w, a), a) == pytest.approx(0.0, abs=1e-6)
    assert cross(a, spin(w, a)) == pytest.approx(w * dot(a, a), rel=1e-12, abs=1e-300)


@settings(max_examples=50, deadline=None)
@given(a=vector, angle=st.floats(-10, 10))
def test_rotation(a: Vec2, angle: float) -> None:
    q = Vec2(np.cos(angle), np.sin(angle))
    turned = complex(*a) * np.exp(1j * angle)
    assert tuple(rotate(q, a)) == pytest.approx((turned.real, turned.imag), abs=1e-9)
    assert tuple(unrotate(q, rotate(q, a))) == pytest.approx(tuple(a), abs=1e-9)


def test_numpy_leaves_operators_to_vec2() -> None:
    a = Vec2(1.0, 2.0)
    assert np.float64(2.0) * a == Vec2(2.0, 4.0)
    assert isinstance(np.float32(2.0) * a, Vec2)
    assert isinstance(a * np.float64(2.0), Vec2)
    assert a == (1.0, 2.0)


def test_arrays_and_pairs_outside_kernels() -> None:
    a, array, pair = Vec2(1.0, 2.0), np.array([10.0, 20.0]), (1, 1)
    assert (a + array).tolist() == (array + a).tolist() == [11.0, 22.0]
    assert (a - array).tolist() == [-9.0, -18.0]
    assert (array - a).tolist() == [9.0, 18.0]
    assert a + pair == Vec2(2.0, 3.0)
    assert a - pair == Vec2(0.0, 1.0)


@kernel
def in_single(a, scale, table):
    b = a * scale + (-a - a)
    table[0] = b.x
    return b.x


def test_single_stays_single() -> None:
    a, table = Vec2(np.float32(0.1), np.float32(0.2)), np.zeros(1, np.float32)
    in_single(a, np.float32(0.3), table)
    assert table[0] == np.float32(0.1) * np.float32(0.3) + (-np.float32(0.1) - np.float32(0.1))


PAIRS = ("sum", "difference", "scaled", "from_scale", "negative", "chosen", "spun", "right", "turned", "back")
NUMBERS = ("dot", "cross")


@kernel
def in_lanes(given, results, k, number):
    """Everything that vectors can do, on one or on eight; `number` is one in either case."""
    row, out = at(given, k), at(results, k)
    a, b, s = Vec2(row.ax, row.ay), Vec2(row.bx, row.by), row.s
    p = a + b
    out.sum_x, out.sum_y = p.x, p.y
    p = a - b
    out.difference_x, out.difference_y = p.x, p.y
    p = a * s
    out.scaled_x, out.scaled_y = p.x, p.y
    p = number * b
    out.from_scale_x, out.from_scale_y = p.x, p.y
    p = -a
    out.negative_x, out.negative_y = p.x, p.y
    p = choose(s > 0, a, b)
    out.chosen_x, out.chosen_y = p.x, p.y
    p = spin(s, a)
    out.spun_x, out.spun_y = p.x, p.y
    p = right_of(a)
    out.right_x, out.right_y = p.x, p.y
    p = rotate(a, b)
    out.turned_x, out.turned_y = p.x, p.y
    p = unrotate(a, b)
    out.back_x, out.back_y = p.x, p.y
    out.dot = dot(a, b)
    out.cross = cross(a, b)


@pytest.mark.parametrize("real", REALS)
@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_eight_vectors_are_eight_times_one(real: type, data: st.DataObject) -> None:
    columns = {name: data.draw(floats(real)) for name in ("ax", "ay", "bx", "by", "s")}
    ax, ay, bx, by, s = columns.values()
    number = real(data.draw(st.floats(-10, 10, width=32)))
    with np.errstate(all="ignore"):
        expected = dict(
            zip(
                PAIRS,
                (
                    (ax + bx, ay + by), (ax - bx, ay - by), (ax * s, ay * s), (number * bx, number * by), (-ax, -ay),
                    (np.where(s > 0, ax, bx), np.where(s > 0, ay, by)), (-s * ay, s * ax), (ay, -ax),
                    (ax * bx - ay * by, ay * bx + ax * by), (ax * bx + ay * by, ax * by - ay * bx),
                ),
                strict=True,
            )
        )  # fmt: skip
        numbers = dict(zip(NUMBERS, (ax * bx + ay * by, ax * by - ay * bx), strict=True))
    for name, (x, y) in expected.items():
        numbers |= {f"{name}_x": x, f"{name}_y": y}
    nothing = {name: np.zeros(WIDTH, real) for name in numbers}
    at_once, one_by_one = as_block(nothing), as_rows(nothing)
    block, rows = as_block(columns), as_rows(columns)
    with np.errstate(all="ignore"):
        in_lanes(block, at_once, 0, number)
        for k in range(WIDTH):
            in_lanes(rows, one_by_one, k, number)
    for name, right in numbers.items():
        assert bits(at_once[name][0]) == bits(right), f"{name} of eight"
        assert bits(one_by_one[name]) == bits(right), f"{name} of one"
