"""direct: the exact answer of one step's constraints, for scenes of small islands.

All joints and contacts are one mixed linear complementarity problem in float64, solved to rounding (pivoting.py): a
joint's rate is 0, a contact presses or parts and does neither otherwise, and friction is as large as mu times what
presses, against what slides, or as large as holding takes. What differs from the truth is then the time step alone.
What no moving body links is a problem of its own: see islands.py.

Velocities are solved with positions as the step begins; bodies move; and then positions are projected: Newton's method,
whose steps are the same kind of problem, without friction, with the Jacobians of where bodies are (the shortest way, as
masses weigh it, to where no joint is apart and nothing overlaps). What bounces is told after that: the velocities'
problem once more, in which a contact that gave an impulse must part with e times the speed of approach.

Where loads may be shared in many ways, as under a pyramid, the answer is the one of least sum of P^2 / mass.
Sources: D. Stewart and J. Trinkle, "An implicit time-stepping scheme for rigid body dynamics with inelastic collisions
and Coulomb friction" (IJNME 39, 1996), whose friction is exact in the plane, where the cone is a wedge; M. Anitescu and
F. Potra (Nonlinear Dynamics 14, 1997).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.errors import TooLarge
from engine.jit import kernel
from engine.solvers import joint_rows
from engine.solvers import sequential_impulses as talk
from engine.solvers.direct.islands import group, link, with_any
from engine.solvers.direct.rows import System, add_rates, write_contacts, write_joints, write_places
from engine.solvers.direct.scaled import solve_islands
from engine.solvers.moving import advance, begin, shift, take_speeds, update_positions
from engine.solvers.ngs import bouncing, note_approach
from engine.solvers.ngs.contacts import store
from engine.solvers.soft_step import table
from engine.solvers.soft_step.restitution import bounces_at
from engine.solvers.soft_step.tables import mover_dtype
from engine.solvers.solver import Solver
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

MOST_ROWS = 200
"""Rows of an island that are still solved: two for each contact point, up to ten for a joint. Time grows with their
third power, and a step solves a dozen systems, or some hundreds where friction goes in circles."""

PROJECTIONS = 20
"""Most steps of Newton's method for positions; where little is wrong two or three do."""

CLOSE = 1e-13
"""What is no farther off than this [m], [rad] is where it should be."""

MOST = 0.2
"""Furthest that a projection moves a constraint [m], [rad]. Larger: what overlaps deeply is thrown about."""


@kernel
def push(system, count, motions, x):
    """Gives the bodies all impulses: v += M^-1 J^T x, summed up in float64."""
    change = np.zeros((len(motions), 3))
    for k in range(count):
        for side in range(2):
            row, sign = system.body[k, side], 2.0 * side - 1.0
            mass, inertia = np.float64(motions[row].inverse_mass), np.float64(motions[row].inverse_inertia)
            change[row, 0] += sign * mass * system.jacobian[k, 0] * x[k]
            change[row, 1] += sign * mass * system.jacobian[k, 1] * x[k]
            change[row, 2] += sign * inertia * system.jacobian[k, 2 + side] * x[k]
    for row in range(len(motions)):
        motion = motions[row]
        motion.vx += change[row, 0]
        motion.vy += change[row, 1]
        motion.w += change[row, 2]


@kernel
def keep(rows, arbiters, contacts, count, x):
    """Notes all impulses where joints and contacts have them."""
    k = 0
    if rows is not None:
        for i in range(len(rows)):
            rows[i].impulse = x[k]
            rows[i].given = x[k]
            k += 1
    for index in range(count):
        for i in range(arbiters[index].count):
            contacts[index, i].normal_impulse = x[k]
            contacts[index, i].tangent_impulse = x[k + 1]
            k += 2
    store(arbiters, contacts, count)


@kernel
def expect_bounces(system, first, arbiters, contacts, bounces, count, threshold, size):
    """Puts the speeds of bouncing into the problem of `size` rows. Returns which rows bounce: (size,) bool."""
    k, found = first, np.zeros(size, np.bool_)
    for index in range(count):
        for i in range(arbiters[index].count):
            bounce = bounces[index, i]
            if bounces_at(bounce.restitution, bounce.speed, contacts[index, i].given_normal, threshold):
                system.bias[k] = np.float64(bounce.restitution) * np.float64(bounce.speed)
                found[k] = True
            k += 2
    return found


@kernel
def shift_all(system, count, motions, movers, x):
    """Moves the bodies by M^-1 J^T x. A row that gives nothing is of an island that is done, and changes no bit."""
    for k in range(count):
        if x[k] == 0.0:
            continue
        for side in range(2):
            row = system.body[k, side]
            motion = motions[row]
            along = Vec2(system.jacobian[k, 0] * x[k], system.jacobian[k, 1] * x[k])
            arm = system.jacobian[k, 2 + side] * x[k]
            shift(movers[row], motion.inverse_mass, motion.inverse_inertia, along, arm, 2.0 * side - 1.0)


