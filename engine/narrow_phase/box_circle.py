"""Box against circle: one contact at the point of the box that is nearest to the circle's centre."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.lanes import absolute, clamp, const
from engine.narrow_phase.circle_circle import FEATURE
from engine.narrow_phase.manifold import add_contact, places_of
from engine.shapes.box import BOX
from engine.shapes.circle import CIRCLE
from engine.vec2 import Vec2, dot, rotate, unrotate


class Nearest(NamedTuple):
    """How a point lies to a box, in the box's frame."""

    point: Vec2  # on the box's surface [m]
    normal: Vec2  # unit, out of the box
    distance: Any  # of the point from the surface, < 0 inside [m]


@kernel
def nearest_on_box(p, half):
    """The point of the surface of a box of half extents `half` that is nearest to p, both in the box's frame [m]."""
    inside = Vec2(clamp(p.x, -half.x, half.x), clamp(p.y, -half.y, half.y))
    away = p - inside
    squared = dot(away, away)
    if squared > 0:
        distance = np.sqrt(squared)
        return Nearest(inside, Vec2(away.x / distance, away.y / distance), distance)
    # p is in the box: out through the nearest face
    zero = const(0.0, p.x)
    one = const(1.0, p.x)
    depth_x = half.x - absolute(p.x)
    depth_y = half.y - absolute(p.y)
    if depth_x < depth_y:
        sign = one if p.x > 0 else -one
        return Nearest(Vec2(sign * half.x, p.y), Vec2(sign, zero), -depth_x)
    sign = one if p.y > 0 else -one
    return Nearest(Vec2(p.x, sign * half.y), Vec2(zero, sign), -depth_y)


@kernel
def collide(count, bodies, motions, arbiters, contacts):
    """Fills the arbiters of all pairs of a box and a circle, in either order; see narrow_phase/__init__.py."""
    for index in range(count):
        arbiter = arbiters[index]
        body1 = bodies[arbiter.body1]
        body2 = bodies[arbiter.body2]
        if body1.shape_kind == BOX and body2.shape_kind == CIRCLE:
            collide_one(index, arbiter, contacts, body1, body2, motions[arbiter.body1], False)
        elif body1.shape_kind == CIRCLE and body2.shape_kind == BOX:
            collide_one(index, arbiter, contacts, body1, body2, motions[arbiter.body2], True)


@kernel
def collide_one(index, arbiter, contacts, body1, body2, box_motion, flip):
    """Fills one arbiter; `flip` where body1 is the circle."""
    lane = box_motion.cosine
    places = places_of(body1, body2, lane)
    box, circle = (body2, body1) if flip else (body1, body2)
    box_center, circle_center = (places.center2, places.center1) if flip else (places.center1, places.center2)
    q = Vec2(box_motion.cosine, box_motion.sine)
    half = Vec2(const(box.half_x, lane), const(box.half_y, lane))
    nearest = nearest_on_box(unrotate(q, circle_center - box_center), half)
    separation = nearest.distance - const(circle.half_x, lane)
    if separation > 0:
        return
    out = rotate(q, nearest.normal)
    normal = -out if flip else out
    arbiter.nx = normal.x
    arbiter.ny = normal.y
    add_contact(arbiter, contacts, index, places, box_center + rotate(q, nearest.point), separation, FEATURE)
