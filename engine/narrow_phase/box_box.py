"""Box against box: the axis of least penetration, then the incident face clipped to the reference face (the talk)."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.constants import FACE_ABSOLUTE_TOLERANCE, FACE_RELATIVE_TOLERANCE
from engine.jit import kernel
from engine.lanes import absolute, const
from engine.narrow_phase.clip import EDGE1, EDGE2, EDGE3, EDGE4, NO_EDGE, ClipPoint, clip_segment, pack_feature
from engine.narrow_phase.manifold import add_contact, places_of
from engine.shapes.box import BOX
from engine.vec2 import Vec2, dot, rotate, unrotate

FACE_1_X, FACE_1_Y, FACE_2_X, FACE_2_Y = range(4)


class Axis(NamedTuple):
    """A face normal along which two boxes overlap least."""

    face: Any
    separation: Any
    normal: Vec2  # unit, from body1 to body2


@kernel
def direction(q, along_y, positive):
    """The x or y axis of the rotation q, or its opposite."""
    axis = Vec2(-q.y, q.x) if along_y else q
    return axis if positive else -axis


@kernel
def beats(candidate, best, half):
    """Whether an axis is so much better than the one found before it that it should replace it."""
    relative = const(FACE_RELATIVE_TOLERANCE, candidate)
    return candidate > relative * best + const(FACE_ABSOLUTE_TOLERANCE, candidate) * half


@kernel
def find_axis(offset, q1, half1, q2, half2):
    """The axis of least penetration among the four face normals.

    offset: from centre 1 to centre 2 [m]; q: rotations (cosine, sine); half: half extents [m].
    Returns (touching, axis). Separating axes, as in the talk: of two equal faces the earlier one stays.
    """
    d1 = unrotate(q1, offset)
    d2 = unrotate(q2, offset)
    # absolute values of the rotation from frame 2 to frame 1
    cc = absolute(q1.x * q2.x + q1.y * q2.y)
    cs = absolute(q1.x * q2.y - q1.y * q2.x)
    sep1_x = absolute(d1.x) - half1.x - (cc * half2.x + cs * half2.y)
    sep1_y = absolute(d1.y) - half1.y - (cs * half2.x + cc * half2.y)
    sep2_x = absolute(d2.x) - (cc * half1.x + cs * half1.y) - half2.x
    sep2_y = absolute(d2.y) - (cs * half1.x + cc * half1.y) - half2.y

    face = FACE_1_X
    separation = sep1_x
    if beats(sep1_y, separation, half1.y):
        face = FACE_1_Y
        separation = sep1_y
    if beats(sep2_x, separation, half2.x):
        face = FACE_2_X
        separation = sep2_x
    if beats(sep2_y, separation, half2.y):
        face = FACE_2_Y
        separation = sep2_y

    along_y = face in (FACE_1_Y, FACE_2_Y)
    of_first = face in (FACE_1_X, FACE_1_Y)
    d = d1 if of_first else d2
    normal = direction(q1 if of_first else q2, along_y, (d.y if along_y else d.x) > 0)
    touching = sep1_x <= 0 and sep1_y <= 0 and sep2_x <= 0 and sep2_y <= 0
    return touching, Axis(face, separation, normal)


@kernel
def incident_edge(center, q, half, reference_normal):
    """The edge of a box that faces the reference normal most: two points, counter-clockwise."""
    n = -unrotate(q, reference_normal)
    if absolute(n.x) > absolute(n.y):
        if n.x > 0:
            p, before, shared, after = Vec2(half.x, -half.y), EDGE3, EDGE4, EDGE1
        else:
            p, before, shared, after = Vec2(-half.x, half.y), EDGE1, EDGE2, EDGE3
        other = Vec2(p.x, -p.y)
    else:
        if n.y > 0:
            p, before, shared, after = Vec2(half.x, half.y), EDGE4, EDGE1, EDGE2
        else:
            p, before, shared, after = Vec2(-half.x, -half.y), EDGE2, EDGE3, EDGE4
        other = Vec2(-p.x, p.y)
    first = ClipPoint(center + rotate(q, p), NO_EDGE, NO_EDGE, before, shared)
    second = ClipPoint(center + rotate(q, other), NO_EDGE, NO_EDGE, shared, after)
    return first, second


@kernel
def clip_to_sides(incident, center, half, side, along_y):
    """Clips the incident edge to the two side planes of the reference face, whose box has its centre at `center`.

    side: unit vector along the face; half: the face's half length [m]. Returns (whole, p, q) as clip_segment does.
    """
    a, b = incident
    # the sides of an x face are the edges 3 and 1, those of a y face 2 and 4
    negative_edge = EDGE2 if along_y else EDGE3
    positive_edge = EDGE4 if along_y else EDGE1
    middle = dot(center, side)
    whole, a, b = clip_segment(a, b, -side, half - middle, negative_edge)
    if not whole:
        return False, a, b
    return clip_segment(a, b, side, half + middle, positive_edge)


@kernel
def collide(count, bodies, motions, arbiters, contacts):
    """Fills the arbiters of all pairs of two boxes; see narrow_phase/__init__.py."""
    for index in range(count):
        arbiter = arbiters[index]
        body1 = bodies[arbiter.body1]
        body2 = bodies[arbiter.body2]
        if body1.shape_kind == BOX and body2.shape_kind == BOX:
            collide_boxes(index, arbiter, contacts, body1, body2, motions[arbiter.body1], motions[arbiter.body2])


@kernel
def collide_boxes(index, arbiter, contacts, body1, body2, motion1, motion2):
    """Fills one arbiter."""
    lane = motion1.cosine
    places = places_of(body1, body2, lane)
    q1 = Vec2(motion1.cosine, motion1.sine)
    q2 = Vec2(motion2.cosine, motion2.sine)
    half1 = Vec2(const(body1.half_x, lane), const(body1.half_y, lane))
    half2 = Vec2(const(body2.half_x, lane), const(body2.half_y, lane))
    touching, axis = find_axis(places.center2 - places.center1, q1, half1, q2, half2)
    if not touching:
        return

    flip = axis.face >= FACE_2_X  # the reference face belongs to body2
    along_y = axis.face == FACE_1_Y or axis.face == FACE_2_Y
    front_normal = -axis.normal if flip else axis.normal
    center, q, half = (places.center2, q2, half2) if flip else (places.center1, q1, half1)
    other_center, other_q, other_half = (places.center1, q1, half1) if flip else (places.center2, q2, half2)
    front = dot(center, front_normal) + (half.y if along_y else half.x)
    side = direction(q, not along_y, True)
    incident = incident_edge(other_center, other_q, other_half, front_normal)
    whole, a, b = clip_to_sides(incident, center, half.x if along_y else half.y, side, along_y)
    if not whole:
        return
    arbiter.nx = axis.normal.x
    arbiter.ny = axis.normal.y
    for point in (a, b):
        separation = dot(front_normal, point.v) - front
        if separation <= 0:
            on_face = point.v - front_normal * separation  # slid onto the reference face
            add_contact(arbiter, contacts, index, places, on_face, separation, pack_feature(point, flip))