@kernel
def project(system, rows, frames, arbiters, contacts, count, motions, movers, parents):
    """Newton's method for positions, of each island until it is where it should be."""
    errors = np.empty(len(system.bias))
    found = write_places(system, rows, frames, arbiters, contacts, count, movers, MOST, errors)
    islands = group(system, found, motions, parents)  # what positions do not hold, springs, links as it does before
    for _ in range(PROJECTIONS):
        wanted = with_any(islands, errors[:found] > CLOSE)
        if not wanted.any():
            return
        x = np.zeros(found)
        solve_islands(system, islands, wanted, motions, system.bias[:found].copy(), x)
        shift_all(system, found, motions, movers, x)
        write_places(system, rows, frames, arbiters, contacts, count, movers, MOST, errors)


@kernel
def solve_all(
    bodies, motions, movers, order, moved, arbiters, contacts, count, bounces, belts, joints, turns, slides, rows,
    frames, parents, system, steps,
):  # fmt: skip
    """One step. Tables are None where nothing calls for them. Returns by what part the impulses may be wrong."""
    step = steps[0]
    begin(order, motions, movers)
    first = 0
    if rows is not None:
        joint_rows.prepare(rows, frames, joints, turns, slides, bodies, motions, movers, step)
        write_joints(system, rows, frames, step)
        first = len(rows)
    size = write_contacts(system, first, arbiters, contacts, count, belts, step)
    x = np.zeros(size)
    b = system.bias[:size].copy()
    add_rates(system, size, motions, b)
    free = b - system.bias[:size]
    islands = group(system, size, motions, parents)
    error = solve_islands(system, islands, np.ones(len(islands.firsts) - 1, np.bool_), motions, b, x)
    keep(rows, arbiters, contacts, count, x)
    push(system, size, motions, x)
    take_speeds(moved, motions, movers)
    advance(moved, movers, step.dt)
    if bounces is not None:
        marks = expect_bounces(system, first, arbiters, contacts, bounces, count, step.restitution_threshold, size)
        if marks.any():
            again = x.copy()  # islands where nothing bounces are done
            b = free + system.bias[:size]
            error = max(error, solve_islands(system, islands, with_any(islands, marks), motions, b, again))
            keep(rows, arbiters, contacts, count, again)
            push(system, size, motions, again - x)
            take_speeds(moved, motions, movers)
    if rows is not None:
        joint_rows.store(rows, frames, joints, turns, slides, step.parts)
    if step.position_correction != 0:
        project(system, rows, frames, arbiters, contacts, count, motions, movers, parents)
    return error


def size_of(state: State) -> int:
    """Rows of this step's problem."""
    table, found = state.arbiters, joint_rows.rows_of(state)
    touching = int(table.rows["count"][: table.count].sum())
    return 2 * touching + (0 if found is None else len(found.rows))


def find_islands(state: State) -> int:
    """Finds which bodies this step's problem links. Returns the number of rows of the largest island."""
    pairs, found, motions = state.arbiters, joint_rows.rows_of(state), state.bodies.tables["motions"]
    joints: tuple = (None, None, None)
    if found is not None:
        joints = (*found, state.joints.tables["joints"])
    parents = state.scratch["direct, parents"] = np.empty(len(motions), np.int64)
    arguments = (*joints, pairs.rows, pairs.count, motions, parents)
    return int(link(*arguments))


def apply_forces(state: State, settings: Settings) -> int:
    """Stage 2 of the talk. TooLarge if the scene is."""
    size = find_islands(state)
    if size > MOST_ROWS:
        raise TooLarge(
            f"step {state.step_count + 1}, stage 'apply forces': the solver 'direct' takes at most {MOST_ROWS} rows "
            f"in an island of bodies that touch or are joined, two for each contact point and up to ten for a joint, "
            f"and the largest has {size}: take another solver"
        )
    note_approach(state, settings)
    return talk.apply_forces(state, settings)


def empty_system(count: int) -> System:
    """Room for so many rows."""
    numbers = [np.zeros(count) for _ in range(5)]
    bias, give, low, high, ratio = numbers
    return System(
        np.zeros((count, 2), np.int64), np.zeros((count, 4)), bias, give, low, high, ratio, np.zeros(count, np.int64)
    )


def solve(state: State, settings: Settings) -> None:
    """Stage 3 of the talk, and where bodies go."""
    tables, pairs = state.bodies.tables, state.arbiters
    found = joint_rows.rows_of(state)
    joints: tuple = (None,) * 5
    if found is not None:
        joints = (*(state.joints.tables[name] for name in ("joints", "turns", "slides")), *found)
    movers = table(state, "movers", mover_dtype(state.precision), len(tables["bodies"]), exactly=True)
    arguments = (
        tables["bodies"], tables["motions"], movers, state.awake_order, state.moving, pairs.rows, pairs.contacts,
        pairs.count, bouncing(state), state.column("conveyor", state.shapes, "tangent_speed"), *joints,
        state.scratch["direct, parents"], empty_system(max(1, size_of(state))), state.steps,
    )  # fmt: skip
    state.scratch["direct, error"] = solve_all(*arguments)


DIRECT = Solver(
    "direct",
    apply_forces,
    solve,
    update_positions,
    iterations=1,
    has_iterations=False,
    speculative=True,
    lacks=("rolling resistance", "continuous collision", "bullets", *joint_rows.LACKING),
)
