"""How lanes reach the tables: `at(table, k)` is a row, whatever the width.

- k a number, fields that are numbers: the row itself; `row.mass` is a number.
- k a number, fields that are eight numbers each (a table made by `wide`): `row.mass` is eight lanes.
- k eight lanes of row numbers, fields that are numbers: `row.mass` is gathered from eight rows, and `row.mass = x`
  scattered to them, lane by lane; where two lanes name one row, the last one's value stays.

So the text of a kernel does not say how wide it is. Rows of eight numbers of one type, which is what movers and motions
are, come quicker: `load_row` reads eight whole rows and turns columns into lanes in registers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.types.containers import UniTuple
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    lower_setattr_generic,
    models,
    overload,
    register_model,
)

from engine.lanes import eight_of
from engine.simd import WIDTH, Lanes, lane_at, put_lane, shuffle, undefined


def wide(dtype: np.dtype, width: int = WIDTH) -> np.dtype:
    """The dtype of a row that holds `width` rows side by side, field by field; of one row: the dtype itself."""
    assert dtype.fields is not None
    names = dtype.names or ()
    return dtype if width == 1 else np.dtype([(name, dtype.fields[name][0], (width,)) for name in names])


def at(table: Any, k: Any, column: int | None = None) -> Any:
    """Row k of a table, or, of a two-dimensional one, row k of a column: see the top of this file."""
    if column is not None:
        table = table[:, column]
    if isinstance(k, np.ndarray):
        return _PlainGathered(table, k)
    return _PlainBlock(table[k]) if _is_wide(table.dtype) else table[k]


def load_row(table: Any, k: Any, column: int = 0, first: int = 0) -> Any:
    """The eight numbers of row k, or of eight rows, as eight lanes; of a table of four numbers a row, those four.

    column: of a two-dimensional table; first: which of a row's numbers to begin with.
    """
    numbers = _plain_numbers(table, column)[:, first : first + _columns_of(table.dtype)]
    return tuple(np.array(numbers[k].T)) if isinstance(k, np.ndarray) else tuple(numbers[k])


def store_row(table: Any, k: Any, values: Any, column: int = 0, first: int = 0) -> None:
    """Writes numbers of row k, or of eight rows, from the `first` on: four of them or eight."""
    numbers = _plain_numbers(table, column)
    for place, value in enumerate(values):
        numbers[k, first + place] = value


def _columns_of(dtype: np.dtype) -> int:
    """How many numbers of one type a row begins with: 4, or at least 8."""
    return min(WIDTH, 4 if len(dtype.names or ()) == 4 else WIDTH)


def _plain_numbers(table: Any, column: int) -> np.ndarray:
    """(rows, n): the numbers of one type that a table's rows begin with, as a view."""
    rows = np.asarray(table)
    real = rows.dtype[0]
    count = sum(1 for name in rows.dtype.names or () if rows.dtype[name] == real)
    offset = column * rows.strides[1] if rows.ndim == 2 else 0
    return np.ndarray((len(rows), count), real, rows, offset, strides=(rows.strides[0], real.itemsize))


def numbers_at(slots: Any, table: Any, k: int) -> Any:
    """What row k of a table stands for: an element of `slots`, or eight where a row of the table is eight lanes."""
    return eight_of(slots, WIDTH * k) if _is_wide(table.dtype) else slots[k]


def pick(array: Any, k: Any) -> Any:
    """Element k of an array, or the elements that eight lanes name."""
    return np.array(array[k]) if isinstance(k, np.ndarray) else array[k]


def put(array: Any, k: Any, value: Any) -> None:
    """Writes element k of an array, or the elements that eight lanes name."""
    array[k] = value


# --- without compilation ---------------------------------------------------------------------------------------------


def _is_wide(dtype: np.dtype) -> bool:
    return bool(dtype.fields) and dtype[0].shape == (WIDTH,)


class _PlainBlock:
    """A row of eight-lane fields. What is read does not change when the row is written: as if compiled."""

    def __init__(self, row: Any) -> None:
        object.__setattr__(self, "_row", row)

    def __getattr__(self, name: str) -> Any:
        return np.array(self._row[name])

    def __setattr__(self, name: str, value: Any) -> None:
        self._row[name] = value


class _PlainGathered:
    """Eight rows of a table."""

    def __init__(self, table: Any, rows: np.ndarray) -> None:
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_rows", np.array(rows))

    def __getattr__(self, name: str) -> Any:
        return np.array(self._table[name][self._rows])

    def __setattr__(self, name: str, value: Any) -> None:
        self._table[name][self._rows] = value


# --- the types -------------------------------------------------------------------------------------------------------


