"""Which islands of joints are solved at once: those that would give way if their joints were visited one by one.

A joint that carries a load F gives way by F K / w^2, K being what an impulse of 1 changes of its rate and w = 2 pi f
its frequency (docs/soft_step.md). The loads are those of gravity, from the system that would be solved: what hangs,
hangs on its joints, and what falls freely carries nothing. So a scene calls for it by what it is made of.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.solvers.soft_step.direct.plan import Order, least_degree
from engine.tables import ALONG_NOTHING, DISTANCE, NOTHING, PRISMATIC, REVOLUTE, STIFF, WELD, WHEEL

if TYPE_CHECKING:
    from engine.state import State

MOST_STRETCH = 1e-3
"""Islands whose joints would give way further are solved at once [m]. Larger: chains stretch visibly; smaller: ragdolls
and carts pay for what nobody sees."""

LONG, HEAVY = 16, 30.0
"""An island that hangs on nothing is looked at, as if it hung on its heaviest body, if it has so many joints, or bodies
of such different mass."""

FILLING = 4
"""Blocks for each joint, at most: beyond, as in nets, visiting joints one by one costs less by far."""

RIGID = (REVOLUTE, DISTANCE, PRISMATIC, WELD, WHEEL)


def rigid_joints(state: State) -> np.ndarray:
    """Rows of the joints that hold something rigidly, whatever force it takes, in the order of creation."""
    joints, order = state.joints.tables["joints"], state.joints.order
    turns, slides = state.joints.tables["turns"], state.joints.tables["slides"]
    joint, turn, slide = joints[order], turns[order], slides[order]
    kinds = np.isin(joint["kind"], RIGID)
    holds = (
        (joint["held"] != NOTHING) & (joint["hertz"] == 0.0) & (joint["softness"] == 0.0) & (joint["bias_factor"] < 0.0)
    )
    rod = (slide["along"] != ALONG_NOTHING) & (slide["spring"] == STIFF)
    rod &= (slide["motored"] == 0) & (slide["limited"] == 0)
    turned = (turn["along"] == ALONG_NOTHING) | (turn["spring"] == STIFF) | (joint["kind"] != WELD)
    return order[kinds & (holds & turned | rod)]


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


def islands_of(state: State, rows: np.ndarray) -> list[Island]:
    """Islands of two joints or more, in the order of creation; nets, with many loops, are left out."""
    joints, motions = state.joints.tables["joints"], state.bodies.tables["motions"]
    moves = motions["inverse_mass"] > 0.0
    root = np.empty(len(moves), np.int64)
    link(joints, rows, moves, root)
    one, other = joints["body1"][rows], joints["body2"][rows]
    label = np.where(moves[one], root[one], root[other])
    inner = moves[one] & moves[other]
    names, places, counts = np.unique(label, return_inverse=True, return_counts=True)
    members = np.bincount(np.searchsorted(names, root[moves & np.isin(root, names)]), minlength=len(names))
    loops = np.bincount(places, inner, len(names)) - members + 1
    wanted = np.flatnonzero((counts > 1) & (loops <= counts // FILLING + FILLING))
    found = []
    for island in sorted(wanted, key=lambda island: int(np.argmax(places == island))):
        own = places == island
        bodies = np.unique(np.concatenate([one[own], other[own]]))
        found.append(Island(rows[own], bodies[moves[bodies]], not inner[own].all()))
    return found


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


def may_give_way(state: State, island: Island) -> bool:
    """Whether it is worth a look: what falls freely and is short and of like masses is not."""
    mass = state.bodies.tables["bodies"]["mass"][island.bodies]
    return island.hangs or len(island.rows) >= LONG or float(mass.max()) >= HEAVY * float(mass.min())


def gives_way(loads: np.ndarray, diagonals: np.ndarray, hertz: float) -> float:
    """How far the joint that gives way most would, visited one by one [m]. loads (n, 3): force of each row."""
    return float(np.abs(loads * diagonals).max(initial=0.0)) / (2.0 * math.pi * hertz) ** 2
