"""From where two shapes are to the contacts of their arbiter."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.lanes import const
from engine.origin import origin_of
from engine.vec2 import Vec2


class Places(NamedTuple):
    """Where two shapes and the centres of mass of their bodies are."""

    origin: Vec2  # what all else is reckoned from, float64 [m]
    shape1: Any  # Vec2 of lanes [m]
    shape2: Any
    mass1: Any
    mass2: Any


@kernel
def seen_from(origin, x, y, lane):
    """A point of the world as seen from the origin, in the lane's width [m]."""
    return Vec2(const(x - origin.x, lane), const(y - origin.y, lane))


@kernel
def places_of(arbiter, placements, bodies):
    """Where the two shapes of an arbiter are, in the solver's precision."""
    place1 = placements[arbiter.shape1]
    place2 = placements[arbiter.shape2]
    body1 = bodies[arbiter.body1]
    body2 = bodies[arbiter.body2]
    lane = place1.cosine
    origin = origin_of(body1, lane)
    return Places(
        origin,
        seen_from(origin, place1.x, place1.y, lane),
        seen_from(origin, place2.x, place2.y, lane),
        seen_from(origin, body1.center_x, body1.center_y, lane),
        seen_from(origin, body2.center_x, body2.center_y, lane),
    )


@kernel
def write_point(contact, places, point, separation, feature):
    """Writes where a contact is; its impulses begin at zero."""
    contact.x = places.origin.x + point.x
    contact.y = places.origin.y + point.y
    contact.feature = feature
    r1 = point - places.mass1
    r2 = point - places.mass2
    contact.r1_x = r1.x
    contact.r1_y = r1.y
    contact.r2_x = r2.x
    contact.r2_y = r2.y
    contact.separation = separation
    contact.found = separation
    contact.found1_x = r1.x
    contact.found1_y = r1.y
    contact.found2_x = r2.x
    contact.found2_y = r2.y
    contact.normal_impulse = 0
    contact.tangent_impulse = 0


@kernel
def write_manifold(index, arbiters, contacts, places, manifold, motions, warm_starting):
    """Writes what a collider found; a contact whose feature was there in the step before keeps its impulses."""
    arbiter = arbiters[index]
    old_count = arbiter.count
    old1 = contacts[index, 0]
    old2 = contacts[index, 1]
    feature1, normal1, tangent1 = old1.feature, old1.normal_impulse, old1.tangent_impulse
    feature2, normal2, tangent2 = old2.feature, old2.normal_impulse, old2.tangent_impulse

    count = manifold.count
    arbiter.count = count
    if count > 0:
        arbiter.nx = manifold.normal.x
        arbiter.ny = manifold.normal.y
        write_point(contacts[index, 0], places, manifold.point1, manifold.separation1, manifold.feature1)
        if count > 1:
            write_point(contacts[index, 1], places, manifold.point2, manifold.separation2, manifold.feature2)
    if count == 0 or old_count == 0 or not warm_starting:
        arbiter.rolling_impulse = 0
    if warm_starting:
        for i in range(count):
            contact = contacts[index, i]
            if old_count > 0 and contact.feature == feature1:
                contact.normal_impulse = normal1
                contact.tangent_impulse = tangent1
            if old_count > 1 and contact.feature == feature2:
                contact.normal_impulse = normal2
                contact.tangent_impulse = tangent2
    remember(arbiter, places, motions)


@kernel
def remember(arbiter, places, motions):
    """Notes where the bodies are, for recycling."""
    motion1 = motions[arbiter.body1]
    motion2 = motions[arbiter.body2]
    apart = places.mass2 - places.mass1
    arbiter.recyclable = np.int32(arbiter.count > 0)
    arbiter.found_nx = arbiter.nx
    arbiter.found_ny = arbiter.ny
    arbiter.apart_x = apart.x
    arbiter.apart_y = apart.y
    arbiter.cosine1 = motion1.cosine
    arbiter.sine1 = motion1.sine
    arbiter.cosine2 = motion2.cosine
    arbiter.sine2 = motion2.sine