class Block(types.Type):
    """A row of eight-lane fields, by its address."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"Block({record})")


class Gathered(types.Type):
    """Eight rows: the address of the table, and the number of each row."""

    def __init__(self, record: Any, index: Lanes, step: int) -> None:
        self.record = record
        self.index = index
        self.step = step  # bytes from row to row
        super().__init__(name=f"Gathered({record}, {index}, {step})")


@register_model(Block)
class _BlockModel(models.PrimitiveModel):
    def __init__(self, manager: Any, block: Block) -> None:
        super().__init__(manager, block, cgutils.voidptr_t)


@register_model(Gathered)
class _GatheredModel(models.StructModel):
    def __init__(self, manager: Any, rows: Gathered) -> None:
        super().__init__(manager, rows, [("base", types.voidptr), ("index", rows.index)])


@infer_getattr
class _BlockFields(AttributeTemplate):
    key = Block

    def generic_resolve(self, block: Block, name: str) -> Any:
        return Lanes(block.record.typeof(name).dtype) if name in block.record.fields else None


@infer_getattr
class _GatheredFields(AttributeTemplate):
    key = Gathered

    def generic_resolve(self, rows: Gathered, name: str) -> Any:
        return Lanes(rows.record.typeof(name)) if name in rows.record.fields else None


# --- fields ----------------------------------------------------------------------------------------------------------


def _vector_at(context: Any, builder: Any, base: Any, offset: int, of: Any) -> Any:
    """LLVM: a pointer to eight numbers."""
    kind = ir.VectorType(context.get_value_type(of), WIDTH)
    return cgutils.pointer_add(builder, base, offset, kind.as_pointer())


def _bytes_of(of: Any) -> int:
    return of.bitwidth // 8


@lower_getattr_generic(Block)
def _get_block(context: Any, builder: Any, block: Block, value: Any, name: str) -> Any:
    of = block.record.typeof(name).dtype
    return builder.load(_vector_at(context, builder, value, block.record.offset(name), of), align=_bytes_of(of))


@lower_setattr_generic(Block)
def _set_block(context: Any, builder: Any, signature: Any, arguments: Any, name: str) -> None:
    block, lanes = signature.args
    base, value = arguments
    of = block.record.typeof(name).dtype
    value = context.cast(builder, value, lanes, Lanes(of))
    builder.store(value, _vector_at(context, builder, base, block.record.offset(name), of), align=_bytes_of(of))


def _row_address(builder: Any, base: Any, index: Any, step: Any, offset: int, kind: Any) -> Any:
    """LLVM: where a field of one row is."""
    index = builder.sext(index, cgutils.intp_t) if index.type.width < 64 else index
    step = cgutils.intp_t(step) if isinstance(step, int) else step
    place = builder.add(builder.mul(index, step), cgutils.intp_t(offset))
    return cgutils.pointer_add(builder, base, place, kind.as_pointer())


@lower_getattr_generic(Gathered)
def _get_gathered(context: Any, builder: Any, rows: Gathered, value: Any, name: str) -> Any:
    of = rows.record.typeof(name)
    kind = context.get_value_type(of)
    fields = cgutils.create_struct_proxy(rows)(context, builder, value)
    lanes = undefined(kind)
    for place in range(WIDTH):
        index = lane_at(builder, fields.index, place)
        address = _row_address(builder, fields.base, index, rows.step, rows.record.offset(name), kind)
        lanes = put_lane(builder, lanes, builder.load(address, align=1), place)
    return lanes


@lower_setattr_generic(Gathered)
def _set_gathered(context: Any, builder: Any, signature: Any, arguments: Any, name: str) -> None:
    rows, given = signature.args
    of = rows.record.typeof(name)
    kind = context.get_value_type(of)
    value = context.cast(builder, arguments[1], given, Lanes(of))
    fields = cgutils.create_struct_proxy(rows)(context, builder, arguments[0])
    for place in range(WIDTH):
        index = lane_at(builder, fields.index, place)
        address = _row_address(builder, fields.base, index, rows.step, rows.record.offset(name), kind)
        builder.store(lane_at(builder, value, place), address, align=1)


# --- rows ------------------------------------------------------------------------------------------------------------


def _data(context: Any, builder: Any, table: Any, value: Any) -> Any:
    """LLVM: the address of a table."""
    return builder.bitcast(context.make_array(table)(context, builder, value).data, cgutils.voidptr_t)


@intrinsic
def _block(typing, table, k):
    """One row of eight-lane fields."""
    result = Block(table.dtype)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base = _data(context, builder, table, arguments[0])
        place = builder.mul(arguments[1], cgutils.intp_t(table.dtype.size))
        return cgutils.pointer_add(builder, base, place, cgutils.voidptr_t)

    return result(table, types.intp), generate


@intrinsic
def _gathered(typing, table, index, column):
    """Eight rows, of a column."""
    result = Gathered(table.dtype, index, table.dtype.size)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(table)(context, builder, arguments[0])
        rows = cgutils.create_struct_proxy(result)(context, builder)
        rows.base = _data(context, builder, table, arguments[0])
        rows.index = arguments[1]
        if table.ndim == 2:  # rows of one column are as far apart as the table is wide
            rows.base = cgutils.pointer_add(
                builder, rows.base, builder.mul(arguments[2], cgutils.intp_t(table.dtype.size)), cgutils.voidptr_t
            )  # fmt: skip
            width = cgutils.unpack_tuple(builder, array.shape)[1]
            rows.index = builder.mul(rows.index, _splat_as(builder, width, rows.index.type))
        return rows._getvalue()

    return result(table, index, types.intp), generate


def _splat_as(builder: Any, value: Any, vector: Any) -> Any:
    if vector.element.width < value.type.width:
        value = builder.trunc(value, vector.element)
    first = builder.insert_element(undefined(vector.element), value, ir.Constant(ir.IntType(32), 0))
    return shuffle(builder, first, first, [0] * WIDTH)


def _is_block_table(table: Any) -> bool:
    fields = table.dtype.fields.values()
    return all(isinstance(field.type, types.NestedArray) and field.type.shape == (WIDTH,) for field in fields)


@overload(at)
def _at(table, k, column=None):
    if not (isinstance(table, types.Array) and isinstance(table.dtype, types.Record)):
        return None
    if isinstance(k, Lanes):
        if table.ndim == 2:
            return lambda table, k, column=None: _gathered(table, k, column)
        return lambda table, k, column=None: _gathered(table, k, 0)
    if table.ndim == 2:
        return lambda table, k, column=None: table[k, column]
    if _is_block_table(table):
        return lambda table, k, column=None: _block(table, k)
    return lambda table, k, column=None: table[k]


@intrinsic
def _picked(typing, array, index):
    result = Lanes(array.dtype)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base = _data(context, builder, array, arguments[0])
        kind = context.get_value_type(array.dtype)
        lanes = undefined(kind)
        for place in range(WIDTH):
            number = lane_at(builder, arguments[1], place)
            address = _row_address(builder, base, number, _bytes_of(array.dtype), 0, kind)
            lanes = put_lane(builder, lanes, builder.load(address, align=_bytes_of(array.dtype)), place)
        return lanes

    return result(array, index), generate


@intrinsic
def _put(typing, array, index, value):
    if not isinstance(value, Lanes):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base = _data(context, builder, array, arguments[0])
        kind = context.get_value_type(array.dtype)
        lanes = context.cast(builder, arguments[2], value, Lanes(array.dtype))
        for place in range(WIDTH):
            number = lane_at(builder, arguments[1], place)
            address = _row_address(builder, base, number, _bytes_of(array.dtype), 0, kind)
            builder.store(lane_at(builder, lanes, place), address, align=_bytes_of(array.dtype))
        return context.get_dummy_value()

    return types.void(array, index, value), generate


@overload(put)
def _overload_put(array, k, value):
    if isinstance(k, Lanes):
        return lambda array, k, value: _put(array, k, value)

    def put(array, k, value):
        array[k] = value

    return put


@overload(pick)
def _pick(array, k):
    return (lambda array, k: _picked(array, k)) if isinstance(k, Lanes) else (lambda array, k: array[k])


@overload(numbers_at)
def _numbers_at(slots, table, k):
    if _is_block_table(table):
        return lambda slots, table, k: eight_of(slots, WIDTH * k)
    return lambda slots, table, k: slots[k]


# --- rows of eight numbers -------------------------------------------------------------------------------------------

EVEN = ([0, 8, 1, 9, 4, 12, 5, 13], [2, 10, 3, 11, 6, 14, 7, 15])  # columns of two rows, in turns
PAIRS = ([0, 1, 8, 9, 4, 5, 12, 13], [2, 3, 10, 11, 6, 7, 14, 15])
HALVES = ([0, 1, 2, 3, 8, 9, 10, 11], [4, 5, 6, 7, 12, 13, 14, 15])


def _transpose(builder: Any, rows: list[Any]) -> list[Any]:
    """LLVM: eight vectors of eight, columns for rows, in three rounds of shuffles."""
    t = [shuffle(builder, rows[i], rows[i + 1], EVEN[side]) for i in (0, 2, 4, 6) for side in (0, 1)]
    s = [
        shuffle(builder, t[i], t[i + 2], PAIRS[side]) for i in (0, 1, 4, 5) for side in (0, 1)
    ]  # columns 0 and 4, 1 and 5, 2 and 6, 3 and 7 of rows 0 to 3, then of 4 to 7
    return [shuffle(builder, s[i], s[i + 4], HALVES[side]) for side in (0, 1) for i in range(4)]


def _row_of(context: Any, builder: Any, table: Any, arguments: Any, real: Any) -> tuple[Any, Any]:
    """LLVM: where the wanted numbers of row 0 are, and how far rows are apart: (address, bytes)."""
    value, column, first = arguments
    offset = builder.mul(first, cgutils.intp_t(_bytes_of(real)))
    step = cgutils.intp_t(table.dtype.size)
    if table.ndim == 2:
        offset = builder.add(offset, builder.mul(column, step))
        array = context.make_array(table)(context, builder, value)
        step = builder.mul(step, cgutils.unpack_tuple(builder, array.shape)[1])
    base = cgutils.pointer_add(builder, _data(context, builder, table, value), offset, cgutils.voidptr_t)
    return base, step


def _transpose_four(builder: Any, rows: list[Any]) -> list[Any]:
    """LLVM: eight vectors of four, columns for rows."""
    joined = [shuffle(builder, rows[i], rows[i + 4], list(range(8))) for i in range(4)]
    t = [shuffle(builder, joined[i], joined[i + 1], EVEN[side]) for i in (0, 2) for side in (0, 1)]
    return [shuffle(builder, t[i], t[i + 2], PAIRS[side]) for i in (0, 1) for side in (0, 1)]


@intrinsic
def _load_row(typing, table, k, column, first):
    real = next(iter(table.dtype.fields.values())).type
    number = 4 if len(table.dtype.fields) == 4 else WIDTH
    result = UniTuple(Lanes(real) if isinstance(k, Lanes) else real, number)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base, step = _row_of(context, builder, table, (arguments[0], arguments[2], arguments[3]), real)
        vector = ir.VectorType(context.get_value_type(real), number)
        if isinstance(k, Lanes):
            rows = []
            for place in range(WIDTH):
                address = _row_address(builder, base, lane_at(builder, arguments[1], place), step, 0, vector)
                rows.append(builder.load(address, align=_bytes_of(real)))
            columns = _transpose(builder, rows) if number == WIDTH else _transpose_four(builder, rows)
            return cgutils.pack_array(builder, columns)
        row = builder.load(_row_address(builder, base, arguments[1], step, 0, vector), align=_bytes_of(real))
        return cgutils.pack_array(builder, [lane_at(builder, row, place) for place in range(number)])

    return result(table, k, types.intp, types.intp), generate


@intrinsic
def _store_row(typing, table, k, values, column, first):
    real = next(iter(table.dtype.fields.values())).type
    number = values.count

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base, step = _row_of(context, builder, table, (arguments[0], arguments[3], arguments[4]), real)
        columns = cgutils.unpack_tuple(builder, arguments[2], number)
        kind = context.get_value_type(real)
        if not isinstance(k, Lanes):
            for place, value in enumerate(columns):
                address = _row_address(builder, base, arguments[1], step, place * _bytes_of(real), kind)
                builder.store(value, address, align=_bytes_of(real))
            return context.get_dummy_value()
        filled = columns + [columns[0]] * (WIDTH - number)
        part = ir.VectorType(kind, number)
        for place, row in enumerate(_transpose(builder, filled)):
            address = _row_address(builder, base, lane_at(builder, arguments[1], place), step, 0, part)
            wanted = row if number == WIDTH else shuffle(builder, row, row, list(range(number)))
            builder.store(wanted, address, align=_bytes_of(real))
        return context.get_dummy_value()

    return types.void(table, k, values, types.intp, types.intp), generate


def _begins_with_numbers(table: Any) -> bool:
    """Whether a table's rows begin with eight numbers of one type, or are four."""
    if not (isinstance(table, types.Array) and isinstance(table.dtype, types.Record)):
        return False
    kinds = [field.type for field in table.dtype.fields.values()][:WIDTH]
    return len(set(kinds)) == 1 and isinstance(kinds[0], types.Float) and len(kinds) in (4, WIDTH)


@overload(load_row)
def _overload_load_row(table, k, column=0, first=0):
    if not _begins_with_numbers(table):
        return None
    return lambda table, k, column=0, first=0: _load_row(table, k, column, first)


@overload(store_row)
def _overload_store_row(table, k, values, column=0, first=0):
    if not _begins_with_numbers(table):
        return None
    return lambda table, k, values, column=0, first=0: _store_row(table, k, values, column, first)
