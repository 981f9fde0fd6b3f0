"""Two edges face each other: where their shapes touch. The core of every collider of shapes with corners.

The reference edge's frame: x along its outward normal, y along the edge, counter-clockwise round its shape; the edge
runs from (0, 0) to (0, length). The incident edge, the other shape's that faces it most, runs from a to b, also
counter-clockwise, hence the other way: a.y >= b.y.

         b <-------- a        ^ x, the normal
    (0, 0) --------> (0, length)     --> y

Each shape is its edges' core grown by a radius, which may be zero.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, select, sqrt
from engine.narrow_phase.manifold_points import CORNER_GAP, FAR, ROUNDING, TINY, Touch, feature_of
from engine.vec2 import Vec2, choose, dot


class Meeting(NamedTuple):
    """Where two edges meet, in the reference edge's frame. Point 1 is at the edge's end, point 2 at its start."""

    corner: Any  # whether the two touch by their corners (in point 1 alone)
    normal: Vec2  # (1, 0), or from corner to corner
    point1: Vec2  # [m]
    separation1: Any  # FAR: not there [m]
    end1: Any  # 1 where point 1 is at the reference edge's end, 0 at its start
    other1: Any  # 1 where it is at the incident edge's end b, 0 at its start a
    point2: Vec2
    separation2: Any


class Corners(NamedTuple):
    """The ends of two edges that lie nearest to each other."""

    meet: Any  # whether it is by them that the shapes are nearest
    normal: Vec2  # unit
    foot: Vec2  # on the reference edge [m]
    distance: Any  # of the cores, along the normal [m]
    end: Any  # as in Meeting
    other: Any


@kernel
def is_apart(separation, radii):
    """Whether cores with that separation along the best face are apart: then corners may touch corners."""
    sharp = separation > const(CORNER_GAP, separation)
    return select(radii > 0, separation > const(-ROUNDING, separation), sharp)


@kernel
def find_corners(length, a, b, apart, missed, rounded):
    """The corner of the incident edge nearest to the reference's line, and the reference's corner nearest to that.

    They decide where the first lies beyond the edge's ends and the second does not face the incident edge's inner
    part. Where the edges pass each other by (`missed`) they must, lest rounded shapes lose each other.
    """
    zero = const(0.0, length)
    one = const(1.0, length)
    nearer = a.x < b.x
    q = choose(nearer, a, b)
    p = choose(nearer, b, a)
    foot = Vec2(zero, clamp(q.y, zero, length))
    edge = p - q
    along = dot(foot - q, edge)
    t = clamp(along / maximum(dot(edge, edge), const(TINY, length)), zero, one)
    away = q + edge * t - foot
    squared = dot(away, away)
    distance = sqrt(squared)
    safe = maximum(distance, const(TINY, length))
    # cores that overlap do not pass each other by so far: rounding hid that they are apart
    far = missed & (distance > const(CORNER_GAP, length))
    slanted = (apart & (distance > const(ROUNDING, length))) | far
    normal = choose(slanted, Vec2(away.x / safe, away.y / safe), Vec2(one, zero))
    beyond = (q.y > length) | (q.y < zero)
    meet = beyond & (missed | (along <= zero)) & (apart | (rounded & missed))
    reach = select(slanted, distance, away.x)
    is_end = select(nearer, zero, one)
    other = select(t > const(0.5, length), one - is_end, is_end)
    return Corners(meet, normal, foot, reach, select(q.y > zero, one, zero), other)


@kernel
def meet_edges(length, a, b, apart, radius, other_radius):
    """Where a reference edge and an incident edge touch; see the top of this file.

    apart: whether their cores are (is_apart); radius, other_radius: of the reference's and the incident's shape [m].
    """
    zero = const(0.0, length)
    one = const(1.0, length)
    half = const(0.5, length)
    far = const(FAR, length)
    radii = radius + other_radius
    rounded = radii > zero
    # the incident edge, clipped to what lies over the reference edge
    inverse = one / maximum(a.y - b.y, const(TINY, length))
    high = a + (b - a) * clamp((a.y - length) * inverse, zero, one)
    low = b + (a - b) * clamp(-b.y * inverse, zero, one)
    # sharp corners side by side do not touch; round ones must, where neither is beyond the other
    missed = select(rounded, (b.y > length) | (a.y < zero), (b.y >= length) | (a.y <= zero))
    corners = find_corners(length, a, b, apart, missed, rounded)

    normal = choose(corners.meet, corners.normal, Vec2(one, zero))
    offset = radius - other_radius
    point1 = choose(
        corners.meet,
        corners.foot + corners.normal * (half * (corners.distance + offset)),
        Vec2(half * (high.x + offset), high.y),
    )
    point2 = Vec2(half * (low.x + offset), low.y)
    separation1 = select(corners.meet, corners.distance - radii, select(missed, far, high.x - radii))
    separation2 = select(corners.meet | missed, far, low.x - radii)
    end1 = select(corners.meet, corners.end, one)
    other1 = select(corners.meet, corners.other, zero)
    return Meeting(corners.meet, normal, point1, separation1, end1, other1, point2, separation2)


@kernel
def place_meeting(meeting, origin, normal, flip, start, end, other_start, other_end, clearance):
    """A meeting as seen from outside.

    origin: the reference edge's start; normal: its normal; flip: whether it belongs to shape 2; start, end: numbers of
    its corners; other_start, other_end: those of the incident edge's (all lanes); clearance: see Manifold.
    """
    zero = const(0.0, meeting.separation1)
    side = Vec2(-normal.y, normal.x)
    out = normal * meeting.normal.x + side * meeting.normal.y
    mine = select(meeting.end1 > zero, end, start)
    theirs = select(meeting.other1 > zero, other_end, other_start)
    return Touch(
        choose(flip, -out, out),
        origin + normal * meeting.point1.x + side * meeting.point1.y,
        meeting.separation1,
        feature_of(select(flip, theirs, mine), select(flip, mine, theirs)),
        origin + normal * meeting.point2.x + side * meeting.point2.y,
        meeting.separation2,
        feature_of(select(flip, other_end, start), select(flip, start, other_end)),
        clearance,
    )
