"""Which arbiters need their contacts found anew, and which keep them because their bodies hardly moved.

A kept contact keeps its anchors as they stood in the world; its separation follows the bodies, and its normal turns
with what both of them turned by, as on a floor that tilts. This saves most of the narrow phase in a heap at rest, and
it is what lets towers stand: the anchors do not turn with the bodies, so that a tower that leans a little is not bent
further by its own weight (docs/decisions.md has figures).
Idea: E. Catto, contact recycling (Box2D v3.2, 2026).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.atomics import count_up
from engine.constants import RECYCLING_ANGLE, RECYCLING_ROLL
from engine.jit import kernel
from engine.lanes import absolute, bits_of, const, eight_of, holds_somewhere, maximum, minimum, select, sqrt
from engine.rows import at, load_row, store_row
from engine.simd import WIDTH
from engine.threads import DONE, take_part, wait_for_all
from engine.vec2 import Vec2, choose, dot, rotate, unrotate

BOX = np.dtype([(name, np.float32) for name in ("lower_x", "lower_y", "upper_x", "upper_y")])
"""A bounding box [m]; one row a shape."""

SEPARATION = 4  # its place in a contact's row


@kernel
def write_boxes(bounds, order, boxes, ranks):
    """The bounding boxes (4, S) of the broad phase, by rank, as rows of the table of shapes.

    ranks: not looked at, see below.
    """
    for rank in range(len(order)):
        box = boxes[order[rank]]
        box.lower_x, box.lower_y, box.upper_x, box.upper_y = (
            bounds[0, rank], bounds[1, rank], bounds[2, rank], bounds[3, rank],
        )  # fmt: skip


@kernel
def write_some_boxes(bounds, order, boxes, ranks):
    """The same for shapes of some ranks."""
    for k in range(len(ranks)):
        rank = ranks[k]
        box = boxes[order[rank]]
        box.lower_x, box.lower_y, box.upper_x, box.upper_y = (
            bounds[0, rank], bounds[1, rank], bounds[2, rank], bounds[3, rank],
        )  # fmt: skip


@kernel
def are_apart(boxes, shape1, shape2):
    """Whether the bounding boxes of two shapes do not overlap."""
    left1, bottom1, right1, top1 = load_row(boxes, shape1)
    left2, bottom2, right2, top2 = load_row(boxes, shape2)
    return (left1 > right2) | (right1 < left2) | (bottom1 > top2) | (top1 < bottom2)


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
    turn = choose(first, turn1, turn2)
    return choose(none, Vec2(const(1.0, zero), zero), turn)


class Moved(NamedTuple):
    """How two bodies moved since their contacts were found."""

    shift: Vec2  # of body2 as seen from body1 [m]
    turn1: Vec2  # rotations
    turn2: Vec2
    little: Any  # whether they turned and rolled so little that contacts may be kept


@kernel
def reach_of(boxes, shape, body, lane):
    """How far the furthest point of a shape is from its body's centre of mass, or a little less than that [m]."""
    left, bottom, right, top = load_row(boxes, shape)
    x, y = body.center_x, body.center_y
    wide = maximum(x - const(left, x), const(right, x) - x)
    high = maximum(y - const(bottom, y), const(top, y) - y)
    return const(sqrt(wide * wide + high * high), lane)


@kernel
def moved_since(shift, cosine1, sine1, cosine2, sine2, radii, motion1, motion2):
    """shift: of body2 as seen from body1 [m]; cosines and sines: as they were; radii: of the outlines [m]."""
    limit = const(RECYCLING_ANGLE, cosine1)
    zero = const(0.0, cosine1)
    _, _, _, _, _, c1, s1, _ = motion1
    _, _, _, _, _, c2, s2, _ = motion2
    turn1 = unrotate(Vec2(cosine1, sine1), Vec2(c1, s1))
    turn2 = unrotate(Vec2(cosine2, sine2), Vec2(c2, s2))
    little = (turn1.x >= zero) & (turn2.x >= zero)
    little = little & (absolute(turn1.y) <= limit) & (absolute(turn2.y) <= limit)
    roll = maximum(rolled(turn1, radii.x), rolled(turn2, radii.y))
    return Moved(shift, turn1, turn2, little & (roll <= const(RECYCLING_ROLL, roll)))


@kernel
def separation_moved(point, moved, normal, step):
    """The separation of a kept contact now [m]; whether it may be kept: it went no further than allowed; how far."""
    r1_x, r1_y, r2_x, r2_y, _, found, _, _ = point
    r1, r2 = Vec2(r1_x, r1_y), Vec2(r2_x, r2_y)
    away = (moved.shift + rotate(moved.turn2, r2) - r2) - (rotate(moved.turn1, r1) - r1)
    separation = found + dot(normal, away)
    near = maximum(absolute(away.x), absolute(away.y)) <= step.recycling
    return separation, near & (separation <= step.margin), absolute(away.x) + absolute(away.y)


