"""Box against box: the axis of least penetration, then the incident face clipped to the reference face (the talk)."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.constants import FACE_ABSOLUTE_TOLERANCE, FACE_RELATIVE_TOLERANCE
from engine.jit import kernel
from engine.lanes import absolute, const
from engine.narrow_phase.clip import EDGE1, EDGE2, EDGE3, EDGE4, NO_EDGE, ClipPoint, clip_segment, pack_feature
from engine.narrow_phase.manifold import places_of, write_manifold
from engine.narrow_phase.manifold_points import Manifold
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
def collide(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """Finds the contacts of pairs of two boxes; see narrow_phase/__init__.py."""
    warm_starting = steps[0].warm_starting != 0
    for k in range(first, last):
        index = chosen[k]
        arbiter = arbiters[index]
        places = places_of(arbiter, placements, bodies, placements[arbiter.shape1].cosine)
        place1 = placements[arbiter.shape1]
        place2 = placements[arbiter.shape2]
        shape1 = shapes[arbiter.shape1]
        shape2 = shapes[arbiter.shape2]
        lane = place1.cosine
        half1 = Vec2(const(shape1.half_x, lane), const(shape1.half_y, lane))
        half2 = Vec2(const(shape2.half_x, lane), const(shape2.half_y, lane))
        q1 = Vec2(place1.cosine, place1.sine)
        q2 = Vec2(place2.cosine, place2.sine)
        manifold = collide_boxes(places.shape1, q1, half1, places.shape2, q2, half2)
        write_manifold(index, arbiters, contacts, places, manifold, motions, warm_starting)


@kernel
def collide_boxes(center1, q1, half1, center2, q2, half2):
    """The contacts of two boxes that overlap, on the reference face."""
    touching, axis = find_axis(center2 - center1, q1, half1, q2, half2)
    zero = const(0.0, q1.x)
    nothing = Manifold(0, axis.normal, center1, zero, 0, center1, zero, 0, zero)
    if not touching:
        return nothing

    flip = axis.face >= FACE_2_X  # the reference face belongs to body2
    along_y = axis.face == FACE_1_Y or axis.face == FACE_2_Y
    front_normal = -axis.normal if flip else axis.normal
    center, q, half = (center2, q2, half2) if flip else (center1, q1, half1)
    other_center, other_q, other_half = (center1, q1, half1) if flip else (center2, q2, half2)
    front = dot(center, front_normal) + (half.y if along_y else half.x)
    side = direction(q, not along_y, True)
    incident = incident_edge(other_center, other_q, other_half, front_normal)
    whole, a, b = clip_to_sides(incident, center, half.x if along_y else half.y, side, along_y)
    if not whole:
        return nothing
    separation_a = dot(front_normal, a.v) - front
    separation_b = dot(front_normal, b.v) - front
    on_face_a = a.v - front_normal * separation_a  # slid onto the reference face
    on_face_b = b.v - front_normal * separation_b
    feature_a, feature_b = pack_feature(a, flip), pack_feature(b, flip)
    if separation_a <= 0:
        count = 2 if separation_b <= 0 else 1
        return Manifold(
            count, axis.normal, on_face_a, separation_a, feature_a, on_face_b, separation_b, feature_b, zero
        )
    if separation_b <= 0:
        return Manifold(1, axis.normal, on_face_b, separation_b, feature_b, on_face_b, separation_b, feature_b, zero)
    return nothing
