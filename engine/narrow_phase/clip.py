"""Clipping a segment, with a memory of which edges made each end: the talk's clipping, used by box_box_talk.

A feature is what recognises a contact in the next step: four edge numbers (0: none, 1 to 4: an edge of a box,
counter-clockwise from its top), the edges of the reference box (in, out) and of the incident box (in, out) that meet
in the point, packed into one integer of four bits each:

        ^ y
        |
        e1
   v2 ------ v1
    |        |
 e2 |        | e4  --> x
    |        |
   v3 ------ v4
        e3
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.vec2 import Vec2, dot

NO_EDGE, EDGE1, EDGE2, EDGE3, EDGE4 = range(5)


class ClipPoint(NamedTuple):
    """An end of the segment, and the four edges that made it."""

    v: Vec2
    in1: Any
    out1: Any
    in2: Any
    out2: Any


@kernel
def pack_feature(point, flip):
    """The point's feature; with `flip` the two boxes change places (body1 was the incident one)."""
    if flip:
        return point.in2 | point.out2 << 4 | point.in1 << 8 | point.out1 << 12
    return point.in1 | point.out1 << 4 | point.in2 << 8 | point.out2 << 12


@kernel
def cut(a, b, distance_a, distance_b, edge):
    """The point where the segment a b crosses the line, at signed distances of unequal sign from it."""
    v = a.v + (b.v - a.v) * (distance_a / (distance_a - distance_b))
    if distance_a > distance_b:  # a lies outside and is what the line replaces
        return ClipPoint(v, edge, a.out1, NO_EDGE, a.out2)
    return ClipPoint(v, b.in1, edge, b.in2, NO_EDGE)


@kernel
def clip_segment(a, b, normal, offset, edge):
    """Keeps the part of the segment a b with normal . v <= offset.

    Returns (whole, p, q): whole is False if fewer than two points remain. Points inside come first, the cut last.
    """
    distance_a = dot(normal, a.v) - offset
    distance_b = dot(normal, b.v) - offset
    a_inside = distance_a <= 0
    b_inside = distance_b <= 0
    if a_inside and b_inside:
        return True, a, b
    if distance_a * distance_b < 0:
        crossing = cut(a, b, distance_a, distance_b, edge)
        return True, a if a_inside else b, crossing
    return False, a, b
