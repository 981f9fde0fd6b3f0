"""Vectors in the plane, for any lane type: the same source runs compiled and as plain Python.

`Vec2` is a NamedTuple, so numba knows it, and its operators are overloaded, so that kernels read like the talk's
formulas. `a + b` on two Vec2 adds them (a plain tuple would be joined). Every operator means the same two or four
multiplications and additions, in the same order, with and without compilation.
"""

from __future__ import annotations

import operator
from typing import Any, NamedTuple

import numpy as np
from numba.core import types
from numba.extending import overload

from engine.jit import kernel
from engine.lanes import select
from engine.simd import Lanes


class Vec2(NamedTuple):
    """A vector (x, y). Outside kernels it also adds and compares with any pair of numbers."""

    x: Any
    y: Any

    def __add__(self, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return np.asarray(tuple(self)) + other
        return Vec2(self.x + other[0], self.y + other[1])

    def __radd__(self, other: Any) -> Any:
        return np.asarray(other) + np.asarray(tuple(self))

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return np.asarray(tuple(self)) - other
        return Vec2(self.x - other[0], self.y - other[1])

    def __rsub__(self, other: Any) -> Any:
        return np.asarray(other) - np.asarray(tuple(self))

    def __mul__(self, scale: Any) -> Any:
        return Vec2(self.x * scale, self.y * scale)

    def __rmul__(self, scale: Any) -> Any:
        return Vec2(scale * self.x, scale * self.y)

    def __neg__(self) -> Vec2:
        return Vec2(-self.x, -self.y)


# numpy scalars and arrays must leave `scalar * vector` to us, or they would make an array of it
Vec2.__array_ufunc__ = None  # type: ignore[attr-defined]


def _is_vec2(value: Any) -> bool:
    return getattr(value, "instance_class", None) is Vec2


def _is_lane(value: Any) -> bool:
    return isinstance(value, (types.Float, Lanes))


@overload(operator.add)
def _add(a, b):
    if _is_vec2(a) and _is_vec2(b):
        return lambda a, b: Vec2(a.x + b.x, a.y + b.y)
    return None


@overload(operator.sub)
def _sub(a, b):
    if _is_vec2(a) and _is_vec2(b):
        return lambda a, b: Vec2(a.x - b.x, a.y - b.y)
    return None


@overload(operator.mul)
def _mul(a, b):
    if _is_vec2(a) and _is_lane(b):
        return lambda a, b: Vec2(a.x * b, a.y * b)
    if _is_lane(a) and _is_vec2(b):
        return lambda a, b: Vec2(a * b.x, a * b.y)
    return None


@overload(operator.neg)
def _neg(a):
    if _is_vec2(a):
        return lambda a: Vec2(-a.x, -a.y)
    return None


@kernel
def dot(a, b):
    """a . b"""
    return a.x * b.x + a.y * b.y


@kernel
def cross(a, b):
    """z component of a x b."""
    return a.x * b.y - a.y * b.x


@kernel
def choose(condition, a, b):
    """The vector a where the condition holds, else b."""
    return Vec2(select(condition, a.x, b.x), select(condition, a.y, b.y))


@kernel
def spin(w, r):
    """Velocity of a point at r of something that turns with w: w x r."""
    return Vec2(-w * r.y, w * r.x)


@kernel
def right_of(a):
    """a turned by -90 degrees: the tangent that belongs to a normal."""
    return Vec2(a.y, -a.x)


@kernel
def rotate(q, a):
    """a turned by the rotation q = (cosine, sine)."""
    return Vec2(q.x * a.x - q.y * a.y, q.y * a.x + q.x * a.y)


@kernel
def unrotate(q, a):
    """a turned back by the rotation q = (cosine, sine)."""
    return Vec2(q.x * a.x + q.y * a.y, q.x * a.y - q.y * a.x)
