"""Eight lanes at once: a vector of eight numbers as a type of numba's, so that a kernel for one lane is one for eight.

A lane is one number or, here, eight of them; a `Mask` is what comparing them gives. Arithmetic and comparison look as
ever and round as ever, each lane by itself: the bits of lane i are those of the same kernel run on the i-th numbers.
LLVM maps a vector to whatever the machine has: one AVX register, two of SSE or Neon, or half of one of AVX-512.

Without compilation eight lanes are a numpy array of eight, which has the same operators. What an array and a number
say differently stands in engine/lanes.py; how lanes reach the tables, in engine/rows.py.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typeconv import Conversion
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model, type_callable

WIDTH = 8
"""Lanes that are worked on at once: a row of movers in single precision fills as much."""


class Lanes(types.Type):
    """Eight numbers of one type."""

    def __init__(self, of: Any) -> None:
        self.of = of
        super().__init__(name=f"Lanes({of})")

    def can_convert_from(self, typing: Any, other: Any) -> Any:
        """A number is said to all eight."""
        return Conversion.safe if fits(other, self) else None


class Mask(types.Type):
    """Eight truths."""

    def __init__(self) -> None:
        super().__init__(name="Mask")

    def can_convert_from(self, typing: Any, other: Any) -> Any:
        """So is a truth."""
        return Conversion.safe if isinstance(other, types.Boolean) else None


mask = Mask()


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, lanes: Lanes) -> None:
        of = manager.lookup(lanes.of).get_value_type()
        super().__init__(manager, lanes, ir.VectorType(of, WIDTH))


@register_model(Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Mask) -> None:
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), WIDTH))


# --- what may meet ---------------------------------------------------------------------------------------------------


def common(a: Any, b: Any) -> Lanes | None:
    """The lanes in which a and b meet: one at least is lanes, the other the same, or a number that fits."""
    if isinstance(b, Lanes) and not isinstance(a, Lanes):
        a, b = b, a
    if not isinstance(a, Lanes):
        return None
    if a == b:
        return a
    return a if fits(b, a) else None


def fits(number: Any, lanes: Lanes) -> bool:
    """Whether a number may be said to all lanes: one of their own type, or a whole one. No float64 slips in."""
    return number == lanes.of or isinstance(number, types.Integer)


def splat(builder: Any, value: Any) -> Any:
    """LLVM: one value in all lanes."""
    kind = ir.VectorType(value.type, WIDTH)
    place = ir.Constant(ir.IntType(32), 0)
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), value, place)
    return shuffle(builder, first, first, [0] * WIDTH)


def shuffle(builder: Any, a: Any, b: Any, places: list[int]) -> Any:
    """LLVM: a vector of the lanes of a (0 to 7) and b (8 to 15) in those places."""
    kind = ir.VectorType(ir.IntType(32), len(places))
    return builder.shuffle_vector(a, b, ir.Constant(kind, places))


def lane_at(builder: Any, vector: Any, place: int) -> Any:
    """LLVM: one lane."""
    return builder.extract_element(vector, ir.Constant(ir.IntType(32), place))


def put_lane(builder: Any, vector: Any, value: Any, place: int) -> Any:
    """LLVM: the vector with one lane replaced."""
    return builder.insert_element(vector, value, ir.Constant(ir.IntType(32), place))


def undefined(kind: Any) -> Any:
    """LLVM: a vector of that type of element in which nothing has been put yet."""
    return ir.Constant(ir.VectorType(kind, WIDTH), ir.Undefined)


@lower_cast(types.Float, Lanes)
@lower_cast(types.Integer, Lanes)
def _number_to_lanes(context: Any, builder: Any, given: Any, lanes: Any, value: Any) -> Any:
    return splat(builder, context.cast(builder, value, given, lanes.of))


@lower_cast(types.Boolean, Mask)
def _truth_to_mask(context: Any, builder: Any, given: Any, kind: Any, value: Any) -> Any:
    return splat(builder, builder.trunc(value, ir.IntType(1)) if value.type.width > 1 else value)


@lower_cast(Lanes, Lanes)
def _lanes_to_lanes(context: Any, builder: Any, given: Any, lanes: Any, value: Any) -> Any:
    return convert(builder, value, given.of, lanes.of)


def convert(builder: Any, value: Any, given: Any, wanted: Any) -> Any:
    """LLVM: lanes of one type of number as another: rounded, widened, or cut towards zero."""
    kind = ir.VectorType(_NUMBERS[wanted], WIDTH)
    if given == wanted:
        return value
    narrower = wanted.bitwidth < given.bitwidth
    if isinstance(given, types.Float) and isinstance(wanted, types.Float):
        return builder.fptrunc(value, kind) if narrower else builder.fpext(value, kind)
    if isinstance(given, types.Float):
        return builder.fptosi(value, kind)
    if isinstance(wanted, types.Float):
        return builder.sitofp(value, kind)
    return builder.trunc(value, kind) if narrower else builder.sext(value, kind)


_NUMBERS = {
    types.float32: ir.FloatType(),
    types.float64: ir.DoubleType(),
    types.int32: ir.IntType(32),
    types.int64: ir.IntType(64),
}


# --- operators -------------------------------------------------------------------------------------------------------


def _binary(operators: tuple[Any, ...], floats: str, integers: str) -> None:
    """Arithmetic on two lanes: the LLVM instruction for floats and the one for integers ("" for none)."""

    def typer_of(context: Any) -> Callable[[Any, Any], Any]:
        def typer(a: Any, b: Any) -> Any:
            lanes = common(a, b)
            if lanes is None or (not integers and isinstance(lanes.of, types.Integer)):
                return None
            return lanes(lanes, lanes)

        return typer

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        name = floats if isinstance(signature.return_type.of, types.Float) else integers
        return getattr(builder, name)(*arguments)

    for function in operators:
        type_callable(function)(typer_of)
        lower_builtin(function, Lanes, Lanes)(lower)


_binary((operator.add, operator.iadd), "fadd", "add")
_binary((operator.sub, operator.isub), "fsub", "sub")
_binary((operator.mul, operator.imul), "fmul", "mul")
_binary((operator.truediv, operator.itruediv), "fdiv", "")


def _compare(function: Any, sign: str) -> None:
    def typer_of(context: Any) -> Callable[[Any, Any], Any]:
        def typer(a: Any, b: Any) -> Any:
            lanes = common(a, b)
            return None if lanes is None else mask(lanes, lanes)

        return typer

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        if isinstance(signature.args[0].of, types.Integer):
            return builder.icmp_signed(sign, *arguments)
        # as everywhere: nothing is less than, greater than or equal to NaN, and everything is unequal
        return (builder.fcmp_unordered if sign == "!=" else builder.fcmp_ordered)(sign, *arguments)

    type_callable(function)(typer_of)
    lower_builtin(function, Lanes, Lanes)(lower)


for _function, _sign in ((operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">=")):
    _compare(_function, _sign)
_compare(operator.eq, "==")
_compare(operator.ne, "!=")


def _logic(operators: tuple[Any, ...], instruction: str) -> None:
    def typer_of(context: Any) -> Callable[[Any, Any], Any]:
        def typer(a: Any, b: Any) -> Any:
            one_is = isinstance(a, Mask) or isinstance(b, Mask)
            return mask(mask, mask) if one_is and all(isinstance(x, (Mask, types.Boolean)) for x in (a, b)) else None

        return typer

    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return getattr(builder, instruction)(*arguments)

    for function in operators:
        type_callable(function)(typer_of)
        lower_builtin(function, Mask, Mask)(lower)


_logic((operator.and_, operator.iand), "and_")
_logic((operator.or_, operator.ior), "or_")


@type_callable(operator.neg)
def _type_neg(context: Any) -> Callable[[Any], Any]:
    return lambda a: a(a) if isinstance(a, Lanes) else None


@lower_builtin(operator.neg, Lanes)
def _lower_neg(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    (a,) = arguments
    return builder.fneg(a) if isinstance(signature.return_type.of, types.Float) else builder.neg(a)


@type_callable(operator.invert)
def _type_invert(context: Any) -> Callable[[Any], Any]:
    return lambda a: a(a) if isinstance(a, Mask) else None


@lower_builtin(operator.invert, Mask)
def _lower_invert(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.not_(arguments[0])


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Callable[[Any, Any], Any]:
    def typer(a: Any, place: Any) -> Any:
        if isinstance(place, types.Integer) and isinstance(a, (Lanes, Mask)):
            return (a.of if isinstance(a, Lanes) else types.boolean)(a, types.intp)
        return None

    return typer


@lower_builtin(operator.getitem, Lanes, types.Integer)
@lower_builtin(operator.getitem, Mask, types.Integer)
def _lower_getitem(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.extract_element(*arguments)


# --- what has no operator; engine/lanes.py gives these their names ---------------------------------------------------


@intrinsic
def select_lanes(typing, condition, a, b):
    """a in the lanes where the condition holds, else b."""
    if not isinstance(condition, Mask):
        return None
    kind = mask if isinstance(a, (Mask, types.Boolean)) and isinstance(b, (Mask, types.Boolean)) else common(a, b)
    if kind is None and a == b and isinstance(a, types.Number):
        kind = Lanes(a)
    if kind is None:
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(*arguments)

    return kind(mask, kind, kind), generate


@intrinsic
def splat_number(typing, value, lanes):
    """A number, or the numbers of other lanes, as lanes of that type."""
    if not isinstance(lanes, Lanes) or not isinstance(value, (types.Number, Lanes)):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.cast(builder, arguments[0], value, lanes)

    return lanes(value, lanes), generate


@intrinsic
def sqrt_lanes(typing, a):
    """The square roots, each rounded as IEEE 754 says."""
    if not (isinstance(a, Lanes) and isinstance(a.of, types.Float)):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = arguments[0].type
        name = f"llvm.sqrt.v{WIDTH}f{signature.return_type.of.bitwidth}"
        function = builder.module.globals.get(name) or ir.Function(builder.module, ir.FunctionType(kind, [kind]), name)
        return builder.call(function, arguments)

    return a(a), generate


@intrinsic
def any_lane(typing, condition):
    """Whether the condition holds in one lane at least."""
    if not isinstance(condition, Mask):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        bits = builder.bitcast(arguments[0], ir.IntType(WIDTH))
        return builder.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(WIDTH), 0))

    return types.boolean(condition), generate


@intrinsic
def mask_bits(typing, condition):
    """A bit for each lane."""
    if not isinstance(condition, Mask):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.zext(builder.bitcast(arguments[0], ir.IntType(WIDTH)), ir.IntType(64))

    return types.int64(condition), generate


@intrinsic
def cut_lanes(typing, a):
    """The numbers without their fractions."""
    if not (isinstance(a, Lanes) and isinstance(a.of, types.Float)):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return convert(builder, convert(builder, arguments[0], a.of, types.int32), types.int32, a.of)

    return a(a), generate


@intrinsic
def load_lanes(typing, array, first):
    """Eight elements of a one-dimensional contiguous array, from a place on."""
    if not (isinstance(array, types.Array) and array.ndim == 1 and array.layout == "C" and array.dtype in _NUMBERS):
        return None
    lanes = Lanes(array.dtype)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = context.make_array(array)(context, builder, arguments[0]).data
        place = builder.gep(data, [arguments[1]])
        vector = ir.VectorType(_NUMBERS[array.dtype], WIDTH)
        return builder.load(builder.bitcast(place, vector.as_pointer()), align=array.dtype.bitwidth // 8)

    return lanes(array, types.intp), generate
