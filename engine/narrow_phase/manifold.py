"""Putting what a collider found into the arbiter and contact tables."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.origin import center_of, origin_of
from engine.vec2 import Vec2


class Places(NamedTuple):
    """Where two bodies are."""

    origin: Vec2  # what the centres are reckoned from, float64 [m]
    center1: Any  # Vec2 of lanes [m]
    center2: Any


@kernel
def places_of(body1, body2, lane):
    """Where two bodies are, in the lane's width."""
    origin = origin_of(body1, lane)
    return Places(origin, center_of(body1, origin, lane), center_of(body2, origin, lane))


@kernel
def add_contact(arbiter, contacts, index, places, point, separation, feature):
    """Appends a contact at a point reckoned from the places' origin."""
    contact = contacts[index, arbiter.count]
    contact.x = places.origin.x + point.x
    contact.y = places.origin.y + point.y
    contact.feature = feature
    r1 = point - places.center1
    r2 = point - places.center2
    contact.r1_x = r1.x
    contact.r1_y = r1.y
    contact.r2_x = r2.x
    contact.r2_y = r2.y
    contact.separation = separation
    arbiter.count += 1
