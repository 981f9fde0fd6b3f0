"""The default solver: a step in substeps, contacts and joints as damped springs, each push taken back (relax).

A substep: velocities from forces, impulses of the substep before (warm start), a pass with bias, positions from
velocities, a pass without bias. Last of all, once a step, bouncing. Small steps beat many passes (M. Macklin et al.,
"Small Steps in Physics Simulation", 2019); the whole is E. Catto's Soft Step ("Solver2D", box2d.org, 2024).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine.mixing import RULES
from engine.solvers.soft_step import contacts, friction, movers, restitution, rolling, tables
from engine.solvers.soft_step.substeps import run_substeps
from engine.solvers.solver import Solver
from engine.tables import empty

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def table(state: State, name: str, dtype: np.dtype, count: int, effect: str = "") -> Any:
    """A table to work on, with room for `count`; None where its effect is not active."""
    if effect and effect not in state.effects:
        return None
    found = state.scratch.get(name)
    if found is None or len(found) < count or found.dtype != dtype:
        found = state.scratch[name] = empty(max(16, count + count // 2), dtype)
    return found


def apply_forces(state: State, settings: Settings) -> int:
    """Forces act in the substeps."""
    return -1


def solve(state: State, settings: Settings) -> None:
    """All substeps."""
    p = state.precision
    pairs, step = state.arbiters, state.steps
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    shapes = state.shapes.tables["shapes"]
    moved = table(state, "movers", tables.mover_dtype(p), len(bodies))
    constraints = table(state, "constraints", tables.constraint_dtype(p), pairs.count)
    movers.begin(state.bodies.order, motions, moved)
    count = contacts.prepare(pairs.count, pairs.rows, pairs.contacts, motions, constraints, step)

    frictions = table(state, "frictions", tables.friction_dtype(p), pairs.count, "friction")
    belts = table(state, "belts", tables.belt_dtype(p), pairs.count, "conveyor")
    rollings = table(state, "rollings", tables.rolling_dtype(p), pairs.count, "rolling resistance")
    bounces = table(state, "bounces", tables.restitution_dtype(p), pairs.count, "restitution")
    if frictions is not None:
        friction.prepare(constraints, count, pairs.rows, pairs.contacts, frictions, step)
    if belts is not None:
        friction.prepare_belts(constraints, count, pairs.rows, belts, state.shapes.columns["tangent_speed"])
    if rollings is not None:
        coefficients = state.shapes.columns["rolling_resistance"]
        rolling.prepare(constraints, count, pairs.rows, shapes, coefficients, rollings, step)
    if bounces is not None:
        coefficients, rule = state.shapes.columns["restitution"], RULES.index(settings.restitution_mixing)
        restitution.prepare(constraints, count, pairs.rows, coefficients, rule, moved, bounces)

    gravity = step if "gravity" in state.effects else None
    run_substeps(
        bodies, motions, moved, state.dynamic, state.moving, constraints, frictions, belts, rollings, count,
        state.active_joints, state.joints.order, gravity, state.gravity_scales, state.linear_damping,
        state.angular_damping, step,
    )  # fmt: skip
    if bounces is not None:
        restitution.apply(constraints, bounces, count, moved, step)
    contacts.store_impulses(constraints, count, pairs.contacts, pairs.rows, step)
    if frictions is not None:
        friction.store_impulses(constraints, frictions, count, pairs.contacts, pairs.rows, step)
    if rollings is not None:
        rolling.store_impulses(constraints, rollings, count, pairs.rows, step)


def update_positions(state: State, settings: Settings) -> int:
    """Bodies go where the substeps took them."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    return int(movers.finish(state.bodies.order, bodies, motions, state.scratch["movers"]))


SOFT_STEP = Solver(
    "soft_step",
    apply_forces,
    solve,
    update_positions,
    iterations=1,
    substeps=4,
    has_substeps=True,
    speculative=True,
)
