"""Which arbiters need their contacts found anew, and which keep them because their bodies hardly moved.

A kept contact keeps its anchors as they stood in the world; its separation follows the bodies, and its normal turns
with what both of them turned by, as on a floor that tilts. This saves most of the narrow phase in a heap at rest, and
it is what lets towers stand: the anchors do not turn with the bodies, so that a tower that leans a little is not bent
further by its own weight (docs/decisions.md has figures).
Idea: E. Catto, contact recycling (Box2D v3.2, 2026).
"""

from __future__ import annotations

import numpy as np

from engine.constants import RECYCLING_ANGLE, RECYCLING_ROLL
from engine.jit import kernel
from engine.lanes import absolute, const, maximum, select
from engine.narrow_phase.manifold import seen_from
from engine.origin import origin_of
from engine.shapes.circle import CIRCLE
from engine.vec2 import Vec2, dot, rotate, unrotate


@kernel
def are_apart(bounds, i, j):
    """Whether the bounding boxes of two ranks do not overlap."""
    return (
        bounds[0, i] > bounds[2, j]
        or bounds[2, i] < bounds[0, j]
        or bounds[1, i] > bounds[3, j]
        or bounds[3, i] < bounds[1, j]
    )


@kernel
def turned_since(cosine, sine, motion):
    """The rotation from a remembered one to a body's own."""
    return unrotate(Vec2(cosine, sine), Vec2(motion.cosine, motion.sine))


@kernel
def rolled(turn, radius):
    """How far the outline of a round shape that turns on the spot is from the point that touched [m]."""
    return radius * (const(1.0, turn.x) - turn.x)


@kernel
def shared_turn(turn1, turn2):
    """What both bodies turned by: the lesser of two turns the same way, none if they turned opposite ways."""
    zero = const(0.0, turn1.x)
    none = turn1.y * turn2.y <= zero
    first = absolute(turn1.y) < absolute(turn2.y)
    sine = select(first, turn1.y, turn2.y)
    cosine = select(first, turn1.x, turn2.x)
    return Vec2(select(none, const(1.0, zero), cosine), select(none, zero, sine))


@kernel
def recycle(index, arbiters, contacts, shapes, bodies, motions, step):
    """Moves the contacts of one arbiter along with its bodies. False, and nothing changed, if these moved too far.

    Nor is a single contact kept of shapes that may touch at two: the second would not be seen until it is deep.
    """
    arbiter = arbiters[index]
    if arbiter.count == 1 and shapes[arbiter.shape1].kind != CIRCLE and shapes[arbiter.shape2].kind != CIRCLE:
        return False
    motion1 = motions[arbiter.body1]
    motion2 = motions[arbiter.body2]
    body1 = bodies[arbiter.body1]
    body2 = bodies[arbiter.body2]
    lane = motion1.cosine
    turn1 = turned_since(arbiter.cosine1, arbiter.sine1, motion1)
    turn2 = turned_since(arbiter.cosine2, arbiter.sine2, motion2)
    limit = const(RECYCLING_ANGLE, lane)
    zero = const(0.0, lane)
    if turn1.x < zero or turn2.x < zero or absolute(turn1.y) > limit or absolute(turn2.y) > limit:
        return False
    roll1 = rolled(turn1, const(shapes[arbiter.shape1].radius, lane))
    roll2 = rolled(turn2, const(shapes[arbiter.shape2].radius, lane))
    if maximum(roll1, roll2) > const(RECYCLING_ROLL, lane):
        return False
    apart = Vec2(const(body2.center_x - body1.center_x, lane), const(body2.center_y - body1.center_y, lane))
    shift = apart - Vec2(arbiter.apart_x, arbiter.apart_y)
    normal = rotate(shared_turn(turn1, turn2), Vec2(arbiter.found_nx, arbiter.found_ny))
    for i in range(arbiter.count):
        contact = contacts[index, i]
        found1 = Vec2(contact.found1_x, contact.found1_y)
        found2 = Vec2(contact.found2_x, contact.found2_y)
        away = (shift + rotate(turn2, found2) - found2) - (rotate(turn1, found1) - found1)
        far = maximum(absolute(away.x), absolute(away.y))
        if far > step.recycling or contact.found + dot(normal, away) > step.margin:
            return False
    arbiter.nx = normal.x
    arbiter.ny = normal.y
    origin = origin_of(body1, lane)
    mass1 = seen_from(origin, body1.center_x, body1.center_y, lane)
    for i in range(arbiter.count):
        contact = contacts[index, i]
        found1 = Vec2(contact.found1_x, contact.found1_y)
        found2 = Vec2(contact.found2_x, contact.found2_y)
        away = (shift + rotate(turn2, found2) - found2) - (rotate(turn1, found1) - found1)
        contact.separation = contact.found + dot(normal, away)
        contact.x = origin.x + (mass1.x + found1.x)
        contact.y = origin.y + (mass1.y + found1.y)
        if step.warm_starting == 0:
            contact.normal_impulse = 0
            contact.tangent_impulse = 0
    return True


@kernel
def choose(indices, arbiters, contacts, ranks, bounds, shapes, bodies, motions, steps, chosen):
    """Of the arbiters of one collider, writes those that need it into `chosen` and returns how many there are.

    Arbiters whose bounding boxes are apart lose their contacts, whatever the broad phase still holds for a pair: so
    the contacts do not depend on which broad phase it is.
    """
    step = steps[0]
    count = 0
    for k in range(len(indices)):
        index = indices[k]
        arbiter = arbiters[index]
        if are_apart(bounds, ranks[arbiter.shape1], ranks[arbiter.shape2]):
            arbiter.count = 0
            arbiter.recyclable = np.int32(0)
            arbiter.rolling_impulse = 0
        elif not (
            step.recycling > 0
            and arbiter.recyclable != 0
            and recycle(index, arbiters, contacts, shapes, bodies, motions, step)
        ):
            chosen[count] = index
            count += 1
    return count
