"""Falling asleep and waking: what rests costs nothing.

A body is still while the root mean square speed of all its mass, sqrt(v^2 + w^2 I / m), is below `sleep_speed`, and so
is what it went in the step; how long it has been stands in its row of motions. What touched it and parted, or is done
to it from outside, begins that time anew. An island (engine/islands.py) falls asleep in the step that finds each of its
bodies still for `sleep_time`: their velocities become zero, and from then on no list that a step walks along holds them
(engine/awake.py). Their contacts and joints keep impulses and colours as they are.

Asleep and awake never touch, for an island wakes as a whole, and at once: when something awake touches it, in that very
step; when it, or what it touches or is joined to, is changed from outside; when settings change. What lies elsewhere
sleeps on. A body does not fall asleep while something acts on it that may change without being seen here: wind,
magnets, point gravity, a fluid, a belt, a motor, or a kinematic body that moves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.islands import COARSE, DRIVEN, KNOWN, STAMP, are_marked, find, mark_islands, name_islands
from engine.jit import kernel

if TYPE_CHECKING:
    from engine.state import State

LONG = 1e9  # longer than any sleep_time [s]


@kernel
def moves(motion):
    """Whether a body that nothing pushes goes its way."""
    return motion.inverse_mass == 0 and (motion.vx != 0 or motion.vy != 0 or motion.w != 0)


@kernel
def stir(motions, one, other):
    """Two bodies touch or are joined: neither is still if the other goes its way."""
    if moves(motions[one]) or moves(motions[other]):
        forget_stillness(motions, one, other)


@kernel
def forget_stillness(motions, one, other):
    """Neither of two bodies has been still so far."""
    motions[one].still = 0
    motions[other].still = 0


@kernel
def stir_driven(indices, arbiters, belts, pairs, motions):
    """No body is still that a belt or a body that goes its way drives, by touch or by joint."""
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        if arbiter.count > 0:
            stir(motions, arbiter.body1, arbiter.body2)
            if belts[arbiter.shape1] != 0 or belts[arbiter.shape2] != 0:
                forget_stillness(motions, arbiter.body1, arbiter.body2)
    for k in range(len(pairs)):
        stir(motions, pairs[k, 0], pairs[k, 1])


@kernel
def may_sleep(ready, flags, dynamic, motions, parents, busy, restless, indices, arbiters, belts, pairs, steps):
    """Whether islands may fall asleep, or whether to find that out they must first be made exact.

    ready (1,) int64: how many bodies have been still for long enough, at most; dynamic: rows of the bodies that are
    awake. Afterwards an island is busy where its first body's `busy` is flags[STAMP].
    """
    if ready[0] == 0:
        return False
    if flags[DRIVEN] != 0:
        stir_driven(indices, arbiters, belts, pairs, motions)
    if flags[KNOWN] == 0:
        return True
    flags[STAMP] += 1
    stamp = flags[STAMP]
    enough = steps[0].sleep_time
    waiting = 0
    for k in range(len(dynamic)):
        row = dynamic[k]
        if motions[row].still >= enough and restless[row] == 0:
            waiting += 1
        else:
            busy[find(parents, row)] = stamp
    if waiting == 0:
        return False
    if flags[COARSE] != 0:
        return True
    for k in range(len(dynamic)):
        row = dynamic[k]
        if parents[row] == row and busy[row] != stamp:
            return True
    return False


@kernel
def idle_rows(dynamic, parents, busy, stamp, found):
    """found (N,) bool: which of the bodies are of islands that are not busy."""
    for k in range(len(dynamic)):
        found[k] = busy[find(parents, dynamic[k])] != stamp


@kernel
def touched_sleepers(indices, arbiters, asleep, found):
    """Rows of sleeping bodies that are touched according to the arbiters at these indices; returns how many.

    found: (2 * indices,) int64.
    """
    total = len(found) * 0  # a literal would be a type of its own
    for k in range(len(indices)):
        arbiter = arbiters[indices[k]]
        if arbiter.count > 0:
            for row in (arbiter.body1, arbiter.body2):
                if asleep[row] != 0:
                    found[total] = row
                    total += 1
    return total


@kernel
def touching_rows(arbiters, count, row, found):
    """Rows of the bodies that touch the one in `row`; returns how many. found: (count,) int64."""
    total = count * 0  # a literal would be a type of its own
    for k in range(count):
        arbiter = arbiters[k]
        if arbiter.count > 0 and (arbiter.body1 == row or arbiter.body2 == row):
            found[total] = arbiter.body1 + arbiter.body2 - row
            total += 1
    return total


def asleep_of(state: State) -> np.ndarray | None:
    """The column that says who sleeps; None while nobody does."""
    return state.bodies.columns.get("asleep")


def sleeping_rows(state: State) -> np.ndarray:
    """Rows of the bodies that sleep, in the order of creation."""
    asleep, order = asleep_of(state), state.bodies.order
    return order[:0] if asleep is None else order[asleep[order] != 0]


def joined_rows(state: State) -> np.ndarray:
    """(J, 2) int64: rows of the bodies that are joined, in the order of creation of the joints."""
    joints, order = state.joints.tables["joints"], state.joints.order
    return np.stack([joints["body1"][order], joints["body2"][order]], axis=1)


# --- falling asleep -------------------------------------------------------------------------------------------------


def asking(state: State) -> tuple:
    """What `may_sleep` takes."""
    islands = state.islands
    return (
        state.ready, islands.flags, state.dynamic, state.bodies.tables["motions"], islands.parents, islands.busy,
        state.restless, state.watched_arbiters(), state.arbiters.rows, state.belts, state.joined_pairs, state.steps,
    )  # fmt: skip


def fall_asleep(state: State) -> bool:
    """Puts to sleep what may, and returns whether anything did. Contacts and islands must be up to date."""
    if state.fluids.count:
        stir_wet(state)
    if not may_sleep(*asking(state)):
        return False
    if not state.islands.known or state.islands.flags[COARSE]:
        find_islands(state)
        if not may_sleep(*asking(state)):
            return False
    islands, dynamic = state.islands, state.dynamic
    idle = np.empty(len(dynamic), np.bool_)
    idle_rows(dynamic, islands.parents, islands.busy, islands.flags[STAMP], idle)
    put_to_sleep(state, dynamic[idle])
    return True


def put_to_sleep(state: State, rows: np.ndarray) -> None:
    """Whole islands, by the rows of their bodies."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    for name in ("vx", "vy", "w"):
        motions[name][rows] = 0.0
    for name in ("force_x", "force_y", "torque"):  # what drag left of a last breath
        bodies[name][rows] = 0.0
    state.bodies.put("asleep", rows, 1)
    state.lists_are_stale = True
    state.happened.note_fell_asleep(bodies["serial"][rows])


