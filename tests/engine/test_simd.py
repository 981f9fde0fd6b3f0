"""Eight lanes: each is, bit by bit, what numpy says and what the same kernel says of one number."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.core import types
from numba.core.errors import TypingError

from engine import lanes
from engine.jit import kernel
from engine.lanes import bits_of, const, eight_of, holds_somewhere, select, whole
from engine.rows import at
from engine.simd import WIDTH, Lanes, Mask, common, fits, mask
from engine.tables import empty
from tests.engine.eights import REALS, as_block, as_rows, bits, floats

plain_too = pytest.mark.kernel
every_real = pytest.mark.parametrize("real", REALS)

ARITHMETIC = (
    "sum", "difference", "product", "quotient", "negative", "root", "chained",
    "least", "most", "clamped", "size", "over", "chosen",
    "with_real", "from_real", "real_over", "with_whole", "from_whole",
)  # fmt: skip
COMPARISONS = ("lt", "le", "gt", "ge", "eq", "ne", "both", "either", "real", "whole")


@kernel
def compute(given, results, k, number):
    """One block or one row: the text does not say which."""
    row, out = at(given, k), at(results, k)
    a, b, c = row.a, row.b, row.c
    out.sum = a + b
    out.difference = a - b
    out.product = a * b
    out.quotient = a / b
    out.negative = -a
    out.root = lanes.sqrt(a)
    chained = a + b
    chained += c
    chained *= a
    chained -= b
    chained /= c
    out.chained = chained
    out.least = lanes.minimum(a, b)
    out.most = lanes.maximum(a, b)
    out.clamped = lanes.clamp(a, b, c)
    out.size = lanes.absolute(a)
    out.over = lanes.over(a, b)
    out.chosen = select(a < b, b, c)
    out.with_real = a + number
    out.from_real = number - a
    out.real_over = number / a
    out.with_whole = a * 3
    out.from_whole = 7 - a


@kernel
def compare(given, results, k, number):
    row, out = at(given, k), at(results, k)
    a, b, c = row.a, row.b, row.c
    yes, no = const(1.0, a), const(0.0, a)
    out.lt = select(a < b, yes, no)
    out.le = select(a <= b, yes, no)
    out.gt = select(a > b, yes, no)
    out.ge = select(a >= b, yes, no)
    out.eq = select(a == b, yes, no)
    out.ne = select(a != b, yes, no)
    out.both = select((a < b) & (b < c), yes, no)
    out.either = select((a < b) | (b < c), yes, no)
    out.real = select(number < a, yes, no)
    out.whole = select(a > 0, yes, no)


def expected_numbers(a: np.ndarray, b: np.ndarray, c: np.ndarray, number: Any) -> dict[str, np.ndarray]:
    """What `compute` must give, said by numpy."""
    less = np.where(a < c, a, c)
    return {
        "sum": a + b,
        "difference": a - b,
        "product": a * b,
        "quotient": a / b,
        "negative": -a,
        "root": np.sqrt(a),
        "chained": (((a + b) + c) * a - b) / c,
        "least": np.where(a < b, a, b),
        "most": np.where(a > b, a, b),
        "clamped": np.where(b > less, b, less),
        "size": np.where(a > 0, a, -a),
        "over": np.where(b == 0, 0, a / b).astype(a.dtype),
        "chosen": np.where(a < b, b, c),
        "with_real": a + number,
        "from_real": number - a,
        "real_over": number / a,
        "with_whole": a * 3,
        "from_whole": 7 - a,
    }


def expected_truths(a: np.ndarray, b: np.ndarray, c: np.ndarray, number: Any) -> dict[str, np.ndarray]:
    """What `compare` must give."""
    truths = {
        "lt": a < b, "le": a <= b, "gt": a > b, "ge": a >= b, "eq": a == b, "ne": a != b,
        "both": (a < b) & (b < c), "either": (a < b) | (b < c), "real": number < a, "whole": a > 0,
    }  # fmt: skip
    return {name: truth.astype(a.dtype) for name, truth in truths.items()}


def run_both(function: Any, expected: dict[str, np.ndarray], *numbers: Any, **columns: np.ndarray) -> None:
    """Runs a kernel on eight rows, and on one block of eight: both must be what is expected."""
    fields = {name: np.zeros_like(column) for name, column in expected.items()}
    one_by_one, at_once = as_rows(fields), as_block(fields)
    narrow, block = as_rows(columns), as_block(columns)
    with np.errstate(all="ignore"):
        for k in range(WIDTH):
            function(narrow, one_by_one, k, *numbers)
        function(block, at_once, 0, *numbers)
    for name, right in expected.items():
        assert bits(at_once[name][0]) == bits(right), f"{name} of eight"
        assert bits(one_by_one[name]) == bits(right), f"{name} of one"


@plain_too
@every_real
@settings(max_examples=60)
@given(data=st.data())
def test_arithmetic(real: type, data: st.DataObject) -> None:
    a, b, c = (data.draw(floats(real)) for _ in range(3))
    number = floats(real).map(lambda numbers: numbers[0])
    value = data.draw(number)
    with np.errstate(all="ignore"):
        expected = expected_numbers(a, b, c, value)
    assert tuple(expected) == ARITHMETIC
    run_both(compute, expected, value, a=a, b=b, c=c)


@plain_too
@every_real
@settings(max_examples=60)
@given(data=st.data())
def test_comparison(real: type, data: st.DataObject) -> None:
    a, b, c = (data.draw(floats(real)) for _ in range(3))
    equal = data.draw(st.lists(st.booleans(), min_size=WIDTH, max_size=WIDTH))
    b = np.where(equal, a, b)
    value = real(data.draw(st.sampled_from([0.0, -0.0, 1.0, np.nan, np.inf])))
    expected = expected_truths(a, b, c, value)
    assert tuple(expected) == COMPARISONS
    run_both(compare, expected, value, a=a, b=b, c=c)


@plain_too
@every_real
def test_nan_and_zeros(real: type) -> None:
    a = np.array([np.nan, np.nan, 1, 0.0, -0.0, -0.0, np.inf, -np.inf], real)
    b = np.array([np.nan, 1, np.nan, -0.0, 0.0, -0.0, np.inf, np.inf], real)
    out = as_block({name: np.zeros(WIDTH, real) for name in COMPARISONS})
    compare(as_block({"a": a, "b": b, "c": b}), out, 0, real(0.0))
    assert out["lt"][0].tolist() == [0, 0, 0, 0, 0, 0, 0, 1]
    assert out["ge"][0].tolist() == [0, 0, 0, 1, 1, 1, 1, 0]
    assert out["eq"][0].tolist() == [0, 0, 0, 1, 1, 1, 1, 0]
    assert out["ne"][0].tolist() == [1, 1, 1, 0, 0, 0, 0, 1]
    signs = as_block({name: np.zeros(WIDTH, real) for name in ARITHMETIC})
    with np.errstate(all="ignore"):
        compute(as_block({"a": a, "b": b, "c": b}), signs, 0, real(1.0))
    assert np.signbit(signs["negative"][0][3:6]).tolist() == [True, False, False]
    assert np.signbit(signs["root"][0][3:6]).tolist() == [False, True, True], "as IEEE 754 says"
    assert np.signbit(signs["least"][0][3:6]).tolist() == [True, False, True], "the second one where they are equal"


# --- whole numbers ---------------------------------------------------------------------------------------------------


@kernel
def compute_whole(given, results, k, number):
    row, out = at(given, k), at(results, k)
    a, b = row.a, row.b
    out.sum = a + b
    out.difference = a - b
    out.product = a * b
    out.negative = -a
    out.with_number = a + number
    out.lt = select(a < b, const(1, a), const(0, a))
    out.eq = select(a == b, const(1, a), const(0, a))
    out.ge = select(a >= 2, a, b)


@plain_too
@pytest.mark.parametrize("whole", [np.int32, np.int64])
@settings(max_examples=30)
@given(data=st.data())
def test_whole_numbers(whole: type, data: st.DataObject) -> None:
    size = 2 ** (np.iinfo(whole).bits // 2 - 2)  # no overflow: numpy warns of it, and nobody needs it
    numbers = st.lists(st.integers(-size, size) | st.integers(-2, 2), min_size=WIDTH, max_size=WIDTH)
    a, b = (np.array(data.draw(numbers), whole) for _ in range(2))
    expected = {
        "sum": a + b, "difference": a - b, "product": a * b, "negative": -a, "with_number": a + whole(5),
        "lt": (a < b).astype(whole), "eq": (a == b).astype(whole), "ge": np.where(a >= 2, a, b),
    }  # fmt: skip
    run_both(compute_whole, expected, whole(5), a=a, b=b)


@kernel
def convert_all(given, results, k):
    """Every type to every other, by `const` and by assignment."""
    row, out = at(given, k), at(results, k)
    single, double, short, long = row.float32, row.float64, row.int32, row.int64
    out.double_of_single = const(single, double)
    out.single_of_double = const(double, single)
    out.short_of_single = const(single, short)
    out.short_of_double = const(double, short)
    out.long_of_double = const(double, long)
    out.single_of_short = const(short, single)
    out.single_of_long = const(long, single)
    out.double_of_short = const(short, double)
    out.double_of_long = const(long, double)
    out.short_of_long = const(long, short)
    out.long_of_short = const(short, long)
    out.assigned_single = double
    out.assigned_double = single
    out.assigned_from_whole = long


@plain_too
@settings(max_examples=60)
@given(data=st.data())
def test_conversions(data: st.DataObject) -> None:
    def eight(numbers: st.SearchStrategy, kind: type) -> np.ndarray:
        return np.array(data.draw(st.lists(numbers, min_size=WIDTH, max_size=WIDTH)), kind)

    # what does not fit a whole number has no defined value in one
    single = eight(st.floats(-(2.0**30), 2.0**30, width=32), np.float32)
    double = eight(st.floats(-(2.0**30), 2.0**30), np.float64)
    short = eight(st.integers(-(2**31), 2**31 - 1), np.int32)
    long = eight(st.integers(-(2**63), 2**63 - 1), np.int64)
    expected = {
        "double_of_single": single.astype(np.float64),
        "single_of_double": double.astype(np.float32),
        "short_of_single": single.astype(np.int32),
        "short_of_double": double.astype(np.int32),
        "long_of_double": double.astype(np.int64),
        "single_of_short": short.astype(np.float32),
        "single_of_long": long.astype(np.float32),
        "double_of_short": short.astype(np.float64),
        "double_of_long": long.astype(np.float64),
        "short_of_long": long.astype(np.int32),
        "long_of_short": short.astype(np.int64),
        "assigned_single": double.astype(np.float32),
        "assigned_double": single.astype(np.float64),
        "assigned_from_whole": long.astype(np.float64),
    }
    run_both(convert_all, expected, float32=single, float64=double, int32=short, int64=long)


@plain_too
@settings(max_examples=30)
@given(double=floats(np.float64), single=floats(np.float32))
def test_conversion_between_floats_keeps_what_is_no_number(double: np.ndarray, single: np.ndarray) -> None:
    nothing = {"int32": np.zeros(WIDTH, np.int32), "int64": np.zeros(WIDTH, np.int64)}
    given = as_block({"float32": single, "float64": double, **nothing})
    single = np.where(np.abs(single) < 2.0**30, single, 0)
    names = [
        "double_of_single", "single_of_double", "short_of_single", "short_of_double", "long_of_double",
        "single_of_short", "single_of_long", "double_of_short", "double_of_long", "short_of_long", "long_of_short",
        "assigned_single", "assigned_double", "assigned_from_whole",
    ]  # fmt: skip
    kinds = {"double": np.float64, "single": np.float32, "short": np.int32, "long": np.int64}
    kinds |= {"assigned_single": np.float32, "assigned_double": np.float64, "assigned_from_whole": np.float64}
    out = as_block({name: np.zeros(WIDTH, kinds.get(name, kinds.get(name.partition("_")[0]))) for name in names})
    with np.errstate(all="ignore"):
        convert_all(given, out, 0)
        assert bits(out["single_of_double"][0]) == bits(double.astype(np.float32))
        assert bits(out["assigned_single"][0]) == bits(double.astype(np.float32))
        assert bits(out["double_of_single"][0]) == bits(given["float32"][0].astype(np.float64))


@kernel
def cut(given, results, k):
    at(results, k).cut = whole(at(given, k).a)


@plain_too
@every_real
@settings(max_examples=40)
@given(data=st.data())
def test_fractions_are_cut_off(real: type, data: st.DataObject) -> None:
    numbers = st.floats(-(2.0**30), 2.0**30, width=32) | st.integers(-3, 3).map(float)
    a = np.array(data.draw(st.lists(numbers, min_size=WIDTH, max_size=WIDTH)), real)
    out, rows = as_block({"cut": np.zeros_like(a)}), as_rows({"cut": np.zeros_like(a)})
    cut(as_block({"a": a}), out, 0)
    for k in range(WIDTH):
        cut(as_rows({"a": a}), rows, k)
    assert out["cut"][0].tolist() == rows["cut"].tolist() == np.trunc(a).tolist()


# --- masks, loads, extraction ----------------------------------------------------------------------------------------


@kernel
def mask_logic(given, results, truth):
    row, out = at(given, 0), at(results, 0)
    a, b = row.a > 0, row.b > 0
    yes, no = const(1, row.a), const(0, row.a)
    out.neither = select(~(a | b), yes, no)
    out.one_only = select((a & ~b) | (b & ~a), yes, no)
    out.chosen = select(select(row.a > 1, a, b), yes, no)
    out.with_truth = select(a & truth, yes, no)
    out.or_truth = select(truth | b, yes, no)
    both = a & b
    both |= row.a > 1
    both &= row.b > 0
    out.chained = select(both, yes, no)
    out.numbers = select(a, 2, row.b)
    return (
        holds_somewhere(a),
        holds_somewhere(a & b),
        holds_somewhere(truth),
        bits_of(a),
        bits_of(~a | b),
        bits_of(truth),
    )


@plain_too
@pytest.mark.parametrize("truth", [True, False])
@settings(max_examples=30)
@given(numbers=st.lists(st.integers(0, 2), min_size=2 * WIDTH, max_size=2 * WIDTH))
def test_masks(truth: bool, numbers: list[int]) -> None:
    a, b = np.array(numbers, np.int32).reshape(2, WIDTH)
    expected = {
        "neither": ~((a > 0) | (b > 0)), "one_only": (a > 0) != (b > 0), "chosen": np.where(a > 1, a > 0, b > 0),
        "with_truth": (a > 0) & truth, "or_truth": (b > 0) | truth,
        "chained": (((a > 0) & (b > 0)) | (a > 1)) & (b > 0), "numbers": np.where(a > 0, 2, b),
    }  # fmt: skip
    out = as_block({name: np.zeros(WIDTH, np.int32) for name in expected})
    told = mask_logic(as_block({"a": a, "b": b}), out, truth)
    for name, right in expected.items():
        assert out[name][0].tolist() == right.astype(int).tolist(), name
    assert told[:3] == (bool(np.any(a > 0)), bool(np.any((a > 0) & (b > 0))), truth)
    assert told[3] == sum(2**lane for lane in range(WIDTH) if a[lane] > 0), "the first lane's bit is the lowest"
    assert told[4:] == (sum(2**lane for lane in range(WIDTH) if a[lane] == 0 or b[lane] > 0), int(truth))


@kernel
def pick_out(array, first, place, out):
    eight = eight_of(array, first)
    out[0] = eight[place]
    out[1] = eight[0]
    out[2] = eight[WIDTH - 1]
    over = eight > eight[place]
    return over[place], over[0], over[WIDTH - 1]


@plain_too
@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int32, np.int64])
def test_eight_are_loaded_from_anywhere_and_taken_apart(kind: type) -> None:
    array = (np.arange(40) * 7 % 41).astype(kind)
    for first in (0, 1, 3, 8, 32):  # whatever the alignment
        for place in range(WIDTH):
            out = np.zeros(3, kind)
            over = pick_out(array, first, place, out)
            eight = array[first : first + WIDTH]
            assert out.tolist() == [eight[place], eight[0], eight[-1]]
            assert over == (False, eight[0] > eight[place], eight[-1] > eight[place])


@plain_too
def test_a_loaded_vector_is_a_copy() -> None:
    array, out = np.arange(8.0), np.zeros(8)
    change_while_loaded(array, out)
    assert out.tolist() == list(range(8))


@kernel
def change_while_loaded(array, out):
    eight = eight_of(array, 0)
    array[:] = 0.0
    for place in range(WIDTH):
        out[place] = eight[place]


# --- what is refused -------------------------------------------------------------------------------------------------

SINGLE, DOUBLE, SHORT = Lanes(types.float32), Lanes(types.float64), Lanes(types.int32)


@plain_too
def test_what_may_meet() -> None:
    for number in (types.float32, types.int32, types.int64, types.literal(3)):
        assert fits(number, SINGLE)
        assert common(SINGLE, number) == common(number, SINGLE) == SINGLE
    for stranger in (types.float64, types.boolean, mask, DOUBLE, SHORT, types.complex64, types.none):
        assert common(SINGLE, stranger) is None
        assert common(stranger, SINGLE) is None
    assert common(types.float32, types.float32) is None, "two numbers are none of our business"
    assert Lanes(types.float32) == SINGLE != DOUBLE
    assert Mask() == mask


def test_a_double_number_is_refused_by_single_lanes() -> None:
    given = as_block({name: np.ones(WIDTH, np.float32) for name in "abc"})
    out = as_block({name: np.zeros(WIDTH, np.float32) for name in ARITHMETIC})
    with pytest.raises(TypingError):
        compute(given, out, 0, 1.0)


@numba.njit
def literal_in_lanes(given, results):
    at(results, 0).a = at(given, 0).a * 0.5


@numba.njit
def lanes_of_two_kinds(given, results):
    at(results, 0).a = at(given, 0).a + at(given, 0).b


@numba.njit
def divided_whole(given, results):
    at(results, 0).b = at(given, 0).b / at(given, 0).b


@numba.njit
def lanes_as_truth(given, results):
    if at(given, 0).a > 0:
        at(results, 0).a = at(given, 0).a


@pytest.mark.parametrize("wrong", [literal_in_lanes, lanes_of_two_kinds, divided_whole, lanes_as_truth])
def test_refusals(wrong: Any) -> None:
    given = as_block({"a": np.ones(WIDTH, np.float32), "b": np.ones(WIDTH, np.int32)})
    with pytest.raises(TypingError):
        wrong(given, empty(1, given.dtype))
