"""From where two shapes are to the contacts of their arbiter, for one arbiter or for eight."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, select
from engine.origin import origin_of
from engine.rows import at, load_row, store_row
from engine.vec2 import Vec2

FIRST_TURN = 8  # cosine1 among the numbers of an arbiter's row


class Places(NamedTuple):
    """Where two shapes and the centres of mass of their bodies are."""

    shape1: Any  # Vec2 of lanes [m]
    shape2: Any
    mass1: Any
    mass2: Any


@kernel
def seen_from(origin, x, y, lane):
    """A point of the world as seen from the origin, in the lane's width [m]."""
    return Vec2(const(x - origin.x, lane), const(y - origin.y, lane))


@kernel
def places_of(arbiter, placements, bodies, lane):
    """Where the two shapes of an arbiter are, in the solver's precision."""
    place1 = at(placements, arbiter.shape1)
    place2 = at(placements, arbiter.shape2)
    body1 = at(bodies, arbiter.body1)
    body2 = at(bodies, arbiter.body2)
    origin = origin_of(body1, lane)
    return Places(
        seen_from(origin, place1.x, place1.y, lane),
        seen_from(origin, place2.x, place2.y, lane),
        seen_from(origin, body1.center_x, body1.center_y, lane),
        seen_from(origin, body2.center_x, body2.center_y, lane),
    )


@kernel
def matched(there, feature, old_there1, feature1, impulse1, old_there2, feature2, impulse2):
    """The impulse of the contact that had this feature in the step before, 0 if there was none."""
    zero = const(0.0, impulse1)
    impulse = select(old_there1 & (feature == feature1), impulse1, zero)
    return select(there & old_there2 & (feature == feature2), impulse2, select(there, impulse, zero))


@kernel
def write_manifold(index, arbiters, contacts, places, manifold, motions, warm_starting):
    """Writes what a collider found; a contact whose feature was there in the step before keeps its impulses."""
    arbiter = at(arbiters, index)
    old_count = arbiter.count
    old1, old2 = at(contacts, index, 0), at(contacts, index, 1)
    feature1, feature2 = old1.feature, old2.feature
    _, _, _, _, _, _, normal1, tangent1 = load_row(contacts, index, 0)
    _, _, _, _, _, _, normal2, tangent2 = load_row(contacts, index, 1)
    old_there1, old_there2 = (old_count > 0) & warm_starting, (old_count > 1) & warm_starting
    count = const(manifold.count, old_count)
    new1, new2 = const(manifold.feature1, feature1), const(manifold.feature2, feature2)
    there1, there2 = count > 0, count > 1
    old1.feature = new1
    old2.feature = new2

    r1, r2 = manifold.point1 - places.mass1, manifold.point1 - places.mass2
    normal = matched(there1, new1, old_there1, feature1, normal1, old_there2, feature2, normal2)
    tangent = matched(there1, new1, old_there1, feature1, tangent1, old_there2, feature2, tangent2)
    s = manifold.separation1
    store_row(contacts, index, (r1.x, r1.y, r2.x, r2.y, s, s, normal, tangent), 0)
    r1, r2 = manifold.point2 - places.mass1, manifold.point2 - places.mass2
    normal = matched(there2, new2, old_there1, feature1, normal1, old_there2, feature2, normal2)
    tangent = matched(there2, new2, old_there1, feature1, tangent1, old_there2, feature2, tangent2)
    s = manifold.separation2
    store_row(contacts, index, (r1.x, r1.y, r2.x, r2.y, s, s, normal, tangent), 1)

    _, _, friction, rolling, _, _, _, _ = load_row(arbiters, index)
    kept = there1 & old_there1
    nx, ny = manifold.normal.x, manifold.normal.y
    apart = places.mass2 - places.mass1
    rolling = select(kept, rolling, const(0.0, rolling))
    store_row(arbiters, index, (nx, ny, friction, rolling, nx, ny, apart.x, apart.y))
    arbiter.count = count
    arbiter.recyclable = const(1, count)
    arbiter.clearance = manifold.clearance
    _, _, _, _, _, cosine1, sine1, _ = load_row(motions, arbiter.body1)
    _, _, _, _, _, cosine2, sine2, _ = load_row(motions, arbiter.body2)
    store_row(arbiters, index, (cosine1, sine1, cosine2, sine2), 0, FIRST_TURN)
