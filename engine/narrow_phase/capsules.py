"""A capsule or segment against a capsule or segment: two edges each, front and back.

Separating axes are the two normals. They separate any two segments that do not cross, except in one line end to end:
there the corners do (edges.py).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, maximum, minimum, select
from engine.narrow_phase.edges import is_apart, meet_edges, place_meeting
from engine.narrow_phase.manifold_points import FACE_TOLERANCE, pack
from engine.vec2 import Vec2, choose, cross, dot, unrotate


class Side(NamedTuple):
    """On which side of a segment another one lies."""

    separation: Any  # of the two along the normal there [m]
    below: Any  # on the side of (0, -1), in the segment's frame


@kernel
def side_of(offset, rise):
    """offset: centre of the other segment, in this one's frame; rise: how far its end lies above its centre [m]."""
    high = maximum(offset.y - rise, offset.y + rise)
    low = minimum(offset.y - rise, offset.y + rise)
    below = -high > low
    return Side(select(below, -high, low), below)


@kernel
def touch_capsules(half1, radius1, center1, q1, half2, radius2, center2, q2):
    """Where two capsules touch, as lanes. half: half the distance of its two centres; radius [m], 0: a segment."""
    zero = const(0.0, half1)
    one = const(1.0, half1)
    between = center2 - center1
    offset1 = unrotate(q1, between)
    offset2 = unrotate(q2, -between)
    cosine = dot(q1, q2)
    sine = cross(q1, q2)
    side1 = side_of(offset1, half2 * sine)
    side2 = side_of(offset2, half1 * sine)
    flip = side2.separation > side1.separation + const(FACE_TOLERANCE, half1)  # the reference is capsule 2
    below = select(flip, side2.below, side1.below)
    half = select(flip, half2, half1)
    other_half = select(flip, half1, half2)
    offset = choose(flip, offset2, offset1)
    axis = choose(flip, q2, q1)
    center = choose(flip, center2, center1)
    other_axis = Vec2(cosine, select(flip, -sine, sine))

    # turned until the normal looks along x: by a quarter forth where it is (0, -1), else back
    sign = select(below, -one, one)
    offset = Vec2(offset.y, -offset.x) * sign
    reach = Vec2(other_axis.y, -other_axis.x) * (sign * other_half)
    # the incident edge runs against the reference edge: from its end b to its start a if that goes up
    up = reach.y > zero
    a = offset + choose(up, reach, -reach)
    b = offset - choose(up, reach, -reach)
    start = Vec2(zero, half)
    meeting = meet_edges(
        half + half,
        a + start,
        b + start,
        is_apart(maximum(side1.separation, side2.separation), radius1 + radius2),
        select(flip, radius2, radius1),
        select(flip, radius1, radius2),
    )
    normal = Vec2(-axis.y, axis.x) * sign
    origin = center + axis * (half * sign)
    first = select(below, zero, one)  # the edge below runs from corner 0 to 1, the one above back
    other_first = select(up, one, zero)
    clearance = maximum(side1.separation, side2.separation) - (radius1 + radius2)
    return place_meeting(meeting, origin, normal, flip, first, one - first, other_first, one - other_first, clearance)


@kernel
def collide_capsules(half1, radius1, center1, q1, half2, radius2, center2, q2, margin):
    """The manifold of two capsules, or of a capsule and a segment (radius 0); see Manifold."""
    return pack(touch_capsules(half1, radius1, center1, q1, half2, radius2, center2, q2), margin)
