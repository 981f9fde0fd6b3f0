"""How lanes reach tables: blocks, gathered and scattered rows, and rows of eight numbers, as numpy says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.core.errors import TypingError

from engine.jit import kernel
from engine.lanes import const, eight_of
from engine.rows import at, load_row, numbers_at, pick, put, store_row, wide
from engine.simd import WIDTH
from engine.tables import empty
from tests.engine.eights import REALS, bits, floats

plain_too = pytest.mark.kernel

ROWS = 13
MIXED = np.dtype(  # packed: only the first field of the first row is where its own size would have it
    [("short", np.int32), ("double", np.float64), ("single", np.float32), ("long", np.int64)]
)
NAMES = MIXED.names or ()
index_lists = st.lists(st.integers(0, ROWS - 1), min_size=WIDTH, max_size=WIDTH)


def mixed_table(shape: int | tuple[int, ...]) -> np.ndarray:
    """Rows that all differ."""
    table = empty(shape, MIXED)
    for number, name in enumerate(NAMES):
        table[name] = (np.arange(table.size) * 10 + number).reshape(table.shape)
    return table


def test_the_table_is_as_awkward_as_it_should_be() -> None:
    assert MIXED.itemsize == 24
    assert [MIXED.fields[name][1] for name in NAMES] == [0, 4, 12, 16]  # type: ignore[index]


@plain_too
def test_wide() -> None:
    block = wide(MIXED)
    assert block.names == MIXED.names
    assert all(block[name].shape == (WIDTH,) and block[name].base == MIXED[name] for name in NAMES)
    assert wide(MIXED, 1) == MIXED
    assert wide(MIXED, 4)["double"].shape == (4,)


# --- blocks ----------------------------------------------------------------------------------------------------------


@kernel
def work_on_blocks(table, count):
    """Also at either width."""
    for k in range(count):
        row = at(table, k)
        before = row.double
        row.double = row.double * row.double
        row.single = row.single - const(before, row.single)
        row.short = row.short + 1
        row.short += row.short
        row.long = 7
    at(table, count - 1).double = 1.5  # a number is said to all eight
    at(table, count - 1).single = row.double  # and rounded


@plain_too
def test_blocks_are_read_and_written() -> None:
    rows, blocks = mixed_table(24), empty(3, wide(MIXED))
    for name in NAMES:
        blocks[name] = rows[name].reshape(3, WIDTH)
    expected = {name: rows[name].copy() for name in NAMES}
    expected["double"] = rows["double"] ** 2
    expected["single"] = rows["single"] - rows["double"].astype(np.float32)
    expected["short"] = 2 * (rows["short"] + 1)
    expected["long"][:] = 7
    work_on_blocks(blocks, 3)
    work_on_blocks(rows, 24)
    for name, column in expected.items():
        assert blocks[name][:2].ravel().tolist() == rows[name][:16].tolist() == column[:16].tolist(), name
    assert blocks["double"][2].tolist() == [1.5] * WIDTH
    assert rows["double"][22:].tolist() == [expected["double"][22], 1.5]
    assert blocks["single"][2].tolist() == [1.5] * WIDTH, "the row shows what was just written"
    assert rows["single"][-1] == 1.5


@kernel
def read_before_writing(table, out):
    row = at(table, 0)
    before = row.double
    row.double = before + before
    at(out, 0).double = before
    at(out, 0).single = const(row.double, row.single)


@plain_too
@pytest.mark.parametrize("make", [lambda: mixed_table(1), lambda: empty(1, wide(MIXED))], ids=["row", "block"])
def test_what_was_read_stays(make) -> None:
    table, out = make(), make()
    table["double"] = 3.0
    read_before_writing(table, out)
    assert np.all(out["double"] == 3.0)
    assert np.all(out["single"] == 6.0)
    assert np.all(table["double"] == 6.0)


@kernel
def names_of(slots, table, out, k):
    out[k] = pick(slots, k)
    at(table, k).short = numbers_at(slots, table, k) + 1


@plain_too
def test_numbers_at() -> None:
    slots = np.arange(24, dtype=np.int32)[::-1].copy()
    rows, blocks, out = mixed_table(24), empty(3, wide(MIXED)), np.zeros(24, np.int32)
    for k in range(24):
        names_of(slots, rows, out, k)
    for k in range(3):
        names_of(slots, blocks, out, k)
    assert out.tolist() == slots.tolist()
    assert rows["short"].tolist() == blocks["short"].ravel().tolist() == (slots + 1).tolist()


# --- rows here and there ---------------------------------------------------------------------------------------------


@kernel
def gather(table, index, out):
    found = at(table, eight_of(index, 0))
    block = at(out, 0)
    block.short = found.short
    block.double = found.double
    block.single = found.single
    block.long = found.long


@kernel
def gather_column(table, index, column, out):
    found = at(table, eight_of(index, 0), column)
    block = at(out, 0)
    block.short = found.short
    block.double = found.double
    block.single = found.single
    block.long = found.long


@kernel
def scatter(table, index, values):
    rows = at(table, eight_of(index, 0))
    block = at(values, 0)
    rows.short = block.short
    rows.double = block.double
    rows.single = block.double  # rounded on the way
    rows.long = 5


@kernel
def scatter_column(table, index, column, values):
    rows = at(table, eight_of(index, 0), column)
    block = at(values, 0)
    rows.short = block.short
    rows.double = block.double
    rows.single = block.double
    rows.long = 5


def scattered(rows: np.ndarray, index: list[int], values: np.ndarray) -> None:
    """What `scatter` does, one lane after the other."""
    for lane, place in enumerate(index):
        rows["short"][place] = values["short"][0, lane]
        rows["double"][place] = values["double"][0, lane]
        rows["single"][place] = np.float32(values["double"][0, lane])
        rows["long"][place] = 5


def some_values(double: np.ndarray) -> np.ndarray:
    values = empty(1, wide(MIXED))
    values["short"] = np.arange(WIDTH) - 100
    values["double"] = double
    return values


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return all(bits(a[name]) == bits(b[name]) for name in NAMES)


@plain_too
@pytest.mark.parametrize("whole", [np.int32, np.int64])
@settings(max_examples=40)
@given(index=index_lists, double=floats(np.float64))
def test_rows_are_gathered_and_scattered(whole: type, index: list[int], double: np.ndarray) -> None:
    table, out, values = mixed_table(ROWS), empty(1, wide(MIXED)), some_values(double)
    places = np.array(index, whole)
    gather(table, places, out)
    for name in NAMES:
        assert out[name][0].tolist() == table[name][index].tolist(), name
    expected = table.copy()
    with np.errstate(all="ignore"):
        scattered(expected, index, values)
        scatter(table, places, values)
    assert same(table, expected), "of several lanes in one row the last stays; other rows are as they were"


@plain_too
@pytest.mark.parametrize("whole", [np.int32, np.int64])
@pytest.mark.parametrize("columns", [2, 3])
@settings(max_examples=20)
@given(index=index_lists, double=floats(np.float64), data=st.data())
def test_columns_of_two_dimensional_tables(
    whole: type, columns: int, index: list[int], double: np.ndarray, data: st.DataObject
) -> None:
    table, out, values = mixed_table((ROWS, columns)), empty(1, wide(MIXED)), some_values(double)
    column = data.draw(st.integers(0, columns - 1))
    places = np.array(index, whole)
    gather_column(table, places, column, out)
    for name in NAMES:
        assert out[name][0].tolist() == table[name][index, column].tolist(), name
    expected = table.copy()
    with np.errstate(all="ignore"):
        scattered(expected[:, column], index, values)
        scatter_column(table, places, column, values)
    assert same(table, expected)


@kernel
def read_one(table, k, column):
    row = at(table, k, column)
    row.short = row.short + 1
    return row.double


@plain_too
def test_one_row_of_a_column() -> None:
    table = mixed_table((ROWS, 2))
    before = table.copy()
    assert read_one(table, 4, 1) == before["double"][4, 1]
    before["short"][4, 1] += 1
    assert same(table, before)


# --- arrays ----------------------------------------------------------------------------------------------------------


@kernel
def pick_and_put(array, index, out, factor):
    eight = eight_of(index, 0)
    found = pick(array, eight)
    for lane in range(WIDTH):
        out[lane] = found[lane]
    put(array, eight, found * factor)
    put(array, 0, pick(array, 0) + factor)


@plain_too
@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int32])
@settings(max_examples=20)
@given(index=index_lists)
def test_pick_and_put(kind: type, index: list[int]) -> None:
    array, out = np.arange(1, ROWS + 1).astype(kind), np.zeros(WIDTH, kind)
    expected = array.copy()
    pick_and_put(array, np.array(index, np.int32), out, kind(3))
    assert out.tolist() == expected[index].tolist()
    for place in set(index):
        expected[place] *= 3
    expected[0] += 3
    assert array.tolist() == expected.tolist()


@kernel
def put_places(array, index, values):
    put(array, eight_of(index, 0), eight_of(values, 0))


@plain_too
@settings(max_examples=20)
@given(index=index_lists)
def test_the_last_put_stays(index: list[int]) -> None:
    array, values = np.zeros(ROWS, np.float32), np.arange(1.0, WIDTH + 1)
    put_places(array, np.array(index), values)
    expected = {place: values[lane] for lane, place in enumerate(index)}
    assert array.tolist() == [expected.get(place, 0.0) for place in range(ROWS)]


# --- rows of eight numbers -------------------------------------------------------------------------------------------


def octets(real: type, columns: str = "abcdefgh") -> np.dtype:
    return np.dtype([(name, real) for name in columns])


@kernel
def turn_columns(table, index, k, out):
    """Loads eight rows or one, and writes the columns in the other order."""
    rows = numbers_at(index, out, k)
    a, b, c, d, e, f, g, h = load_row(table, rows)
    row = at(out, k)
    row.a, row.b, row.c, row.d, row.e, row.f, row.g, row.h = a, b, c, d, e, f, g, h
    store_row(table, rows, (h, g, f, e, d, c, b, a))


@kernel
def store_four(table, index, k, values):
    row = at(values, k)
    store_row(table, numbers_at(index, values, k), (row.a, row.b, row.c, row.d))


@plain_too
@pytest.mark.parametrize("real", REALS)
@settings(max_examples=30)
@given(data=st.data())
def test_rows_of_eight(real: type, data: st.DataObject) -> None:
    index = data.draw(st.permutations(range(ROWS)))[:WIDTH]
    numbers = np.stack(
        [data.draw(floats(real)) for _ in range(2)] + [np.arange(8, dtype=real) + 8 * k for k in range(ROWS - 2)]
    )
    places = np.array(index, np.int32)
    expected = numbers.copy()
    expected[index] = numbers[index][:, ::-1]
    for width in (1, WIDTH):
        table, out = empty(ROWS, octets(real)), empty(WIDTH // width, wide(octets(real), width))
        table.view((real, 8))[:] = numbers
        for k in range(len(out)):
            turn_columns(table, places, k, out)
        for column, name in enumerate("abcdefgh"):
            assert bits(out[name].ravel()) == bits(numbers[index, column]), (width, name)
        assert bits(table.view((real, 8))) == bits(expected), width


@plain_too
@pytest.mark.parametrize("real", REALS)
@settings(max_examples=30)
@given(index=index_lists)
def test_four_of_eight_numbers_are_stored(real: type, index: list[int]) -> None:
    before = np.arange(8 * ROWS, dtype=real).reshape(ROWS, 8)
    values = -np.arange(1, 33, dtype=real).reshape(4, WIDTH)
    expected = before.copy()
    for lane, place in enumerate(index):  # the last one stays
        expected[place, :4] = values[:, lane]
    for width in (1, WIDTH):
        table, rows = empty(ROWS, octets(real)), empty(WIDTH // width, wide(octets(real, "abcd"), width))
        table.view((real, 8))[:] = before
        for name, column in zip("abcd", values, strict=True):
            rows[name] = column.reshape(rows[name].shape)
        for k in range(len(rows)):
            store_four(table, np.array(index, np.int32), k, rows)
        assert table.view((real, 8)).tolist() == expected.tolist(), width


# Rows that begin with more than eight numbers of one type, with something else after them; rows of four; columns.

LONG_ROW = "abcdefghijkl"


def long_rows(real: type) -> np.dtype:
    return np.dtype([*((name, real) for name in LONG_ROW), ("flag", np.int32)])


@kernel
def swap_in_column(table, index, k, column, first, out):
    """Loads eight numbers of a row from the `first` on, and writes the first four of them where the last four were."""
    rows = numbers_at(index, out, k)
    a, b, c, d, e, f, g, h = load_row(table, rows, column, first)
    row = at(out, k)
    row.a, row.b, row.c, row.d, row.e, row.f, row.g, row.h = a, b, c, d, e, f, g, h
    store_row(table, rows, (a, b, c, d), column, first + 4)


@kernel
def turn_four(table, index, k, out):
    rows = numbers_at(index, out, k)
    a, b, c, d = load_row(table, rows)
    row = at(out, k)
    row.a, row.b, row.c, row.d = a, b, c, d
    store_row(table, rows, (d, c, b, a))


@plain_too
@pytest.mark.parametrize("real", REALS)
@settings(max_examples=20)
@given(data=st.data())
def test_eight_of_a_longer_row_in_a_column(real: type, data: st.DataObject) -> None:
    index = data.draw(st.permutations(range(ROWS)))[:WIDTH]
    column, first = data.draw(st.integers(0, 1)), data.draw(st.integers(0, 4))
    numbers = np.arange(2 * ROWS * len(LONG_ROW), dtype=real).reshape(ROWS, 2, len(LONG_ROW))
    expected = numbers.copy()
    expected[index, column, first + 4 : first + 8] = numbers[index, column, first : first + 4]
    for width in (1, WIDTH):
        table, out = empty((ROWS, 2), long_rows(real)), empty(WIDTH // width, wide(octets(real), width))
        for place, name in enumerate(LONG_ROW):
            table[name] = numbers[..., place]
        table["flag"] = 77
        for k in range(len(out)):
            swap_in_column(table, np.array(index, np.int32), k, column, first, out)
        for place, name in enumerate("abcdefgh"):
            assert out[name].ravel().tolist() == numbers[index, column, first + place].tolist(), (width, name)
        for place, name in enumerate(LONG_ROW):
            assert table[name].tolist() == expected[..., place].tolist(), (width, name)
        assert np.all(table["flag"] == 77)


@plain_too
@pytest.mark.parametrize("real", REALS)
@settings(max_examples=20)
@given(data=st.data())
def test_rows_of_four(real: type, data: st.DataObject) -> None:
    index = data.draw(st.permutations(range(ROWS)))[:WIDTH]
    numbers = np.stack([data.draw(floats(real)) for _ in range(4)] + [np.arange(8, dtype=real)] * (ROWS - 4))[:, :4]
    expected = numbers.copy()
    expected[index] = numbers[index][:, ::-1]
    for width in (1, WIDTH):
        table, out = empty(ROWS, octets(real, "abcd")), empty(WIDTH // width, wide(octets(real, "abcd"), width))
        for place, name in enumerate("abcd"):
            table[name] = numbers[:, place]
        for k in range(len(out)):
            turn_four(table, np.array(index), k, out)
        for place, name in enumerate("abcd"):
            assert bits(out[name].ravel()) == bits(numbers[index, place]), (width, name)
            assert bits(table[name]) == bits(expected[:, place]), (width, name)


# --- what is refused -------------------------------------------------------------------------------------------------


def test_only_rows_of_eight_equal_numbers_load_as_such() -> None:
    index, out = np.arange(WIDTH, dtype=np.int32), empty(1, wide(octets(np.float32)))
    for wrong in (octets(np.float32, "abcdefg"), octets(np.int32), MIXED):
        with pytest.raises(TypingError):
            turn_columns(empty(ROWS, wrong), index, 0, out)


def test_a_field_that_is_not_there_is_refused() -> None:
    with pytest.raises(TypingError):
        gather(empty(ROWS, np.dtype([("short", np.int32)])), np.arange(WIDTH), empty(1, wide(MIXED)))
