"""A polygon against a circle: the nearest edge, or the nearest corner."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const
from engine.narrow_phase.circles import round_touch
from engine.narrow_phase.hulls import after, corner, normal_at
from engine.narrow_phase.manifold_points import FAR, nothing, one_point, pack
from engine.vec2 import Vec2, cross, dot, rotate, unrotate


@kernel
def collide_hull_circle(hull, count, radius1, center1, q1, radius2, center2, margin):
    """The manifold of a hull in scratch (hulls.py), rounded by radius1, and a circle; see Manifold."""
    lane = radius1
    zero = const(0.0, lane)
    seen = unrotate(q1, center2 - center1)
    face = 0
    height = -const(FAR, lane)
    for i in range(count):
        above = dot(normal_at(hull, i), seen - corner(hull, i))
        if above > height:
            height = above
            face = i
    if height > margin + radius1 + radius2:
        return nothing(height - radius1 - radius2)
    normal = normal_at(hull, face)
    start = corner(hull, face)
    length = cross(normal, corner(hull, after(face, count)) - start)
    along = cross(normal, seen - start)
    foot = center1 + rotate(q1, start + Vec2(-normal.y, normal.x) * clamp(along, zero, length))
    out = rotate(q1, normal)
    if height > zero and (along < zero or along > length):
        return pack(round_touch(foot, radius1, center2, radius2, out), margin)
    middle = const(0.5, lane) * (height + radius1 - radius2)
    return pack(one_point(out, foot + out * middle, height - radius1 - radius2), margin)
