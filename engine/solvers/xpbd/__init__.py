"""Extended position based dynamics: bodies are moved to where constraints hold, and velocities follow from positions.

A substep: velocities from forces, positions from velocities, one pass (or `iterations`) that moves bodies out of
overlap and joints together, velocities from how far bodies went, and a pass over velocities for friction and bouncing.
Nothing is carried from substep to substep: small steps do what warm starting does elsewhere.
Source: M. Mueller, M. Macklin, N. Chentanez, S. Jeschke, T.-Y. Kim, "Detailed Rigid Body Simulation with Extended
Position Based Dynamics" (2020), whose equations are named beside the code; M. Macklin et al., "Small Steps in Physics
Simulation" (2019).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.mixing import RULES
from engine.simd import WIDTH
from engine.solvers import soft_step
from engine.solvers.joint_rows import LACKING, awake_rows, prepare, store
from engine.solvers.soft_step import movers
from engine.solvers.soft_step.tables import drive_dtype, mover_dtype
from engine.solvers.solver import Solver, solve_planned
from engine.solvers.xpbd import contacts, joints
from engine.solvers.xpbd.tables import pair_dtype, point_dtype
from engine.tables import REALS, empty

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def solve_all(
    order, dynamic, moving, bodies, motions, moved, drives, slots, arbiters, touching, shapes, pairs, points,
    frictional, tangent_speed, rolling_resistance, restitutions, rule, rows, frames, rests, joint_table, turns, slides,
    gravity, scales, linear, angular, steps,
):  # fmt: skip
    """All substeps. Tables are None where nothing calls for them."""
    step = steps[0]
    all_bodies, falling, going = len(order) // WIDTH, len(dynamic) // WIDTH, len(moving) // WIDTH
    movers.begin(0, all_bodies, order, motions, moved)
    movers.drive(0, falling, dynamic, bodies, motions, gravity, scales, drives, step)
    count = contacts.prepare(slots, arbiters, touching, motions, pairs, points, frictional)
    contacts.prepare_effects(count, arbiters, shapes, pairs, tangent_speed, rolling_resistance, restitutions, rule)
    if rows is not None:
        prepare(rows, frames, joint_table, turns, slides, bodies, motions, moved, step)
    for _ in range(step.substeps):
        if rows is not None:
            joints.begin(rows, frames, rests, moved, step)
        contacts.begin(count, moved, pairs, points, step)
        movers.integrate_velocities(0, falling, dynamic, drives, moved, linear, angular, step)
        movers.integrate_positions(0, going, moving, moved, step.h)
        for _ in range(step.iterations):
            if rows is not None:
                joints.solve_positions(rows, frames, rests, moved, step)
            contacts.solve_positions(count, moved, pairs, points, frictional, step)
        if rows is not None:
            joints.solve_velocities(rows, frames, moved, step)
        contacts.solve_velocities(count, moved, pairs, points, frictional, rolling_resistance, restitutions, step)
    contacts.store(count, pairs, points, arbiters, touching)
    if rows is not None:
        for k in range(len(rows)):
            rows[k].impulse = rows[k].given
        store(rows, frames, joint_table, turns, slides, step.parts / step.parts)


def solve(state: State, settings: Settings) -> None:
    """All substeps."""
    solve_planned(state, settings, solve_all, arguments)


def arguments(state: State, settings: Settings) -> tuple:
    """All tables: they hold until content, settings or what touches change."""
    table, p = state.arbiters, state.precision
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    pairs, points = state.scratch.get("xpbd pairs"), state.scratch.get("xpbd points")
    if pairs is None or points is None or len(pairs) < len(state.layout.slots):
        count = 2 * len(state.layout.slots)
        pairs = state.scratch["xpbd pairs"] = empty(count, pair_dtype(p))
        points = state.scratch["xpbd points"] = empty((count, 2), point_dtype(p))
    steps, effects = state.steps, state.effects
    return (
        state.body_lanes, state.dynamic_lanes, state.moving_lanes, bodies, motions,
        soft_step.table(state, "movers", mover_dtype(p), len(bodies), exactly=True),
        soft_step.table(
            state, "drives", soft_step.wide_dtype(drive_dtype(p), WIDTH), len(state.dynamic_lanes) // WIDTH
        ),
        state.layout.slots, table.rows, table.contacts, state.shapes.tables["shapes"], pairs, points,
        steps if "friction" in effects else None,
        state.column("conveyor", state.shapes, "tangent_speed"),
        state.column("rolling resistance", state.shapes, "rolling_resistance"),
        state.column("restitution", state.shapes, "restitution"),
        RULES.index(settings.restitution_mixing), *joint_arguments(state),
        steps if "gravity" in effects else None, state.gravity_scales, state.linear_damping, state.angular_damping,
        steps,
    )  # fmt: skip


def joint_arguments(state: State) -> tuple:
    """The tables of joints that are awake; None where no joint does anything."""
    found = awake_rows(state)
    if found is None:
        return (None,) * 6
    joints = state.joints.tables
    rests = np.zeros(len(found.rows), REALS[state.precision])
    return found.rows, found.frames, rests, joints["joints"], joints["turns"], joints["slides"]


XPBD = Solver(
    "xpbd",
    soft_step.apply_forces,
    solve,
    soft_step.update_positions,
    iterations=1,
    substeps=16,
    has_substeps=True,
    visits=2,
    speculative=True,
    lacks=LACKING,
)
