"""Which pairs touch, step after step: one walk along those that did and those that are near, both in one order."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

PAIR = np.dtype([(name, np.int64) for name in ("shape1", "shape2", "body1", "body2")])
"""Two shapes that touch, by the serials of shapes and bodies; shape1 < shape2, and that is their order."""

BEFORE = np.dtype([(name, np.float64) for name in ("x", "y", "angle", "center_x", "center_y", "vx", "vy", "w")])
"""Where a body was and how it moved when the step began; same row as in BODY, same units."""


@kernel
def touches(arbiter, contacts, index, parting):
    """Whether a contact presses, or its shapes are not further apart than `parting` [m]."""
    for i in range(arbiter.count):
        contact = contacts[index, i]
        if contact.given_normal > 0 or np.float64(contact.separation) <= parting:
            return True
    return False


@kernel
def approach(arbiter, contact, was1, was2):
    """How fast two shapes came together at a contact before the step, along the normal [m/s]."""
    r1_x, r1_y = np.float64(contact.r1_x), np.float64(contact.r1_y)
    r2_x, r2_y = np.float64(contact.r2_x), np.float64(contact.r2_y)
    vx = (was2.vx - was2.w * r2_y) - (was1.vx - was1.w * r1_y)
    vy = (was2.vy + was2.w * r2_x) - (was1.vy + was1.w * r1_x)
    return -(vx * np.float64(arbiter.nx) + vy * np.float64(arbiter.ny))


@kernel
def write_hit(arbiter, contacts, index, pair, before, hit_speed, event):
    """Writes the HIT_EVENT of a pair that begins to touch, but for its step. False, if it did so too slowly."""
    was1, was2 = before[arbiter.body1], before[arbiter.body2]
    fastest = hit_speed
    found = False
    for i in range(arbiter.count):
        contact = contacts[index, i]
        if contact.given_normal > 0 or contact.separation <= 0:
            speed = approach(arbiter, contact, was1, was2)
            if speed > fastest:
                fastest = speed
                found = True
                # a contact that is kept has an anchor on each body, and these came nearer since it was found
                event.x = 0.5 * (was1.center_x + contact.r1_x + (was2.center_x + contact.r2_x))
                event.y = 0.5 * (was1.center_y + contact.r1_y + (was2.center_y + contact.r2_y))
    if found:
        event.shape1, event.shape2 = pair.shape1, pair.shape2
        event.body1, event.body2 = pair.body1, pair.body2
        event.nx, event.ny = np.float64(arbiter.nx), np.float64(arbiter.ny)
        event.speed = fastest
    return found


@kernel
def write_pair(row, pair):
    """The four serials."""
    row.shape1, row.shape2 = pair.shape1, pair.shape2
    row.body1, row.body2 = pair.body1, pair.body2


@kernel
def is_before(pair, serial1, serial2):
    """Whether a pair comes before that of these two shapes."""
    return pair.shape1 < serial1 or (pair.shape1 == serial1 and pair.shape2 < serial2)


@kernel
def write_ended(old, first, last, number, end, total):
    """The TOUCH_EVENTs of old pairs from `first` to before `last`, from row `total` on; returns the next one."""
    for k in range(first, last):
        write_pair(end[total], old[k])
        end[total].step = number
        total += 1
    return total


@kernel
def follow_touches(
    arbiters, contacts, count, bodies, before, old, number, hit_speed, parting, touching, begin, end, hit, totals
):  # fmt: skip
    """Writes who touches now, and what began, ended and hit in this step; totals (4,) int64: how many of each.

    old: PAIR rows of who touched before; like the first `count` arbiters in ascending order of the shapes' serials.
    before: BEFORE, of the bodies as the step began. number: of the step. hit_speed [m/s], parting [m].
    """
    k = 0
    now = begun = ended = struck = 0
    for index in range(count):
        arbiter = arbiters[index]
        if arbiter.count == 0:
            continue
        serial1, serial2 = arbiter.serial1, arbiter.serial2
        first = k
        while k < len(old) and is_before(old[k], serial1, serial2):
            k += 1
        ended = write_ended(old, first, k, number, end, ended)
        known = k < len(old) and old[k].shape1 == serial1 and old[k].shape2 == serial2
        if not touches(arbiter, contacts, index, parting if known else 0.0):
            continue
        pair = touching[now]
        pair.shape1, pair.shape2 = serial1, serial2
        pair.body1, pair.body2 = bodies[arbiter.body1].serial, bodies[arbiter.body2].serial
        now += 1
        if known:
            k += 1
            continue
        write_pair(begin[begun], pair)
        begin[begun].step = number
        begun += 1
        if write_hit(arbiter, contacts, index, pair, before, hit_speed, hit[struck]):
            hit[struck].step = number
            struck += 1
    ended = write_ended(old, k, len(old), number, end, ended)
    totals[0], totals[1], totals[2], totals[3] = now, begun, ended, struck
