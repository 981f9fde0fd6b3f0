"""Contacts that are made ahead know one normal, that of the start: what is very fast may be elsewhere by the end.

A bullet that passes by a corner would be turned away by it, though it misses. It needs none of them: it is swept.
"""

from __future__ import annotations

import numpy as np

from engine.constants import CONTINUOUS_AHEAD, CONTINUOUS_FAR
from engine.jit import kernel
from engine.lanes import absolute, const, eight_of, holds_somewhere
from engine.rows import load_row
from engine.simd import WIDTH


@kernel
def goes_far(motion, slowest, margin, dt):
    """Whether a body will go so far in this step that the normals of its start mean nothing; and is swept."""
    way = (abs(np.float64(motion.vx)) + abs(np.float64(motion.vy))) * dt
    return way > CONTINUOUS_FAR * margin and way > slowest.way


@kernel
def drop_ahead(arbiters, contacts, count, dynamic, motions, slowest, bullet, steps):
    """Takes away contacts before shapes touch, of pairs that are swept because one body goes far.

    dynamic: rows of bodies, filled up to a multiple of eight; slowest, bullet: None where not called for.
    """
    step = steps[0]
    if slowest is None:
        return
    far = const(CONTINUOUS_FAR, step.dt) * step.margin
    somebody = False
    for k in range(len(dynamic) // WIDTH):
        vx, vy, _, _, _, _, _, _ = load_row(motions, eight_of(dynamic, WIDTH * k))
        way = (absolute(vx) + absolute(vy)) * step.dt
        if holds_somewhere(way > const(far, way)):
            somebody = True
            break
    if not somebody:
        return
    margin, dt = np.float64(step.margin), np.float64(step.dt)
    for index in range(count):
        arbiter = arbiters[index]
        if arbiter.count == 0:
            continue
        row1, row2 = arbiter.body1, arbiter.body2
        swept = motions[row1].inverse_mass == 0 or motions[row2].inverse_mass == 0
        if bullet is not None:
            swept = swept or bullet[row1] or bullet[row2]
        if swept and (
            goes_far(motions[row1], slowest[row1], margin, dt) or goes_far(motions[row2], slowest[row2], margin, dt)
        ):
            if arbiter.count == 2 and contacts[index, 1].separation > CONTINUOUS_AHEAD:
                arbiter.count = 1
            if contacts[index, 0].separation > CONTINUOUS_AHEAD:
                if arbiter.count == 2:
                    contacts[index, 0] = contacts[index, 1]
                arbiter.count -= 1
            arbiter.recyclable, arbiter.clearance = 0, 0
