"""Augmented vertex block descent: each body in turn is moved to where the forces on it balance.

A step is one implicit Euler step (no substeps), solved as a minimum: of the bodies' inertia, which draws each to where
it would go unheld, and of penalties k C^2 / 2 with multipliers lambda, which hold it. In every iteration each body is
moved by a 3x3 system of its own, the others standing still; then multipliers take up what is left of the errors, and
penalties grow with it. Multipliers last from step to step.
Source: C. Giles, E. Diaz, C. Yuksel, "Augmented Vertex Block Descent", ACM Transactions on Graphics 44 (SIGGRAPH 2025),
whose equations are named beside the code.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.lanes import const, over
from engine.simd import WIDTH
from engine.solvers import soft_step
from engine.solvers.avbd.passes import move_body, push_of, show, take_up
from engine.solvers.avbd.rows import add_contacts, add_joints, list_rows
from engine.solvers.avbd.tables import BODY, ROW
from engine.solvers.joint_rows import LACKING, awake_rows, prepare, store
from engine.solvers.soft_step import movers
from engine.solvers.soft_step.tables import drive_dtype, mover_dtype
from engine.solvers.solver import Solver, solve_planned

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def begin(order, motions, moved, bodies, step):
    """Where bodies would go, as their movers say, and where they are looked for first: where they were already going.

    Without the step's own forces, because what rests stays; from where nothing is held, contacts would have all the
    weight to find anew.
    """
    dt = np.float64(step.dt)
    for k in range(len(order)):
        row = order[k]
        body, motion, mover = bodies[row], motions[row], moved[row]
        body.mass = over(1.0, np.float64(motion.inverse_mass))
        body.inertia = over(1.0, np.float64(motion.inverse_inertia))
        body.target_x, body.target_y = dt * np.float64(mover.vx), dt * np.float64(mover.vy)
        body.target_turn = dt * np.float64(mover.w)
        body.x, body.y = dt * np.float64(motion.vx), dt * np.float64(motion.vy)
        body.turn = dt * np.float64(motion.w)
        show(body, mover)


@kernel
def finish(order, moved, bodies, step):
    """Velocities from positions, (x - x_before) / dt; of what nothing held to the last bit what it would have been."""
    inverse_dt = np.float64(step.inverse_dt)
    for k in range(len(order)):
        row = order[k]
        body, mover = bodies[row], moved[row]
        lane = mover.vx
        mover.vx = const(np.float64(mover.vx) + inverse_dt * (body.x - body.target_x), lane)
        mover.vy = const(np.float64(mover.vy) + inverse_dt * (body.y - body.target_y), lane)
        mover.w = const(np.float64(mover.w) + inverse_dt * (body.turn - body.target_turn), lane)
        show(body, mover)


@kernel
def keep(rows, count, contacts, joint_rows, step):
    """Multipliers, as impulses, for the next step and for whoever asks."""
    inverse_dt = np.float64(step.inverse_dt)
    for k in range(count):
        row = rows[k]
        push, _ = push_of(row, rows)
        impulse = inverse_dt * (push if row.most_penalty < np.inf else row.multiplier)
        if row.point < 0:
            if joint_rows is not None:
                found = joint_rows[row.source]
                found.impulse = found.given = const(impulse, found.error)
        else:
            contact = contacts[row.source, row.point]
            impulse = const(impulse, contact.separation)
            if row.normal < 0:
                contact.normal_impulse = contact.given_normal = impulse
            else:
                contact.tangent_impulse = contact.given_tangent = impulse


@kernel
def solve_all(
    order, dynamic, dynamic_lanes, bodies, motions, moved, drives, slots, arbiters, touching, shapes, own, rows,
    incident, frictional, tangent_speed, joint_rows, frames, joint_table, turns, slides, gravity, scales, linear,
    angular, steps,
):  # fmt: skip
    """The whole step. Tables are None where nothing calls for them."""
    step = steps[0]
    falling = len(dynamic_lanes) // WIDTH
    movers.begin(0, len(order) // WIDTH, order, motions, moved)
    movers.drive(0, falling, dynamic_lanes, bodies, motions, gravity, scales, drives, step)
    if joint_rows is not None:
        prepare(joint_rows, frames, joint_table, turns, slides, bodies, motions, moved, step)
    movers.integrate_velocities(0, falling, dynamic_lanes, drives, moved, linear, angular, step)
    begin(order, motions, moved, own, step)
    count = add_contacts(slots, arbiters, touching, shapes, own, rows, frictional, tangent_speed, step)
    if joint_rows is not None:
        count = add_joints(joint_rows, frames, own, rows, count, step)
    list_rows(rows, count, own, dynamic, incident)
    for _ in range(step.iterations):
        for k in range(len(dynamic)):
            move_body(dynamic[k], own, rows, incident, joint_rows, frames, moved)
        take_up(rows, count, own, joint_rows, frames, moved)
    finish(order, moved, own, step)
    keep(rows, count, touching, joint_rows, step)
    if joint_rows is not None:
        store(joint_rows, frames, joint_table, turns, slides, step.parts)


def solve(state: State, settings: Settings) -> None:
    """The whole step."""
    solve_planned(state, settings, solve_all, arguments)


def arguments(state: State, settings: Settings) -> tuple:
    """All tables: they hold until content, settings or what touches change."""
    table, p, joints = state.arbiters, state.precision, state.joints.tables
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    found = awake_rows(state)
    most = 4 * len(state.layout.slots) + (len(found.rows) if found else 0)
    steps, effects = state.steps, state.effects
    return (
        state.body_lanes, state.dynamic, state.dynamic_lanes, bodies, motions,
        soft_step.table(state, "movers", mover_dtype(p), len(bodies), exactly=True),
        soft_step.table(
            state, "drives", soft_step.wide_dtype(drive_dtype(p), WIDTH), len(state.dynamic_lanes) // WIDTH
        ),
        state.layout.slots, table.rows, table.contacts, state.shapes.tables["shapes"],
        soft_step.table(state, "avbd bodies", BODY, len(bodies)), soft_step.table(state, "avbd rows", ROW, most),
        np.empty(2 * most, np.int64),
        steps if "friction" in effects else None,
        state.column("conveyor", state.shapes, "tangent_speed"),
        *((None,) * 5 if found is None else (*found, joints["joints"], joints["turns"], joints["slides"])),
        steps if "gravity" in effects else None, state.gravity_scales, state.linear_damping,
        state.angular_damping, steps,
    )  # fmt: skip


AVBD = Solver(
    "avbd",
    soft_step.apply_forces,
    solve,
    soft_step.update_positions,
    iterations=10,
    speculative=True,
    lacks=("restitution", "rolling resistance", "joint motors", *LACKING),
)
