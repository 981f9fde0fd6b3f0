"""A piece of a chain against a convex shape with corners: box, polygon, or capsule.

Separating axes, as for two convex shapes, of the shape and of what the piece knows of the solid: itself, the faces of
the neighbours beyond its convex ends, and the shape's own faces as far as their normals lie between those. Whatever
touches best along a neighbour's face is left to the neighbour; a corner, to the piece that owns it. At a flat or
concave end nothing but the piece's own normal is possible.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, maximum, select
from engine.narrow_phase.chain_piece import JOINT_SLACK, load_piece
from engine.narrow_phase.edges import Meeting, is_apart, meet_edges, place_meeting
from engine.narrow_phase.hull_hull import in_face_frame, see_from
from engine.narrow_phase.hulls import after, corner, find_facing, normal_at, place_hull, separation_along
from engine.narrow_phase.manifold_points import FACE_TOLERANCE, FAR, nothing, pack
from engine.vec2 import Vec2, choose, cross, dot, unrotate


class OnEdge(NamedTuple):
    """What place_meeting wants."""

    meeting: Any
    origin: Vec2
    normal: Vec2
    start: Any
    end: Any
    other_start: Any
    other_end: Any


class Facing(NamedTuple):
    """The face of a shape that lies furthest from an end of the piece, of those that a corner there could touch."""

    index: Any
    separation: Any
    at_start: Any  # whether it is the piece's start


@kernel
def before_its_face(neighbour, hull, count):
    """How far a hull lies before the face beyond a convex end of the piece [m]; else -FAR."""
    if not neighbour.convex:
        return -const(FAR, neighbour.end.x)
    along = neighbour.along
    return separation_along(Vec2(-along.y, along.x), neighbour.end, hull, count)


@kernel
def in_cone(piece, normal, at_start):
    """Whether a normal lies between those of the piece and of its neighbour beyond a convex end."""
    slack = const(JOINT_SLACK, normal.x)
    if at_start:
        return piece.before.convex and dot(piece.before.along, normal) >= -slack
    return piece.after.convex and dot(piece.after.along, normal) <= slack


@kernel
def find_end_face(piece, hull, count):
    """The best of the shape's faces; separation -FAR where none counts."""
    best = Facing(0, -const(FAR, piece.half_x), True)
    for i in range(count):
        out = normal_at(hull, i)
        at_start = out.x > 0
        if out.x != 0 and in_cone(piece, -out, at_start):
            end = piece.before.end if at_start else piece.after.end
            separation = dot(out, end - corner(hull, i))
            if separation > best.separation:
                best = Facing(i, separation, at_start)
    return best


@kernel
def middle_of(hull, count):
    """The mean of a hull's corners [m]."""
    total = corner(hull, 0)
    for i in range(1, count):
        total = total + corner(hull, i)
    return total * (const(1.0, total.x) / const(count, total.x))


@kernel
def without(meeting, first, second):
    """A meeting without its first or its second point."""
    far = const(FAR, meeting.separation1)
    return Meeting(
        meeting.corner,
        meeting.normal,
        meeting.point1,
        select(first, far, meeting.separation1),
        meeting.end1,
        meeting.other1,
        meeting.point2,
        select(second, far, meeting.separation2),
    )


@kernel
def on_chain_face(piece, hull, count, radius, separation, mine, at_start):
    """The shape on the piece's own face (mine), or on the neighbour's beyond its start or end, for the corner alone."""
    zero = const(0.0, radius)
    one = const(1.0, radius)
    slack = const(JOINT_SLACK, radius)
    width = piece.half_x + piece.half_x
    # counter-clockwise round the solid, an edge begins where the chain's piece ends
    if mine:
        normal = Vec2(zero, one)
        start = piece.after.end + Vec2(select(piece.after.convex, zero, slack), zero)
        length = start.x + piece.half_x + select(piece.before.convex, zero, slack)
    elif at_start:
        normal = Vec2(-piece.before.along.y, piece.before.along.x)
        start = piece.before.end
        length = width
    else:
        normal = Vec2(-piece.after.along.y, piece.after.along.x)
        start = piece.after.end + piece.after.along * width
        length = width
    facing = find_facing(hull, count, normal)
    facing_end = after(facing, count)
    a = in_face_frame(corner(hull, facing), start, normal)
    b = in_face_frame(corner(hull, facing_end), start, normal)
    beyond = select(a.x < b.x, a.y, b.y) > zero  # the edge's end rather than its start, if any
    near_start = beyond if mine else at_start  # whether the corner touched would be the piece's start
    convex = piece.before.convex if near_start else piece.after.convex
    meeting = meet_edges(length, a, b, convex and is_apart(separation, radius), zero, radius)
    if meeting.corner:
        out = normal * meeting.normal.x + Vec2(-normal.y, normal.x) * meeting.normal.y
        owned = piece.before.owned if near_start else piece.after.owned
        lost = not (owned and in_cone(piece, out, near_start)) or not (mine or beyond != at_start)
    else:
        lost = not mine
    meeting = without(meeting, lost, lost)
    first = select(mine or not at_start, one, zero)
    second = select(mine or at_start, zero, one)
    return OnEdge(meeting, start, normal, first, second, const(facing, radius), const(facing_end, radius))


