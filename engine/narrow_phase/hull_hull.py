"""Two convex shapes with corners, each with a rounding radius: boxes, polygons, capsules and segments.

Separating axes over the edges of both; then the edge on which they are furthest apart meets the edge of the other
shape that faces it (edges.py).
"""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.narrow_phase.edges import is_apart, meet_edges, place_meeting
from engine.narrow_phase.hulls import after, corner, find_face, find_facing, normal_at, place_hull
from engine.narrow_phase.manifold_points import FACE_TOLERANCE, Touch, nothing, pack
from engine.vec2 import Vec2, cross, dot, rotate, unrotate


@kernel
def in_face_frame(point, origin, normal):
    """A point as an edge with that start and normal sees it: x along the normal, y along the edge [m]."""
    offset = point - origin
    return Vec2(dot(normal, offset), cross(normal, offset))


@kernel
def touch_at_face(face, apart, hull, count, radius, other, other_count, other_radius, flip):
    """Where an edge of a hull touches the edge of another one that faces it, both hulls in one frame.

    apart: whether the hulls are (is_apart); radius, other_radius: rounding [m]; flip: whether the first of the two
    hulls is that of shape 2.
    """
    normal = normal_at(hull, face)
    start = corner(hull, face)
    end = after(face, count)
    length = cross(normal, corner(hull, end) - start)
    facing = find_facing(other, other_count, normal)
    facing_end = after(facing, other_count)
    a = in_face_frame(corner(other, facing), start, normal)
    b = in_face_frame(corner(other, facing_end), start, normal)
    meeting = meet_edges(length, a, b, apart, radius, other_radius)
    numbers = (const(face, length), const(end, length), const(facing, length), const(facing_end, length))
    return place_meeting(meeting, start, normal, flip, *numbers, const(0.0, length))


@kernel
def see_from(center, q, touch):
    """A touch found in a frame at `center`, turned by q, as the world sees it."""
    return Touch(
        rotate(q, touch.normal),
        center + rotate(q, touch.point1),
        touch.separation1,
        touch.feature1,
        center + rotate(q, touch.point2),
        touch.separation2,
        touch.feature2,
        touch.clearance,
    )


@kernel
def collide_hulls(hull1, count1, radius1, center1, q1, hull2, count2, radius2, center2, q2, margin):
    """The manifold of two hulls in scratch (hulls.py), each in its own frame; see Manifold. Moves the second hull.

    radius1, radius2: rounding; center [m]; q: rotations (cosine, sine); margin: how far apart they may be [m].
    """
    lane = radius1
    place_hull(hull2, count2, unrotate(q1, center2 - center1), Vec2(dot(q1, q2), cross(q1, q2)))
    best1 = find_face(hull1, count1, hull2, count2)
    reach = margin + radius1 + radius2
    if best1.separation > reach:
        return nothing(best1.separation - radius1 - radius2)
    best2 = find_face(hull2, count2, hull1, count1)
    if best2.separation > reach:
        return nothing(best2.separation - radius1 - radius2)
    flip = best2.separation > best1.separation + const(FACE_TOLERANCE, lane)  # the reference edge is hull 2's
    if flip:
        face, hull, count, radius = best2, hull2, count2, radius2
        other, other_count, other_radius = hull1, count1, radius1
    else:
        face, hull, count, radius = best1, hull1, count1, radius1
        other, other_count, other_radius = hull2, count2, radius2
    apart = is_apart(max(best1.separation, best2.separation), radius1 + radius2)
    touch = touch_at_face(face.index, apart, hull, count, radius, other, other_count, other_radius, flip)
    return pack(see_from(center1, q1, touch), margin)
