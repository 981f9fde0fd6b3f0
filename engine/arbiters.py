"""Arbiters: two shapes that are near each other, with the contacts and impulses that they carry from step to step."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel
from engine.mixing import mix
from engine.tables import arbiter_dtype, contact_dtype, empty


class ArbiterTable:
    """Arbiters in ascending order of (serial1, serial2), with up to two contacts each."""

    def __init__(self, precision: str, capacity: int) -> None:
        self.rows = empty(capacity, arbiter_dtype(precision))
        self.contacts = empty((capacity, 2), contact_dtype(precision))
        self.count = 0


@kernel
def begin_arbiter(arbiter, row1, row2, shapes, colliders):
    """Writes an arbiter without contacts."""
    shape1 = shapes[row1]
    shape2 = shapes[row2]
    arbiter.serial1 = shape1.serial
    arbiter.serial2 = shape2.serial
    arbiter.shape1 = row1
    arbiter.shape2 = row2
    arbiter.body1 = shape1.body
    arbiter.body2 = shape2.body
    arbiter.collider = colliders[shape1.kind, shape2.kind]
    arbiter.count = 0
    arbiter.recyclable = 0
    arbiter.rolling_impulse = 0


@kernel
def follow_pairs(pairs, count, shapes, colliders, old_arbiters, old_contacts, old_total, arbiters, contacts):
    """Writes one arbiter for each pair of shape rows; those that were there before keep all that they have.

    Pairs and arbiters are in ascending order of serials, so one walk along both finds all matches.
    """
    k = 0
    for index in range(count):
        serial1 = shapes[pairs[index, 0]].serial
        serial2 = shapes[pairs[index, 1]].serial
        while k < old_total and (
            old_arbiters[k].serial1 < serial1
            or (old_arbiters[k].serial1 == serial1 and old_arbiters[k].serial2 < serial2)
        ):
            k += 1
        if k < old_total and old_arbiters[k].serial1 == serial1 and old_arbiters[k].serial2 == serial2:
            arbiters[index] = old_arbiters[k]
            contacts[index, 0] = old_contacts[k, 0]
            contacts[index, 1] = old_contacts[k, 1]
        else:
            begin_arbiter(arbiters[index], pairs[index, 0], pairs[index, 1], shapes, colliders)


@kernel
def mix_friction(arbiters, count, shapes, rule):
    """Writes the friction of every pair."""
    for index in range(count):
        arbiter = arbiters[index]
        arbiter.friction = mix(rule, shapes[arbiter.shape1].friction, shapes[arbiter.shape2].friction)


def indices_by_collider(arbiters: np.ndarray, count: int, colliders: int) -> list[np.ndarray]:
    """For each collider the indices of its arbiters, ascending."""
    kinds = arbiters["collider"][:count]
    return [np.flatnonzero(kinds == kind) for kind in range(colliders)]
