"""Islands of constraints: rows that bodies link which impulses move. Each is a problem of its own.

A body that no impulse moves, static or kinematic, hands nothing on: two boxes on one floor are two islands. They follow
from joints and contacts as they are in this step, by union-find (engine/islands.py), so they are no part of a snapshot.
Rows of an island stay in the order in which all rows are, so that its bits do not depend on what else there is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.islands import find
from engine.jit import kernel
from engine.solvers.direct.rows import System


class Islands(NamedTuple):
    """k islands of n rows."""

    rows: np.ndarray  # (n,) int64, island after island
    firsts: np.ndarray  # (k + 1,) int64, where in `rows` each begins; n


@kernel
def moves(motion):
    """Whether an impulse changes how a body moves."""
    return motion.inverse_mass > 0 or motion.inverse_inertia > 0


@kernel
def join(parents, motions, one, other):
    """Links two bodies, if impulses move both."""
    if moves(motions[one]) and moves(motions[other]):
        first, second = find(parents, one), find(parents, other)
        parents[max(first, second)] = min(first, second)


@kernel
def island_of(parents, motions, one, other):
    """The body that stands for the island of what acts between two. Where neither moves it is the second's."""
    return find(parents, one if moves(motions[one]) else other)


@kernel
def link(rows, frames, joints, arbiters, count, motions, parents):
    """Writes `parents` (bodies,) int64: a forest, with a tree for each island. rows: None where no joint does anything.

    Returns the number of rows in the largest island.
    """
    for k in range(len(parents)):
        parents[k] = k
    if rows is not None:
        for k in range(len(rows)):
            joint = joints[frames[rows[k].frame].joint]
            join(parents, motions, np.int64(joint.body1), np.int64(joint.body2))
    for index in range(count):
        arbiter = arbiters[index]
        if arbiter.count > 0:
            join(parents, motions, np.int64(arbiter.body1), np.int64(arbiter.body2))
    return largest(rows, frames, joints, arbiters, count, motions, parents)


@kernel
def largest(rows, frames, joints, arbiters, count, motions, parents):
    """The number of rows in the largest island."""
    sizes = np.zeros(len(parents) + 1, np.int64)  # never empty
    if rows is not None:
        for k in range(len(rows)):
            joint = joints[frames[rows[k].frame].joint]
            sizes[island_of(parents, motions, np.int64(joint.body1), np.int64(joint.body2))] += 1
    for index in range(count):
        arbiter = arbiters[index]
        if arbiter.count > 0:
            island = island_of(parents, motions, np.int64(arbiter.body1), np.int64(arbiter.body2))
            sizes[island] += 2 * arbiter.count
    return sizes.max()


@kernel
def group(system, count, motions, parents):
    """The islands of the first `count` rows."""
    numbers = np.full(len(parents), -1, np.int64)  # of islands, by the bodies that stand for them
    own = np.empty(count, np.int64)
    firsts = np.zeros(count + 1, np.int64)
    found = 0
    for k in range(count):
        body = island_of(parents, motions, system.body[k, 0], system.body[k, 1])
        if numbers[body] < 0:
            numbers[body] = found
            found += 1
        own[k] = numbers[body]
        firsts[own[k] + 1] += 1
    for island in range(found):
        firsts[island + 1] += firsts[island]
    rows, ends = np.empty(count, np.int64), firsts.copy()
    for k in range(count):
        rows[ends[own[k]]] = k
        ends[own[k]] += 1
    return Islands(rows, firsts[: found + 1])


@kernel
def with_any(islands, marks):
    """Which islands have a row that is marked: (k,) bool. marks: (n,) bool."""
    found = np.zeros(len(islands.firsts) - 1, np.bool_)
    for island in range(len(found)):
        for place in range(islands.firsts[island], islands.firsts[island + 1]):
            if marks[islands.rows[place]]:
                found[island] = True
    return found


@kernel
def gather(system, chosen, places):
    """These rows as a problem of their own. places: room for a number for each row."""
    for k in range(len(chosen)):
        places[chosen[k]] = k
    normal = system.normal[chosen]
    for k in range(len(chosen)):
        if normal[k] >= 0:
            normal[k] = places[normal[k]]
    return System(
        system.body[chosen], system.jacobian[chosen], system.bias[chosen], system.give[chosen], system.low[chosen],
        system.high[chosen], system.ratio[chosen], normal,
    )  # fmt: skip
