"""Arbiters: the contacts between two bodies, and the impulses that they carry from step to step."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel


@kernel
def begin_arbiters(pairs, count, order, bodies, arbiters):
    """Writes one arbiter without contacts for each pair of ranks: who meets whom, and their combined friction."""
    for index in range(count):
        row1 = order[pairs[index, 0]]
        row2 = order[pairs[index, 1]]
        arbiter = arbiters[index]
        arbiter.body1 = row1
        arbiter.body2 = row2
        arbiter.serial1 = bodies[row1].serial
        arbiter.serial2 = bodies[row2].serial
        arbiter.friction = np.sqrt(bodies[row1].friction * bodies[row2].friction)
        arbiter.count = 0


@kernel
def is_before(a, b):
    """Whether arbiter a comes before b: by the serial of body1, then by that of body2."""
    return a.serial1 < b.serial1 or (a.serial1 == b.serial1 and a.serial2 < b.serial2)


@kernel
def carry_impulses(old_contacts, old_index, old_count, new_contacts, new_index, new_count):
    """Copies the accumulated impulses of every contact whose feature was there in the step before."""
    for i in range(new_count):
        new = new_contacts[new_index, i]
        for k in range(old_count):
            old = old_contacts[old_index, k]
            if old.feature == new.feature:
                new.normal_impulse = old.normal_impulse
                new.tangent_impulse = old.tangent_impulse


@kernel
def match_arbiters(old_arbiters, old_contacts, old_total, arbiters, contacts, total, steps):
    """Drops the arbiters without contacts, and lets the others carry impulses over from the step before.

    Both tables are in ascending order of (serial1, serial2), so one walk along both finds all matches.
    Returns the number of arbiters that are left.
    """
    warm_starting = steps[0].warm_starting != 0
    kept = 0
    k = 0
    for index in range(total):
        if arbiters[index].count == 0:
            continue
        if kept != index:
            arbiters[kept] = arbiters[index]
        arbiter = arbiters[kept]
        for i in range(arbiter.count):
            if kept != index:
                contacts[kept, i] = contacts[index, i]
            contacts[kept, i].normal_impulse = 0
            contacts[kept, i].tangent_impulse = 0
        while k < old_total and is_before(old_arbiters[k], arbiter):
            k += 1
        if warm_starting and k < old_total and not is_before(arbiter, old_arbiters[k]):
            carry_impulses(old_contacts, k, old_arbiters[k].count, contacts, kept, arbiter.count)
        kept += 1
    return kept
