"""Islands: bodies that touch or are joined, one with the next. They fall asleep and wake together.

Only bodies that have weight link others: what stands on the same floor is no island. Which bodies belong together
is kept from step to step as a forest (union-find, with path halving): `parents` leads from each body's row to that of
its island's first. What begins to touch joins two islands at once. What parts may leave an island that is two by now;
that is found out, for all that are awake, when one of them may fall asleep, and not before.

None of it is part of a snapshot: it follows from contacts and joints, and when bodies fall asleep or wake islands are
exact, whatever was known before.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

KNOWN, COARSE, DRIVEN, STAMP, FLAGS = range(5)


@kernel
def find(parents, row):
    """The row that stands for the island of the body in `row`."""
    while parents[row] != row:
        parents[row] = parents[parents[row]]
        row = parents[row]
    return row


@kernel
def join(parents, motions, one, other):
    """From now on two bodies belong together, if both have weight."""
    if motions[one].inverse_mass > 0 and motions[other].inverse_mass > 0:
        first = find(parents, one)
        second = find(parents, other)
        if first < second:
            parents[second] = first
        else:
            parents[first] = second


@kernel
def stand_alone(rows, parents):
    """Each of these bodies is an island of its own."""
    for k in range(len(rows)):
        parents[rows[k]] = rows[k]


@kernel
def join_touching(indices, arbiters, motions, parents):
    """Joins what touches, as the arbiters at these indices say."""
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        if arbiter.count > 0:
            join(parents, motions, np.int64(arbiter.body1), np.int64(arbiter.body2))


@kernel
def join_pairs(pairs, motions, parents):
    """Joins the bodies in these pairs (J, 2) of rows."""
    for k in range(len(pairs)):
        join(parents, motions, pairs[k, 0], pairs[k, 1])


@kernel
def follow_touching(indices, arbiters, motions, flags, parents):
    """Joins what began to touch since colours were given. What parted has not been still: it may fall now."""
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        if arbiter.count > 0:
            if arbiter.colour < 0 and flags[KNOWN] != 0:
                join(parents, motions, np.int64(arbiter.body1), np.int64(arbiter.body2))
        elif arbiter.colour >= 0:
            flags[COARSE] = 1
            motions[arbiter.body1].still = 0
            motions[arbiter.body2].still = 0


@kernel
def name_islands(rows, parents, names):
    """names (N,) int64: for each body the first of `rows` that is of its island, by number."""
    first = np.full(len(parents), -1, np.int64)
    for k in range(len(rows)):
        root = find(parents, rows[k])
        if first[root] < 0:
            first[root] = k
        names[k] = first[root]


@kernel
def mark_islands(rows, parents, marks):
    """Marks the islands of these bodies. marks: (rows of bodies,) uint8."""
    for k in range(len(rows)):
        marks[find(parents, rows[k])] = 1


@kernel
def are_marked(rows, parents, marks, found):
    """found (N,) bool: whether the island of each of these bodies is marked."""
    for k in range(len(rows)):
        found[k] = marks[find(parents, rows[k])] != 0


class Islands:
    """The forest, and what is known of it, where kernels can read it."""

    def __init__(self) -> None:
        self.parents = np.empty(0, np.int64)
        self.busy = np.empty(0, np.int64)  # scratch of sleeping.py, as long
        self.flags = np.zeros(FLAGS, np.int64)
        # KNOWN: parents hold; COARSE: an island may be several by now; DRIVEN, STAMP: see sleeping.py

    @property
    def known(self) -> bool:
        return bool(self.flags[KNOWN])

    def forget(self, rows: int) -> None:
        """Bodies, contacts or joints came or went by other ways than a step. rows: of the table of bodies."""
        self.flags[KNOWN] = 0
        if len(self.parents) != rows:
            self.parents, self.busy = np.arange(rows), np.zeros(rows, np.int64)

    def build(
        self, own: np.ndarray, indices: np.ndarray, arbiters: np.ndarray, pairs: np.ndarray, motions: np.ndarray
    ) -> None:
        """Finds the islands of the bodies in the rows `own`, among which are all that these arbiters and pairs link.

        If nothing is known yet, own must be all bodies.
        """
        stand_alone(own, self.parents)
        join_touching(indices, arbiters, motions, self.parents)
        join_pairs(pairs, motions, self.parents)
        self.flags[KNOWN], self.flags[COARSE] = 1, 0

    def follow(self, indices: np.ndarray, arbiters: np.ndarray, motions: np.ndarray) -> None:
        """Takes up what began and ceased to touch. To be called before colours are given."""
        follow_touching(indices, arbiters, motions, self.flags, self.parents)
