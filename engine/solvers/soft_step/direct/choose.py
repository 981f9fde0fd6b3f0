"""Which islands of joints are solved at once: those that would give way if their joints were visited one by one.

A joint that carries a load F gives way by F K / w^2, K being what an impulse of 1 changes of its rate and w = 2 pi f
its frequency (docs/soft_step.md). The loads are those of motors, and those of gravity, or of 10 m/s^2 where there is
less, as if the island hung in a line from what it is joined to: see loads.py. So a scene calls for it by what it is
made of.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.solvers.soft_step.direct.plan import Order, least_degree
from engine.tables import DISTANCE, NOTHING, PRISMATIC, REVOLUTE, STIFF, WELD, WHEEL

if TYPE_CHECKING:
    from engine.state import State

MOST_STRETCH = 1e-3
"""Islands whose joints would give way further are solved at once [m]. Larger: chains stretch visibly; smaller: ragdolls
and carts pay for what nobody sees."""

LEAST_GRAVITY = 10.0
"""Loads are those of this, at least [m/s^2]: what is whirled, driven or attracted bears loads without gravity, too."""

LONG, HEAVY = 16, 30.0
"""An island that hangs on nothing is looked at, as if it hung on its lightest body, if it has so many joints, or bodies
of such different mass."""

FILLING = 4
"""Blocks for each joint, at most: beyond, as in nets, visiting joints one by one costs less by far."""

RIGID = (REVOLUTE, DISTANCE, PRISMATIC, WELD, WHEEL)


def rigid_joints(state: State, order: np.ndarray) -> np.ndarray:
    """Those of the joints in these rows that hold something rigidly, whatever force it takes."""
    tables = state.joints.tables

    def column(table: str, name: str) -> np.ndarray:
        return tables[table][name][order]

    holds = (column("joints", "held") != NOTHING) & (column("joints", "hertz") == 0.0)
    holds &= (column("joints", "softness") == 0.0) & (column("joints", "bias_factor") < 0.0)
    kind = column("joints", "kind")
    holds &= (kind != WELD) | (column("turns", "spring") == STIFF)
    rod = (
        (column("slides", "spring") == STIFF) & (column("slides", "motored") == 0) & (column("slides", "limited") == 0)
    )
    return order[np.isin(kind, RIGID) & (holds | rod)]


@kernel
def link(joints, rows, moves, root):
    """Union of the bodies that joints connect: root (bodies,) int64 leads from each to one of its island."""
    for body in range(len(root)):
        root[body] = body
    for k in range(len(rows)):
        one, other = joints[rows[k]].body1, joints[rows[k]].body2
        if moves[one] and moves[other]:
            root[find(root, one)] = find(root, other)
    for body in range(len(root)):
        root[body] = find(root, body)


@kernel
def find(root, body):
    """The body that stands for an island."""
    while root[body] != body:
        root[body] = root[root[body]]
        body = root[body]
    return body


class Island(NamedTuple):
    """Joints that are connected through bodies that impulses move."""

    rows: np.ndarray  # of the joints
    bodies: np.ndarray  # rows of the bodies that move
    hangs: bool  # whether any is joined to what does not move


def islands_of(state: State, rows: np.ndarray, driven: np.ndarray | None) -> list[Island]:
    """Islands of two joints or more, in the order of creation; nets, with many loops, are left out.

    driven: what motors ask of each body (loads.py); then those alone that are worth a look: what falls freely, and is
    short, of like masses and without motors, is not.
    """
    joints, motions = state.joints.tables["joints"], state.bodies.tables["motions"]
    moves = motions["inverse_mass"] > 0.0
    rows = rows[moves[joints["body1"][rows]] | moves[joints["body2"][rows]]]  # what has no mass yet is held by nothing
    root = np.empty(len(moves), np.int64)
    link(joints, rows, moves, root)
    one, other = joints["body1"][rows], joints["body2"][rows]
    inner = moves[one] & moves[other]
    label = np.where(moves[one], root[one], root[other])  # of each joint
    names, places, counts = np.unique(label, return_inverse=True, return_counts=True)
    bodies = np.flatnonzero(moves & np.isin(root, names))
    islands = np.searchsorted(names, root[bodies])  # of each body
    loops = np.bincount(places, inner, len(names)) - np.bincount(islands, minlength=len(names)) + 1
    hangs = np.bincount(places, ~inner, len(names)) > 0
    wanted = (counts > 1) & (loops <= counts // FILLING + FILLING)
    if driven is not None:
        mass = state.bodies.tables["bodies"]["mass"][bodies]
        least, most = np.full(len(names), np.inf), np.zeros(len(names))
        np.minimum.at(least, islands, mass)
        np.maximum.at(most, islands, mass)
        asked = np.bincount(islands, driven[bodies], len(names)) > 0.0
        wanted &= hangs | asked | (counts >= LONG) | (most >= HEAVY * least)
    by_island, by_body = np.argsort(places, kind="stable"), np.argsort(islands, kind="stable")
    ends, body_ends = np.cumsum(counts), np.cumsum(np.bincount(islands, minlength=len(names)))
    found = [
        Island(
            rows[by_island[ends[k] - counts[k] : ends[k]]],
            bodies[by_body[body_ends[k - 1] if k else 0 : body_ends[k]]],
            bool(hangs[k]),
        )
        for k in np.flatnonzero(wanted)
    ]
    return sorted(found, key=lambda island: int(joints["serial"][island.rows[0]]))


def order_of(state: State, island: Island) -> Order | None:
    """In which order to eliminate its joints; None where that would couple too many."""
    joints = state.joints.tables["joints"]
    moving = set(island.bodies.tolist())
    at_body: dict[int, list[int]] = {}
    for row in island.rows.tolist():
        for body in (int(joints["body1"][row]), int(joints["body2"][row])):
            if body in moving:
                at_body.setdefault(body, []).append(row)
    if max(map(len, at_body.values())) > 8 * FILLING:
        return None
    neighbours: dict[int, set[int]] = {row: set() for row in island.rows.tolist()}
    for members in at_body.values():
        for member in members:
            neighbours[member].update(members)
    for member, others in neighbours.items():
        others.discard(member)
    return least_degree(neighbours, FILLING * len(neighbours) + 2 * FILLING)
