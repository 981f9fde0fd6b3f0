"""What a kernel may do to a lane, whatever its width, beyond + - * / and comparison.

A lane is one float32 or one float64, or eight of either (engine/simd.py; without compilation a numpy array of eight).
No bare literal with a point may meet one: to numba `float32 * 0.5` is a float64, to numpy it is a float32, and the
compiled and the plain engine would part ways. `const(0.5, lane)` is the literal in the lane's own width.

Eight lanes cannot branch: what one lane would decide with `if`, all decide with `select`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.core import types
from numba.extending import overload

from engine.jit import kernel
from engine.simd import (
    WIDTH,
    Lanes,
    Mask,
    any_lane,
    cut_lanes,
    load_lanes,
    mask_bits,
    select_lanes,
    splat_number,
    sqrt_lanes,
)  # fmt: skip


def const(value: Any, lane: Any) -> Any:
    """The number `value` in the type and width of `lane`; lanes of another type are converted."""
    kind = lane.dtype if hasattr(lane, "dtype") else np.dtype(type(lane))
    return value.astype(kind) if isinstance(value, np.ndarray) else kind.type(value)


@overload(const)
def _const(value, lane):
    if isinstance(lane, Lanes):
        return lambda value, lane: splat_number(value, lane)
    if lane == types.float32:
        return lambda value, lane: np.float32(value)
    if lane == types.float64:
        return lambda value, lane: np.float64(value)
    if lane == types.int32:
        return lambda value, lane: np.int32(value)
    if lane == types.int64:
        return lambda value, lane: np.int64(value)
    return None


def select(condition: Any, a: Any, b: Any) -> Any:
    """a where the condition holds, else b."""
    return np.where(condition, a, b) if isinstance(condition, np.ndarray) else (a if condition else b)


@overload(select)
def _select(condition, a, b):
    if isinstance(condition, Mask):
        return lambda condition, a, b: select_lanes(condition, a, b)
    return lambda condition, a, b: a if condition else b


def sqrt(a: Any) -> Any:
    """The square root."""
    return np.sqrt(a)


@overload(sqrt)
def _sqrt(a):
    if isinstance(a, Lanes):
        return lambda a: sqrt_lanes(a)
    return lambda a: np.sqrt(a)


def holds_somewhere(condition: Any) -> bool:
    """Whether the condition holds in any lane."""
    return bool(np.any(condition))


@overload(holds_somewhere)
def _holds_somewhere(condition):
    if isinstance(condition, Mask):
        return lambda condition: any_lane(condition)
    return lambda condition: condition


def eight_of(array: Any, first: int) -> Any:
    """Eight lanes: the elements of a one-dimensional array from `first` on."""
    return np.array(array[first : first + WIDTH])


@overload(eight_of)
def _eight_of(array, first):
    return lambda array, first: load_lanes(array, first)


def bits_of(condition: Any) -> int:
    """Where the condition holds, as an integer of a bit a lane, the first lane's the lowest."""
    return sum(1 << place for place, holds in enumerate(np.atleast_1d(condition)) if holds)


@overload(bits_of)
def _bits_of(condition):
    if isinstance(condition, Mask):
        return lambda condition: mask_bits(condition)
    return lambda condition: np.int64(condition)


def whole(a: Any) -> Any:
    """The number without its fraction, of numbers below 2^31."""
    return np.trunc(a)


@overload(whole)
def _whole(a):
    if isinstance(a, Lanes):
        return lambda a: cut_lanes(a)
    return lambda a: np.trunc(a)


@kernel
def minimum(a, b):
    """The lesser of a and b; b where they are equal."""
    return select(a < b, a, b)


@kernel
def maximum(a, b):
    """The greater of a and b; b where they are equal."""
    return select(a > b, a, b)


@kernel
def clamp(value, low, high):
    """value held between low and high."""
    return maximum(low, minimum(value, high))


@kernel
def absolute(a):
    """|a|"""
    return select(a > const(0.0, a), a, -a)


@kernel
def over(a, b):
    """a / b; 0 where b is 0: what has no mass takes no impulse."""
    zero = const(0.0, b)
    none = b == zero
    return select(none, zero, a / select(none, const(1.0, b), b))
