"""What a step walks along: lists of the bodies, shapes, arbiters and joints that are awake.

They are made when content changes, and anew when something falls asleep, wakes, or is touched from outside; a step only
reads them. Where nothing sleeps they are lists of all. Static bodies count as awake: they never rest on anything.

An arbiter is looked at while one of its bodies can make it change: one that has weight and is awake, one without weight
that goes its way, or one that was touched from outside since the last step (the column `disturbed`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.arbiters import indices_by_collider
from engine.narrow_phase import COLLIDERS
from engine.shapes import BOUNDS
from engine.shapes.placing import group_of
from engine.simd import WIDTH
from engine.sleeping import asleep_of, joined_rows
from engine.tables import DYNAMIC

if TYPE_CHECKING:
    from engine.state import State


def list_all(state: State) -> None:
    """All lists but those of arbiters, which follow when pairs are."""
    state.lists_are_stale = False
    asleep = asleep_of(state)
    asleep = asleep if asleep is not None and asleep[state.bodies.order].any() else None
    state.acting = None if asleep is None else acting_rows(state, asleep)
    list_bodies(state, asleep)
    list_shapes(state, asleep)
    list_joints(state, asleep)
    if not state.pairs_are_stale:
        list_arbiters(state)
    disturbed = state.bodies.columns.get("disturbed")
    if disturbed is not None and disturbed.any():  # that was for this step
        disturbed[:] = 0
        state.lists_are_stale = asleep is not None
    state.colours_are_stale = True
    state.solve_plan = None
    state.addresses = {}  # a kernel that is handed other tables is another one


def acting_rows(state: State, asleep: np.ndarray) -> np.ndarray:
    """(rows of bodies,) bool: which of them can change what they touch."""
    motions = state.bodies.tables["motions"]
    going = (motions["vx"] != 0) | (motions["vy"] != 0) | (motions["w"] != 0)
    active = np.where(motions["inverse_mass"] > 0, asleep == 0, going)
    if "disturbed" in state.bodies.columns:
        active |= state.bodies.columns["disturbed"] != 0
    return active


def list_bodies(state: State, asleep: np.ndarray | None) -> None:
    """Rows of bodies, in the order of creation."""
    bodies, order = state.bodies.tables["bodies"], state.bodies.order
    state.awake_order = order = order if asleep is None else order[asleep[order] == 0]
    kinds = bodies["kind"][order]
    state.moving = order[kinds != 0]  # that may have a velocity
    weighs = state.bodies.tables["motions"]["inverse_mass"][order] > 0
    state.dynamic = order[(kinds == DYNAMIC) & weighs]  # what has no mass feels no force
    state.body_lanes = in_eights(state, order)
    state.moving_lanes = in_eights(state, state.moving)
    state.dynamic_lanes = in_eights(state, state.dynamic)


def in_eights(state: State, rows: np.ndarray) -> np.ndarray:
    """Rows of bodies, filled up to a multiple of eight with nobody's."""
    nobody = len(state.bodies.tables["bodies"]) - 1
    return np.append(rows, np.full(-len(rows) % WIDTH, nobody))


def list_shapes(state: State, asleep: np.ndarray | None) -> None:
    """Ranks of the shapes whose bounding boxes may change, and how they are found."""
    shapes, order = state.shapes.tables["shapes"], state.shapes.order
    if asleep is None:
        state.watched_ranks, state.awake_plan = None, state.full_plan
        return
    state.watched_ranks = np.flatnonzero(asleep[shapes["body"][order]] == 0)
    state.awake_plan = plan_bounds(state, state.watched_ranks)


def plan_bounds(state: State, ranks: np.ndarray) -> list[tuple]:
    """Which kernel finds the bounding boxes of which of the shapes of these ranks."""
    shapes, order = state.shapes.tables["shapes"], state.shapes.order
    kinds = shapes["kind"][order[ranks]]
    return [(BOUNDS[kind], group_of(ranks[kinds == kind], order, shapes)) for kind in np.unique(kinds)]


def list_joints(state: State, asleep: np.ndarray | None) -> None:
    """Joints whose bodies are awake; those of one are so together."""
    joints, order = state.joints.tables["joints"], state.joints.order
    if asleep is not None:
        order = order[(asleep[joints["body1"][order]] == 0) & (asleep[joints["body2"][order]] == 0)]
    state.arrange_joints(order)
    pairs = joined_rows(state)
    if asleep is not None:
        pairs = pairs[(asleep[pairs] == 0).all(axis=1)]
    state.joined_pairs = pairs


def list_arbiters(state: State) -> None:
    """The arbiters to look at, by collider."""
    table = state.arbiters
    if state.acting is None:
        state.watched = None
        state.indices = indices_by_collider(table.kinds[: table.count], table.nothing, len(COLLIDERS))
    else:
        rows = table.rows[: table.count]
        state.watched = watched = np.flatnonzero(state.acting[rows["body1"]] | state.acting[rows["body2"]])
        places = np.append(watched, table.nothing)  # -1, nothing, is the last
        kinds = table.kinds[watched]
        state.indices = [(places[own], number) for own, number in indices_by_collider(kinds, -1, len(COLLIDERS))]
    state.meetings = [
        (collide, *own) for collide, own in zip(state.colliders, state.indices, strict=True) if own[1]
    ]  # fmt: skip
    state.chosen = table.chosen
