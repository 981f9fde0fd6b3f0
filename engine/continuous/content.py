"""Continuous collision in a world: what is read off its content, and the sweep of the bodies found fast."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from engine.constants import CONTINUOUS_DEPTH, CONTINUOUS_WAY
from engine.continuous.fast import SLOWEST, measure_bodies
from engine.continuous.joined import rigid_pairs, stop_joined
from engine.continuous.stops import (
    ENCOUNTER,
    find_contacts_anew,
    find_encounters,
    hold_back,
    part_sunk,
    stop_at_each_other,
    stop_at_fixed,
    stop_at_kinematic,
)
from engine.narrow_phase import COLLIDER_OF
from engine.tables import DYNAMIC, empty

if TYPE_CHECKING:
    from engine.state import State

NAME = "continuous collision"
STATIC_GROUP, DYNAMIC_GROUP, KINEMATIC_GROUP = 0, 1, 2  # of State.groups


class Content(NamedTuple):
    """What sweeps need to know, until content or settings change."""

    slowest: np.ndarray  # (B + 1,) SLOWEST by row of bodies, the last for all of them
    fast: np.ndarray  # (D,) int64: room for rows of fast bodies
    first_shapes: np.ndarray  # (B + 1,) int64: where a body's shapes begin in shape_rows
    shape_rows: np.ndarray  # (S,) int64: rows of shapes by body, in the order of creation
    reaches: np.ndarray  # by row of shapes: how far its outline is from its body's centre of mass at most [m]
    fixed: np.ndarray  # ranks of static shapes
    kinematic: np.ndarray  # ranks of kinematic shapes
    dynamic: np.ndarray  # rows of dynamic shapes
    until: np.ndarray  # (B,) when each body stops; 1 outside of a sweep
    sunk: (
        np.ndarray
    )  # (B, 2) int64: which two shapes overlapped already and keep it from going on; -1 outside of a sweep
    carriers: np.ndarray  # (B,) int64: the kinematic body that carries it on; -1
    joined: np.ndarray  # (J, 2) int64: rows of bodies that stop together
    filters: tuple[Any, Any, Any, Any]  # joined, category, mask, group: of length 0 where not called for


def content_of(state: State) -> Content | None:
    """What there is, made anew after a change; None where continuous collision is not called for."""
    if NAME not in state.effects:
        return None
    if NAME not in state.gathered:
        state.gathered[NAME] = read_content(state)
    content: Content = state.gathered[NAME]
    return content


def read_content(state: State) -> Content:
    """Reads all of it off the tables."""
    bodies, shapes, order = state.bodies.tables["bodies"], state.shapes.tables["shapes"], state.shapes.order
    owners = shapes["body"][order]
    by_body = np.argsort(owners, kind="stable")
    slowest, reaches = empty(len(bodies) + 1, SLOWEST), np.zeros(len(shapes))
    first_shapes = np.searchsorted(owners[by_body], np.arange(len(bodies) + 1))
    shape_rows = np.ascontiguousarray(order[by_body])
    weighs = (bodies["kind"] == DYNAMIC) & (state.bodies.tables["motions"]["inverse_mass"] > 0.0)
    dynamic = state.bodies.order[weighs[state.bodies.order]]  # of those that sleep now, too
    measure_bodies(
        dynamic, first_shapes, shape_rows, shapes, state.hulls.tables["hulls"], bodies,
        CONTINUOUS_WAY, CONTINUOUS_DEPTH, slowest, reaches,
    )  # fmt: skip
    filtered = "filters" in state.effects
    nothing = np.empty(0, np.int64)
    category, mask, group = (state.shapes.ensure(n) if filtered else nothing for n in ("category", "mask", "group"))
    joined = np.empty((0, 2), np.int64) if state.joined is None else state.joined
    return Content(
        slowest, np.empty(len(dynamic), np.int64), first_shapes, shape_rows, reaches,
        np.flatnonzero(state.groups == STATIC_GROUP), np.flatnonzero(state.groups == KINEMATIC_GROUP),
        order[state.groups == DYNAMIC_GROUP], np.ones(len(bodies)), np.full((len(bodies), 2), -1),
        np.full(len(bodies), -1),
        rigid_pairs(state),
        (joined, category, mask, group),
    )  # fmt: skip


def ahead(state: State) -> tuple:
    """What `drop_ahead` takes."""
    content = content_of(state)
    bullet = state.column("bullets", state.bodies, "bullet")
    return (
        state.arbiters.rows, state.arbiters.contacts, state.arbiters.count, state.dynamic_lanes,
        state.bodies.tables["motions"], None if content is None else content.slowest, bullet, state.steps,
    )  # fmt: skip


def stop_fast(state: State, content: Content, count: int) -> None:
    """Shortens the ways of the bodies in the first `count` rows of content.fast, and of those that bullets meet."""
    c = content
    fast = c.fast[:count]
    shapes, hulls, bodies = state.shapes.tables["shapes"], state.hulls.tables["hulls"], state.bodies.tables["bodies"]
    moved, scratch = state.scratch["movers"], np.empty((3, 8, 5))
    of_shapes = (c.first_shapes, c.shape_rows, c.reaches)
    things = (shapes, hulls, bodies, moved)
    if len(c.fixed):
        stop_at_fixed(
            fast, c.slowest, *of_shapes, c.fixed, state.shapes.order, state.bounds, *things, COLLIDER_OF, *c.filters,
            c.until, c.sunk, scratch,
        )  # fmt: skip
    if len(c.kinematic):
        stop_at_kinematic(
            fast, *of_shapes, c.kinematic, state.shapes.order, state.bounds, np.empty((len(c.kinematic), 4)), *things,
            COLLIDER_OF, *c.filters, c.until, c.sunk, c.carriers, scratch
        )  # fmt: skip
    stopping = fast
    if "bullets" in state.effects:
        hurry = np.zeros(len(bodies), np.bool_)
        hurry[fast] = True
        pairs = encounters_of(state, c, fast, hurry)
        stop_at_each_other(pairs, *things, c.until, c.sunk, c.carriers, scratch)
        met = np.concatenate([shapes["body"][pairs["shape1"]], shapes["body"][pairs["shape2"]]])
        stopping = np.concatenate([fast, np.setdiff1d(met, fast)])
    part_sunk(stopping, *things, state.bodies.tables["motions"], c.until, c.sunk, scratch)
    if len(c.joined) and c.until.min() < 1.0:
        stop_joined(c.joined, c.until)
        stopping = np.union1d(stopping, np.flatnonzero(c.until < 1.0))
    find_contacts_anew(state.arbiters.rows, state.arbiters.count, c.until)
    hold_back(stopping, bodies, moved, c.until, c.carriers)
    c.carriers[fast] = -1


def encounters_of(state: State, content: Content, fast: np.ndarray, hurry: np.ndarray) -> Any:
    """(E,) ENCOUNTER: which dynamic shapes may meet, one of a bullet."""
    c = content
    bullet = state.bodies.ensure("bullet")
    rest_sleepers(state)
    arguments = (
        fast, hurry, c.first_shapes, c.shape_rows, c.reaches, c.dynamic, np.empty((len(c.dynamic), 4)), bullet,
        state.shapes.tables["shapes"], state.bodies.tables["bodies"], state.scratch["movers"], COLLIDER_OF, *c.filters,
    )  # fmt: skip
    room = 64
    while True:
        pairs = empty(room, ENCOUNTER)
        found = int(find_encounters(*arguments, pairs))
        if found <= room:
            return pairs[:found]
        room = 2 * found


def rest_sleepers(state: State) -> None:
    """What sleeps stays where it is: its mover is that of an earlier step."""
    asleep = state.bodies.columns.get("asleep")
    if asleep is not None:
        moved, rows = state.scratch["movers"], np.flatnonzero(asleep)
        for name in ("vx", "vy", "w", "turned", "dx", "dy", "sine"):
            moved[name][rows] = 0.0
        moved["cosine"][rows] = 1.0
