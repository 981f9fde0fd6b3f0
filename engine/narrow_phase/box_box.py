"""Box against box, with a margin: the axis of least penetration, the facing edge clipped, or corner to corner.

The same separating axes as the talk's (box_box_talk.py), but written without a branch, so that it may be
compiled eight wide; it also finds boxes that do not touch yet.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import absolute, const, maximum, select
from engine.narrow_phase.edges import is_apart, meet_edges, place_meeting
from engine.narrow_phase.manifold_points import FACE_TOLERANCE, pack
from engine.vec2 import Vec2, choose, cross, dot, unrotate


class FaceAxes(NamedTuple):
    """The better one of a box's two axes."""

    along_y: Any
    separation: Any  # of the two boxes along it [m]


class BoxEdge(NamedTuple):
    """An edge of a box from a to b, counter-clockwise, and its corners' numbers."""

    a: Vec2
    b: Vec2
    start: Any
    end: Any


@kernel
def better_axis(offset, half, other_half, cosine, sine):
    """Along which of its axes a box is further from another one. offset: of the centres, in its frame [m].

    cosine, sine: absolute values of the rotation from one frame to the other.
    """
    separation_x = absolute(offset.x) - half.x - (cosine * other_half.x + sine * other_half.y)
    separation_y = absolute(offset.y) - half.y - (sine * other_half.x + cosine * other_half.y)
    along_y = separation_y > separation_x + const(FACE_TOLERANCE, half.x)
    return FaceAxes(along_y, select(along_y, separation_y, separation_x))


@kernel
def face_corners(along_y, negative, lane):
    """Numbers of the corners where a box's face begins and ends, as lanes. Faces count +x, +y, -x, -y."""
    zero = const(0.0, lane)
    start = select(along_y, const(1.0, lane), zero) + select(negative, const(2.0, lane), zero)
    end = start + const(1.0, lane)
    return start, select(end > const(3.0, lane), zero, end)


@kernel
def facing_edge(center, axis, half):
    """The edge of a box that faces the x axis most. center: of the box, axis: its own x axis, half: extents [m]."""
    one = const(1.0, half.x)
    along_y = absolute(axis.x) <= absolute(axis.y)
    out = choose(along_y, Vec2(-axis.y, axis.x), axis)
    negative = out.x > 0  # it is the opposite face that looks this way
    out = out * select(negative, -one, one)
    middle = center + out * select(along_y, half.y, half.x)
    reach = Vec2(-out.y, out.x) * select(along_y, half.x, half.y)
    start, end = face_corners(along_y, negative, half.x)
    return BoxEdge(middle - reach, middle + reach, start, end)


@kernel
def touch_boxes(half1, center1, q1, half2, center2, q2):
    """Where two boxes touch, or would, as lanes. half: half extents; center [m]; q: rotations (cosine, sine)."""
    one = const(1.0, half1.x)
    zero = const(0.0, half1.x)
    between = center2 - center1
    offset1 = unrotate(q1, between)
    offset2 = unrotate(q2, -between)
    cosine = dot(q1, q2)
    sine = cross(q1, q2)
    best1 = better_axis(offset1, half1, half2, absolute(cosine), absolute(sine))
    best2 = better_axis(offset2, half2, half1, absolute(cosine), absolute(sine))
    flip = best2.separation > best1.separation + const(FACE_TOLERANCE, one)  # the reference face belongs to box 2
    along_y = select(flip, best2.along_y, best1.along_y)
    clearance = maximum(best1.separation, best2.separation)
    apart = is_apart(clearance, zero)
    q = choose(flip, q2, q1)
    center = choose(flip, center2, center1)
    half = choose(flip, half2, half1)
    other_half = choose(flip, half1, half2)
    offset = choose(flip, offset2, offset1)
    axis = Vec2(cosine, select(flip, -sine, sine))  # the other box's x axis, in this one's frame

    # turned by quarters until the reference face looks along x
    offset = choose(along_y, Vec2(offset.y, -offset.x), offset)
    axis = choose(along_y, Vec2(axis.y, -axis.x), axis)
    normal = choose(along_y, Vec2(-q.y, q.x), q)
    negative = offset.x < zero
    sign = select(negative, -one, one)
    normal = normal * sign
    height = select(along_y, half.y, half.x)
    reach = select(along_y, half.x, half.y)
    start, end = face_corners(along_y, negative, one)
    edge = facing_edge(offset * sign, axis * sign, other_half)
    corner = Vec2(height, -reach)  # where the reference face begins
    meeting = meet_edges(reach + reach, edge.a - corner, edge.b - corner, apart, zero, zero)
    origin = center + normal * height - Vec2(-normal.y, normal.x) * reach
    return place_meeting(meeting, origin, normal, flip, start, end, edge.start, edge.end, clearance)


@kernel
def collide_boxes(half1, center1, q1, half2, center2, q2, margin):
    """The manifold of two boxes; see Manifold. Arguments as touch_boxes, margin [m]: how far apart they may be."""
    return pack(touch_boxes(half1, center1, q1, half2, center2, q2), margin)
