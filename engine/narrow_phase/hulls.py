"""Convex shapes with corners, all in one form: up to eight points, counter-clockwise, and the normals between them.

A hull lies in scratch: an array (8, 4) of lanes, one row a corner: x, y, and the unit outward normal of the edge that
runs from it to the next. Its caller makes one scratch for each of the two shapes, once, outside its loop, and fills
them for every pair. Corners count from 0:

    box: (+,-) (+,+) (-,+) (-,-), so that edge 0 faces +x, edge 1 +y; capsule and segment: 0 at -x, 1 at +x, with an
    edge below and one above; polygon: as in its table.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const
from engine.narrow_phase.manifold_points import FAR
from engine.vec2 import Vec2, dot, rotate

X, Y, NX, NY = range(4)
CORNERS = 8


class Face(NamedTuple):
    """The edge of a hull that another one is furthest from."""

    index: Any
    separation: Any  # < 0: least overlap [m]


@kernel
def load_hull(hull, scratch):
    """Fills scratch from a row of the hull table; returns the number of corners."""
    lane = scratch[0, X]
    for i in range(hull.count):
        scratch[i, X] = const(hull.x[i], lane)
        scratch[i, Y] = const(hull.y[i], lane)
        scratch[i, NX] = const(hull.nx[i], lane)
        scratch[i, NY] = const(hull.ny[i], lane)
    return hull.count


@kernel
def load_corner(scratch, index, point, normal):
    """Writes one row."""
    scratch[index, X] = point.x
    scratch[index, Y] = point.y
    scratch[index, NX] = normal.x
    scratch[index, NY] = normal.y


@kernel
def load_box(half, scratch):
    """Fills scratch with a box of half extents `half` [m]; returns the number of corners."""
    zero = const(0.0, half.x)
    one = const(1.0, half.x)
    load_corner(scratch, 0, Vec2(half.x, -half.y), Vec2(one, zero))
    load_corner(scratch, 1, Vec2(half.x, half.y), Vec2(zero, one))
    load_corner(scratch, 2, Vec2(-half.x, half.y), Vec2(-one, zero))
    load_corner(scratch, 3, Vec2(-half.x, -half.y), Vec2(zero, -one))
    return 4


@kernel
def load_capsule(half_x, scratch):
    """Fills scratch with the core of a capsule, or a segment, from (-half_x, 0) to (half_x, 0) [m]."""
    zero = const(0.0, half_x)
    one = const(1.0, half_x)
    load_corner(scratch, 0, Vec2(-half_x, zero), Vec2(zero, -one))
    load_corner(scratch, 1, Vec2(half_x, zero), Vec2(zero, one))
    return 2


@kernel
def place_hull(scratch, count, offset, q):
    """Moves a hull to where another frame sees it: turned by q, then shifted by offset [m]."""
    for i in range(count):
        load_corner(scratch, i, offset + rotate(q, corner(scratch, i)), rotate(q, normal_at(scratch, i)))


@kernel
def corner(hull, index):
    """A corner [m]."""
    return Vec2(hull[index, X], hull[index, Y])


@kernel
def normal_at(hull, index):
    """The normal of the edge that begins at a corner."""
    return Vec2(hull[index, NX], hull[index, NY])


@kernel
def after(index, count):
    """The number of the next corner."""
    return 0 if index + 1 == count else index + 1


@kernel
def separation_along(normal, origin, hull, count):
    """How far the nearest corner of a hull lies before the line through `origin` with that normal [m]."""
    least = const(FAR, origin.x)
    for i in range(count):
        least = min(least, dot(normal, corner(hull, i) - origin))
    return least


@kernel
def find_face(hull, count, other, other_count):
    """The edge of a hull from which the other one is furthest; the first of equals."""
    best = Face(0, -const(FAR, hull[0, X]))
    for i in range(count):
        separation = separation_along(normal_at(hull, i), corner(hull, i), other, other_count)
        if separation > best.separation:
            best = Face(i, separation)
    return best


@kernel
def find_facing(hull, count, normal):
    """The edge of a hull that faces a normal most."""
    index = 0
    least = const(FAR, normal.x)
    for i in range(count):
        facing = dot(normal_at(hull, i), normal)
        if facing < least:
            least = facing
            index = i
    return index
