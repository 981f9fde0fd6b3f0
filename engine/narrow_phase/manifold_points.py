"""What a collider of two shapes finds: a normal and at most two points.

All their numbers are lanes, features and counts too, so that a collider may be compiled eight wide: it answers with a
`Touch`, of which `pack` takes the points that are near enough.

A *feature* recognises a point in the next step: the corner of shape 1 in the low byte, that of shape 2 above it, which
lie nearest to each other at this end of the contact. Sliding changes which of the two corners really bounds the
contact, and a small turn which of the two faces is the reference; the pair of corners stays the same through both.
Corners count as in narrow_phase/hulls.py; a round shape has corner 0 only.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, select, whole
from engine.vec2 import Vec2, choose

FAR = 1e30
"""Separation of a point that there is not [m]."""

TINY = 1e-20
"""Least divisor: lengths below it are zero to every shape [m or m^2]."""

FACE_TOLERANCE = 5e-4
"""A face replaces the one looked at before it only if the shapes are further apart along it by this [m]: a tenth of a
usual overlap. Zero: of two equally good faces a rounding error takes one and then the other, and impulses are lost."""

CORNER_GAP = 5e-4
"""Sharp corners nearer than this [m] are no pair of corners but belong to faces. Smaller: the direction between two
corners that all but coincide is rounding error."""

ROUNDING = 1e-6
"""Overlap of flat cores that may be rounding error [m]: two segments in one line, end to end, separate along neither
one's normal."""

CORNER2 = 256.0  # what a corner of shape 2 counts in a feature


class Manifold(NamedTuple):
    """Up to two points where two shapes touch, or nearly. Of the points from `count` on nothing is said."""

    count: Any  # 0, 1 or 2, as a lane
    normal: Vec2  # unit, from shape 1 to shape 2
    point1: Vec2  # midway between the two surfaces, in the frame of the centres given [m]
    separation1: Any  # < 0: overlap [m]
    feature1: Any  # a whole number
    point2: Vec2
    separation2: Any
    feature2: Any
    clearance: Any  # the shapes are this far apart at least, where no point is near enough; 0: nothing is known [m]


class Touch(NamedTuple):
    """The same before it is known what is near enough: a point that there is not has separation FAR."""

    normal: Vec2
    point1: Vec2
    separation1: Any
    feature1: Any
    point2: Vec2
    separation2: Any
    feature2: Any
    clearance: Any


@kernel
def feature_of(corner1, corner2):
    """The feature of a pair of corners, all lanes."""
    return corner1 + const(CORNER2, corner2) * corner2


@kernel
def one_point(normal, point, separation):
    """A touch in one point, of shapes of which one at least is round."""
    zero = const(0.0, separation)
    return Touch(normal, point, separation, zero, point, const(FAR, separation), zero, separation)


@kernel
def pack(touch, margin):
    """The manifold: the points with separation <= margin [m], the first of them first."""
    near1 = touch.separation1 <= margin
    near2 = touch.separation2 <= margin
    zero = const(0.0, touch.separation1)
    one = const(1.0, zero)
    second = (touch.separation1 > margin) & near2
    return Manifold(
        select(near1, one, zero) + select(near2, one, zero),
        touch.normal,
        choose(second, touch.point2, touch.point1),
        select(second, touch.separation2, touch.separation1),
        select(second, touch.feature2, touch.feature1),
        touch.point2,
        touch.separation2,
        touch.feature2,
        touch.clearance,
    )


@kernel
def nothing(clearance):
    """The manifold of shapes that are too far apart to matter: by so much at least, 0 if that is not known [m]."""
    lane = clearance
    zero = const(0.0, lane)
    nowhere = Vec2(zero, zero)
    far = const(FAR, lane)
    return Manifold(zero, Vec2(zero, const(1.0, lane)), nowhere, far, zero, nowhere, far, zero, clearance)


@kernel
def mirrored(manifold):
    """The manifold of the same shapes in the other order."""
    m = manifold
    return Manifold(
        m.count, -m.normal, m.point1, m.separation1, swapped(m.feature1), m.point2, m.separation2, swapped(m.feature2),
        m.clearance,
    )  # fmt: skip


@kernel
def mirrored_where(flip, manifold):
    """The manifold, of the same shapes in the other order where `flip` holds."""
    m, n = manifold, mirrored(manifold)
    return Manifold(
        m.count, choose(flip, n.normal, m.normal), m.point1, m.separation1, select(flip, n.feature1, m.feature1),
        m.point2, m.separation2, select(flip, n.feature2, m.feature2), m.clearance,
    )  # fmt: skip


@kernel
def swapped(feature):
    """A feature with the corners of the two shapes exchanged."""
    other = const(CORNER2, feature)
    high = whole(feature / other)
    return high + other * (feature - other * high)
