"""Circle against circle: one contact on the line between the centres."""

from __future__ import annotations

import numpy as np

from engine.constants import COINCIDENT
from engine.jit import kernel
from engine.lanes import const
from engine.narrow_phase.manifold import add_contact, places_of
from engine.shapes.circle import CIRCLE
from engine.vec2 import Vec2, dot

FEATURE = 0  # two circles touch in one way only


@kernel
def unit(vector, length):
    """The vector's direction; straight up where it has none."""
    if length > const(COINCIDENT, length):
        return Vec2(vector.x / length, vector.y / length)
    return Vec2(const(0.0, length), const(1.0, length))


@kernel
def collide(count, bodies, motions, arbiters, contacts):
    """Fills the arbiters of all pairs of two circles; see narrow_phase/__init__.py."""
    for index in range(count):
        arbiter = arbiters[index]
        body1 = bodies[arbiter.body1]
        body2 = bodies[arbiter.body2]
        if body1.shape_kind == CIRCLE and body2.shape_kind == CIRCLE:
            lane = motions[arbiter.body1].cosine
            radius1 = const(body1.half_x, lane)
            radius2 = const(body2.half_x, lane)
            places = places_of(body1, body2, lane)
            offset = places.center2 - places.center1
            distance = np.sqrt(dot(offset, offset))
            separation = distance - radius1 - radius2
            if separation <= 0:
                normal = unit(offset, distance)
                middle = const(0.5, lane) * (radius1 + distance - radius2)  # midway between the two surfaces
                arbiter.nx = normal.x
                arbiter.ny = normal.y
                add_contact(arbiter, contacts, index, places, places.center1 + normal * middle, separation, FEATURE)