def stir_wet(state: State) -> None:
    """No body is still that reaches into a fluid."""
    order, shapes = state.shapes.order, state.shapes.tables["shapes"]
    wet = np.zeros(len(order), np.bool_)
    for row in state.fluids.order:
        wet |= reach_into(state, state.fluids.tables["fluids"][row])
    state.bodies.tables["motions"]["still"][shapes["body"][order[wet]]] = 0.0


def reach_into(state: State, fluid: np.ndarray) -> np.ndarray:
    """(S,) bool: which shapes' bounding boxes, as the last step had them, reach into a fluid."""
    left, bottom, right, top = state.bounds
    across = (left <= fluid["upper_x"]) & (right >= fluid["lower_x"])
    return across & (bottom <= fluid["upper_y"]) & (top >= fluid["lower_y"])


def find_islands(state: State) -> None:
    """Makes the islands of all bodies exact, or those of the bodies that are awake, if the others' are."""
    table, pairs = state.arbiters, joined_rows(state)
    own, indices = state.bodies.order, np.arange(table.count)
    if state.islands.known and not state.stale:
        own, indices, pairs = state.dynamic, state.watched_arbiters(), state.joined_pairs
    elif not state.islands.known:
        state.islands.forget(len(state.bodies.tables["bodies"]))
    state.islands.build(own, indices, table.rows, pairs, state.bodies.tables["motions"])


def island_names(state: State) -> np.ndarray:
    """(N,) int64: for each body, in the order of creation, the number of its island's first one."""
    if not state.islands.known or state.islands.flags[COARSE]:
        state.islands.forget(len(state.bodies.tables["bodies"]))
        find_islands(state)
    names = np.empty(state.bodies.count, np.int64)
    name_islands(state.bodies.order, state.islands.parents, names)
    return names


# --- waking ---------------------------------------------------------------------------------------------------------


def wake(state: State, rows: np.ndarray) -> None:
    """Wakes the islands of these sleeping bodies."""
    asleep = asleep_of(state)
    if asleep is None or len(rows) == 0:
        return
    if not state.islands.known:
        find_islands(state)
    parents, sleepers = state.islands.parents, sleeping_rows(state)
    marks, found = np.zeros(len(parents), np.uint8), np.empty(len(sleepers), np.bool_)
    mark_islands(np.asarray(rows, np.int64), parents, marks)
    are_marked(sleepers, parents, marks, found)
    rouse(state, sleepers[found])


def rouse(state: State, rows: np.ndarray) -> None:
    """Whole islands, by the rows of their bodies."""
    state.bodies.put("asleep", rows, 0)
    state.bodies.tables["motions"]["still"][rows] = 0.0
    state.lists_are_stale = True
    state.happened.note_woke(state.bodies.tables["bodies"]["serial"][rows])