@kernel
def on_end_face(piece, hull, count, radius, face):
    """One of the shape's faces on an end of the piece. The other end may be near enough to touch it too."""
    zero = const(0.0, radius)
    one = const(1.0, radius)
    normal = normal_at(hull, face.index)
    start = corner(hull, face.index)
    end = after(face.index, count)
    length = cross(normal, corner(hull, end) - start)
    p1 = in_face_frame(piece.before.end, start, normal)
    p2 = in_face_frame(piece.after.end, start, normal)
    turned = p1.y > p2.y
    a = choose(turned, p1, p2)
    b = choose(turned, p2, p1)
    meeting = meet_edges(length, a, b, is_apart(face.separation, radius), radius, zero)
    out = normal * meeting.normal.x + Vec2(-normal.y, normal.x) * meeting.normal.y
    owned = piece.before.owned if face.at_start else piece.after.owned
    kept = owned and in_cone(piece, -out, face.at_start)
    near_first = turned == face.at_start  # whether point 1 is at the end that the face looks at
    first = not kept and (meeting.corner or near_first or out.y >= zero)
    second = not kept and (not near_first or out.y >= zero)
    theirs = select(turned, zero, one)
    meeting = without(meeting, first, second)
    return OnEdge(meeting, start, normal, const(face.index, radius), const(end, radius), theirs, one - theirs)


@kernel
def is_before(neighbour, middle):
    """Whether a shape's middle lies before the face beyond an end whose corner is the piece's."""
    return neighbour.owned and cross(neighbour.along, middle - neighbour.end) >= 0


@kernel
def collide_chain_hull(half_x, ghost1, ghost2, center1, q1, hull, count, radius, center2, q2, margin):
    """The manifold of a chain's piece (chain_piece.py) and a hull in scratch (hulls.py); see Manifold. Moves the hull.

    A shape whose middle lies behind the piece has come through, and touches its face no more.
    """
    lane = half_x
    piece = load_piece(half_x, ghost1, ghost2)
    place_hull(hull, count, unrotate(q1, center2 - center1), Vec2(dot(q1, q2), cross(q1, q2)))
    own = separation_along(Vec2(const(0.0, lane), const(1.0, lane)), piece.before.end, hull, count)
    theirs1 = before_its_face(piece.before, hull, count)
    theirs2 = before_its_face(piece.after, hull, count)
    theirs = maximum(theirs1, theirs2)
    face = find_end_face(piece, hull, count)
    if maximum(maximum(own, theirs), face.separation) > margin + radius:
        return nothing(maximum(own, face.separation) - radius)
    tolerance = const(FACE_TOLERANCE, lane)
    flip = face.separation > maximum(own, theirs) + tolerance  # the reference edge is the shape's
    mine = theirs <= own + tolerance
    at_start = face.at_start if flip else theirs1 > theirs2
    middle = middle_of(hull, count)
    beside = (flip or not mine) and is_before(piece.before if at_start else piece.after, middle)
    if middle.y < 0 and not beside:
        return nothing(const(0.0, lane))
    if flip:
        found = on_end_face(piece, hull, count, radius, face)
    else:
        found = on_chain_face(piece, hull, count, radius, maximum(own, theirs), mine, at_start)
    edge = (found.start, found.end, found.other_start, found.other_end)
    touch = place_meeting(found.meeting, found.origin, found.normal, flip, *edge, const(0.0, lane))
    return pack(see_from(center1, q1, touch), margin)