@kernel
def recycle(index, arbiters, contacts, boxes, bodies, motions, step):
    """Moves the contacts of arbiters along with their bodies. False, and nothing changed, if these moved too far.

    A single contact of shapes that may touch at two is kept only while nothing can have come nearer by half the margin:
    the second would not be seen until it is deep. And shapes that did not touch need no look before they can have come
    within the margin.
    """
    arbiter = at(arbiters, index)
    count = arbiter.count
    body1, body2 = arbiter.body1, arbiter.body2
    nx, ny, friction, rolling, found_nx, found_ny, apart_x, apart_y = load_row(arbiters, index)
    cosine1, sine1, cosine2, sine2, radius1, radius2, fewest, clearance = load_row(arbiters, index, 0, 8)
    place1, place2 = at(bodies, body1), at(bodies, body2)
    shift = Vec2(
        const(place2.center_x - place1.center_x, nx) - apart_x, const(place2.center_y - place1.center_y, nx) - apart_y
    )
    moved = moved_since(
        shift, cosine1, sine1, cosine2, sine2, Vec2(radius1, radius2),
        load_row(motions, body1), load_row(motions, body2),
    )  # fmt: skip
    normal = rotate(shared_turn(moved.turn1, moved.turn2), Vec2(found_nx, found_ny))
    a = load_row(contacts, index, 0)
    b = load_row(contacts, index, 1)
    separation_a, kept_a, slid = separation_moved(a, moved, normal, step)
    separation_b, kept_b, _ = separation_moved(b, moved, normal, step)
    none = const(0.0, nx)
    few = const(count, fewest)
    touching = (few >= fewest) & kept_a & (kept_b | (count < 2))
    clear = few < none
    if holds_somewhere(few < fewest):
        reach1 = reach_of(boxes, arbiter.shape1, place1, nx)
        reach2 = reach_of(boxes, arbiter.shape2, place2, nx)
        slid = slid + absolute(moved.turn1.y - moved.turn2.y) * (minimum(reach1, reach2) * const(2.0, nx))
        turned = absolute(moved.turn1.y) * reach1 + absolute(moved.turn2.y) * reach2
        way = (absolute(shift.x) + absolute(shift.y)) + turned
        more = const(1.01, nx)  # than the sines of small angles, and than rounding
        still = more * slid <= const(0.25, nx) * step.margin
        touching = touching | ((few > none) & (few < fewest) & kept_a & still)
        clear = (few == none) & (more * way < clearance - step.margin)
    kept = (arbiter.recyclable != 0) & moved.little & (touching | clear)
    if step.recycling > 0 and holds_somewhere(kept & touching):
        store_row(
            arbiters, index,
            (select(kept, normal.x, nx), select(kept, normal.y, ny), friction, rolling),
        )  # fmt: skip
        at(contacts, index, 0).separation = select(kept & touching, separation_a, a[SEPARATION])
        at(contacts, index, 1).separation = select(kept & touching, separation_b, b[SEPARATION])
    return kept & (step.recycling > 0)


@kernel
def choose_pairs(first, last, indices, arbiters, contacts, boxes, bodies, motions, steps, chosen):
    """Of some arbiters of one collider, writes those that need it into `chosen` and returns how many there are.

    indices: filled up to a multiple of eight with the row of no arbiter. Those from `first`, a multiple of eight, to
    before `last` are looked at, and written from `first` on. Arbiters whose bounding boxes are apart lose
    their contacts, whatever the broad phase still holds for a pair: so the contacts do not depend on which broad phase
    it is.
    """
    step = steps[0]
    place = first
    for k in range(first, last, WIDTH):
        index = eight_of(indices, k)
        arbiter = at(arbiters, index)
        apart = are_apart(boxes, arbiter.shape1, arbiter.shape2)
        leaving = apart & (arbiter.count > 0)
        if holds_somewhere(leaving):
            at(arbiters, index).count = select(apart, const(0, arbiter.count), arbiter.count)
            at(arbiters, index).recyclable = select(apart, const(0, arbiter.count), arbiter.recyclable)
            rolling = at(arbiters, index).rolling_impulse
            at(arbiters, index).rolling_impulse = select(apart, const(0.0, rolling), rolling)
        found = apart
        if holds_somewhere(~apart & (arbiter.recyclable != 0)):
            found = found | recycle(index, arbiters, contacts, boxes, bodies, motions, step)
        left = bits_of(~found)
        for lane in range(min(WIDTH, last - k)):
            if left >> lane & 1:
                chosen[place] = indices[k + lane]
                place += 1
    return place - first


@kernel
def choose_together(
    leads, board, firsts, counts, indices, arbiters, contacts, boxes, bodies, motions, steps, chosen
):  # fmt: skip
    """The same by several threads: part p from firsts[p] on, counts[p] of it chosen."""
    part = take_part(board, len(counts))
    while part >= 0:
        counts[part] = choose_pairs(
            firsts[part], firsts[part + 1], indices, arbiters, contacts, boxes, bodies, motions, steps, chosen
        )  # fmt: skip
        count_up(board, DONE)
        part = take_part(board, len(counts))
    if leads:
        wait_for_all(board, len(counts))