def wake_all(state: State) -> None:
    """Wakes everything; nothing has been still so far."""
    rouse(state, sleeping_rows(state))
    state.bodies.tables["motions"]["still"] = 0.0


def wake_touched(state: State) -> bool:
    """Wakes what something awake touches. Returns whether there was any. Contacts must be up to date."""
    asleep = asleep_of(state)
    if asleep is None:
        return False
    indices = state.watched_arbiters()
    found = np.empty(2 * len(indices), np.int64)
    count = touched_sleepers(indices, state.arbiters.rows, asleep, found)
    if count:
        wake(state, found[:count])
    return count > 0


def touch(state: State, row: int, going: bool = False) -> None:
    """Something is done to the body in this row, now: it has not been still, and its island wakes.

    Where it has no weight, or is going, what touches it or is joined to it has not been still either, and wakes. And
    the next step looks where it is now.
    """
    motions, asleep = state.bodies.tables["motions"], asleep_of(state)
    motions["still"][row] = 0.0
    held = motions["inverse_mass"][row] == 0
    if held or going:
        neighbours = neighbours_of(state, row)
        motions["still"][neighbours] = 0.0
        if asleep is not None:
            wake(state, neighbours[asleep[neighbours] != 0])
    if asleep is not None and asleep[row]:
        wake(state, np.array([row]))
    if asleep is not None and held:
        state.bodies.put("disturbed", row, 1)
        state.boxes_are_stale = state.lists_are_stale = True


def hush(state: State, row: int) -> None:
    """Stops the island of the body in this row, as if it had been still for long: the next step puts it to sleep."""
    motions = state.bodies.tables["motions"]
    if not state.islands.known or state.islands.flags[COARSE]:
        state.islands.forget(len(motions))
        find_islands(state)
    parents, order = state.islands.parents, state.bodies.order
    marks, found = np.zeros(len(parents), np.uint8), np.empty(len(order), np.bool_)
    mark_islands(np.array([row]), parents, marks)
    are_marked(order, parents, marks, found)
    for name in ("vx", "vy", "w"):
        motions[name][order[found]] = 0.0
    motions["still"][order[found]] = LONG
    state.ready[0] = 1


def touch_weights(state: State, rows: np.ndarray) -> None:
    """`touch` for those of some bodies that have weight: nothing is done to what the others touch."""
    for row in rows[state.bodies.tables["motions"]["inverse_mass"][rows] > 0]:
        touch(state, int(row))


def neighbours_of(state: State, row: int) -> np.ndarray:
    """Rows of the bodies that touch the one in `row`, or are joined to it."""
    table, joined = state.arbiters, joined_rows(state)
    found = np.empty(table.count, np.int64)
    touching = found[: touching_rows(table.rows, table.count, row, found)]
    joined = joined[(joined == row).any(axis=1)].ravel()
    return np.unique(np.concatenate([touching, joined[joined != row]]))


def wake_in(state: State, fluid_row: int) -> None:
    """Wakes what reaches into a fluid that has come."""
    sleepers = sleeping_rows(state)
    if len(sleepers) == 0:
        return
    order, shapes = state.shapes.order, state.shapes.tables["shapes"]
    if state.bounds.shape[1] != len(order):  # content changed since the last step
        wake_all(state)
        return
    rows = np.unique(shapes["body"][order[reach_into(state, state.fluids.tables["fluids"][fluid_row])]])
    wake(state, np.intersect1d(rows, sleepers))


# --- while it lasts -------------------------------------------------------------------------------------------------


def carry_impulses(state: State, carried: float) -> None:
    """A longer step gives greater impulses: those of what sleeps are kept for it, times `carried`."""
    asleep, table = asleep_of(state), state.arbiters
    if asleep is None:
        return
    rows = table.rows[: table.count]
    resting = np.flatnonzero((asleep[rows["body1"]] != 0) | (asleep[rows["body2"]] != 0))
    table.rows["rolling_impulse"][resting] *= carried
    for name in ("normal_impulse", "tangent_impulse", "given_normal", "given_tangent"):
        table.contacts[name][resting] *= carried
    joints, order = state.joints.tables["joints"], state.joints.order
    resting = order[(asleep[joints["body1"][order]] != 0) | (asleep[joints["body2"][order]] != 0)]
    for name in ("impulse_x", "impulse_y", "given_x", "given_y"):
        joints[name][resting] *= carried
    for part in (state.joints.tables["turns"], state.joints.tables["slides"]):
        for name in ("spring", "motor", "lower", "upper"):
            for end in ("impulse", "given"):
                part[f"{name}_{end}"][resting] *= carried
