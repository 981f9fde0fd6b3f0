"""Arbiters: two shapes that are near each other, with the contacts and impulses that they carry from step to step."""

from __future__ import annotations

import numpy as np

from engine.colouring import NONE
from engine.jit import kernel
from engine.mixing import mix
from engine.pairs import may_touch
from engine.shapes.circle import CIRCLE
from engine.simd import WIDTH
from engine.tables import arbiter_dtype, contact_dtype, empty


class ArbiterTable:
    """Arbiters in ascending order of (serial1, serial2), with up to two contacts each."""

    def __init__(self, precision: str, capacity: int) -> None:
        self.rows = empty(capacity + 1, arbiter_dtype(precision))  # the last row stands for no arbiter
        self.contacts = empty((capacity + 1, 2), contact_dtype(precision))
        self.capacity = capacity
        self.count = 0
        self.kinds = np.empty(capacity, np.int32)  # the collider of each
        self.chosen = np.empty(capacity + WIDTH, np.int64)  # room for those whose contacts are to be found

    @property
    def nothing(self) -> int:
        """The row of no arbiter: it fills up where eight are worked on at once."""
        return len(self.rows) - 1

    def point_at_nobody(self, bodies: int, shapes: int) -> None:
        """Lets the row of no arbiter be of no bodies and no shapes, the last rows of their tables."""
        row = self.rows[self.nothing : self.nothing + 1]
        row["body1"] = row["body2"] = bodies - 1
        row["shape1"] = row["shape2"] = shapes - 1
        row["colour"] = NONE


@kernel
def begin_arbiter(arbiter, row1, row2, shapes, colliders, rule):
    """Writes an arbiter without contacts. False, and nothing written, if the two never touch."""
    shape1 = shapes[row1]
    shape2 = shapes[row2]
    if not may_touch(shape1, shape2, colliders):
        return False
    arbiter.serial1 = shape1.serial
    arbiter.serial2 = shape2.serial
    arbiter.shape1 = row1
    arbiter.shape2 = row2
    arbiter.body1 = shape1.body
    arbiter.body2 = shape2.body
    arbiter.collider = colliders[shape1.kind, shape2.kind]
    arbiter.count = 0
    arbiter.colour = NONE
    arbiter.recyclable = 0
    arbiter.rolling_impulse = 0
    arbiter.radius1 = shape1.radius
    arbiter.radius2 = shape2.radius
    arbiter.clearance = 0
    arbiter.fewest = 1 if shape1.kind == CIRCLE or shape2.kind == CIRCLE else 2
    arbiter.friction = mix(rule, shape1.friction, shape2.friction)
    return True


@kernel
def part(arbiter, motions):
    """What touched does so no more: what lay on something may fall now."""
    if arbiter.count > 0:
        motions[arbiter.body1].still = 0
        motions[arbiter.body2].still = 0


@kernel
def follow_pairs(
    pairs, count, serials, shapes, colliders, rule, old_arbiters, old_contacts, old_total, arbiters, contacts, kinds,
    motions,
):  # fmt: skip
    """Writes one arbiter for each pair of shape rows that may touch; those that were there keep all that they have.

    Bodies that touched and are no pair any more have not been still so far.

    Pairs and arbiters are in ascending order of serials, so one walk along both finds all matches. serials (shapes,)
    int64 and kinds (capacity,) int32, the collider of each arbiter, are what is looked at most, each closely packed.
    Returns the number of arbiters.
    """
    k = 0
    total = 0
    for index in range(count):
        serial1 = serials[pairs[index, 0]]
        serial2 = serials[pairs[index, 1]]
        while k < old_total and (
            old_arbiters[k].serial1 < serial1
            or (old_arbiters[k].serial1 == serial1 and old_arbiters[k].serial2 < serial2)
        ):
            part(old_arbiters[k], motions)
            k += 1
        if k < old_total and old_arbiters[k].serial1 == serial1 and old_arbiters[k].serial2 == serial2:
            arbiters[total] = old_arbiters[k]
            if arbiters[total].count > 0:  # what does not touch has no contacts to keep
                contacts[total, 0] = old_contacts[k, 0]
                contacts[total, 1] = old_contacts[k, 1]
            k += 1
        elif not begin_arbiter(arbiters[total], pairs[index, 0], pairs[index, 1], shapes, colliders, rule):
            continue
        kinds[total] = arbiters[total].collider
        total += 1
    while k < old_total:
        part(old_arbiters[k], motions)
        k += 1
    return total


@kernel
def mix_friction(arbiters, count, shapes, rule):
    """Writes the friction of every pair."""
    for index in range(count):
        arbiter = arbiters[index]
        arbiter.friction = mix(rule, shapes[arbiter.shape1].friction, shapes[arbiter.shape2].friction)


@kernel
def sort_by_collider(kinds, nothing, places, sorted_rows):
    """Writes the indices of the arbiters of each collider, ascending, filled up to a multiple of eight with `nothing`.

    kinds (N,) int32; places (colliders + 1,) int64: where each collider's begin, the end last.
    """
    following = places[:-1].copy()
    sorted_rows[:] = nothing
    for index in range(len(kinds)):
        kind = kinds[index]
        sorted_rows[following[kind]] = index
        following[kind] += 1


def indices_by_collider(kinds: np.ndarray, nothing: int, colliders: int) -> list[tuple[np.ndarray, int]]:
    """For each collider the indices of its arbiters, ascending, filled up to a multiple of eight; and how many."""
    numbers = np.bincount(kinds, minlength=colliders)
    places = np.append(0, np.cumsum(-(-numbers // WIDTH) * WIDTH))
    sorted_rows = np.empty(places[-1], np.int64)
    sort_by_collider(kinds, nothing, places, sorted_rows)
    return [(sorted_rows[places[kind] : places[kind + 1]], int(numbers[kind])) for kind in range(colliders)]
