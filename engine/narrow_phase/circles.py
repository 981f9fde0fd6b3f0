"""A circle against a circle, a box, or a capsule: one point on the line from the nearest point to its centre."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import absolute, clamp, const, maximum, select, sqrt
from engine.narrow_phase.manifold_points import TINY, one_point, pack
from engine.vec2 import Vec2, choose, dot, rotate, unrotate

COINCIDENT = 1e-15
"""Points nearer than this are one [m]: the square of a smaller distance loses its digits in single precision."""


@kernel
def round_touch(point, radius, center, other_radius, fallback):
    """A circle about `center` and a disc about `point`, or whatever is nearest to it there.

    fallback: unit normal where the two coincide.
    """
    offset = center - point
    distance = sqrt(dot(offset, offset))
    safe = maximum(distance, const(TINY, distance))
    apart = distance > const(COINCIDENT, distance)
    normal = choose(apart, Vec2(offset.x / safe, offset.y / safe), fallback)
    middle = const(0.5, distance) * (distance + radius - other_radius)  # midway between the two surfaces
    return one_point(normal, point + normal * middle, distance - radius - other_radius)


@kernel
def touch_circles(radius1, center1, radius2, center2):
    """Where two circles touch, as lanes [m]; centre on centre: straight up."""
    up = Vec2(const(0.0, radius1), const(1.0, radius1))
    return round_touch(center1, radius1, center2, radius2, up)


@kernel
def touch_capsule_circle(half_x, radius1, center1, q1, radius2, center2):
    """Where a capsule (half distance of its two centres, radius) and a circle touch, as lanes [m]."""
    seen = unrotate(q1, center2 - center1)
    nearest = clamp(seen.x, -half_x, half_x)
    up = Vec2(-q1.y, q1.x)
    return round_touch(center1 + q1 * nearest, radius1, center2, radius2, up)


@kernel
def touch_box_circle(half, center1, q1, radius, center2):
    """Where a box and a circle touch, as lanes [m]; from inside through the nearest face."""
    zero = const(0.0, radius)
    one = const(1.0, radius)
    seen = unrotate(q1, center2 - center1)
    sign = Vec2(select(seen.x < zero, -one, one), select(seen.y < zero, -one, one))
    # in the quarter of the box where the centre is
    excess = Vec2(absolute(seen.x) - half.x, absolute(seen.y) - half.y)
    away = Vec2(maximum(excess.x, zero), maximum(excess.y, zero))
    beyond = sqrt(dot(away, away))
    safe = maximum(beyond, const(TINY, radius))
    outside = beyond > const(COINCIDENT, radius)
    through_x = excess.x > excess.y
    face = Vec2(select(through_x, one, zero), select(through_x, zero, one))
    out = choose(outside, Vec2(away.x / safe, away.y / safe), face)
    distance = select(outside, beyond, maximum(excess.x, excess.y))
    normal = rotate(q1, Vec2(out.x * sign.x, out.y * sign.y))
    # from the circle's centre back to midway between the two surfaces
    back = const(0.5, radius) * (distance + radius)
    return one_point(normal, center2 - normal * back, distance - radius)


@kernel
def collide_circles(radius1, center1, radius2, center2, margin):
    """The manifold of two circles; see Manifold."""
    return pack(touch_circles(radius1, center1, radius2, center2), margin)


@kernel
def collide_capsule_circle(half_x, radius1, center1, q1, radius2, center2, margin):
    """The manifold of a capsule or (radius 0) a segment and a circle; see Manifold."""
    return pack(touch_capsule_circle(half_x, radius1, center1, q1, radius2, center2), margin)


@kernel
def collide_box_circle(half, center1, q1, radius, center2, margin):
    """The manifold of a box and a circle; see Manifold."""
    return pack(touch_box_circle(half, center1, q1, radius, center2), margin)
