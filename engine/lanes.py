"""What a kernel may do to a lane, whatever its width, beyond + - * / and comparison.

A lane is one float32 or one float64. No bare literal may meet one: to numba `float32 * 0.5` is a float64, to numpy it
is a float32, and the compiled and the plain engine would part ways. `const(0.5, lane)` is the literal in the lane's
own width.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.core import types
from numba.extending import overload

from engine.jit import kernel


def const(value: float, lane: Any) -> Any:
    """The number `value` in the width of `lane`."""
    return type(lane)(value)


@overload(const)
def _const(value, lane):
    if lane == types.float32:
        return lambda value, lane: np.float32(value)
    if lane == types.float64:
        return lambda value, lane: np.float64(value)
    return None


@kernel
def select(condition, a, b):
    """a where the condition holds, else b."""
    return a if condition else b


@kernel
def minimum(a, b):
    """The lesser of a and b; b where they are equal."""
    return a if a < b else b


@kernel
def maximum(a, b):
    """The greater of a and b; b where they are equal."""
    return a if a > b else b


@kernel
def clamp(value, low, high):
    """value held between low and high."""
    return maximum(low, minimum(value, high))


@kernel
def absolute(a):
    """|a|"""
    return a if a > const(0.0, a) else -a


@kernel
def over(a, b):
    """a / b; 0 where b is 0: what has no mass takes no impulse."""
    zero = const(0.0, b)
    none = b == zero
    return select(none, zero, a / select(none, const(1.0, b), b))
