"""ngs: sequential impulses without a bias, and then a pass over the positions that is Gauss-Seidel and not linear.

Velocities are solved as in the talk, accumulated and warm started, and gain nothing from overlap: only what is still
apart may approach so fast that it just meets. Bodies then move; and afterwards passes over the positions push out what
overlaps by more than the slop and close joints, one constraint after another, each seeing where the bodies now are.
Sources: E. Guendelman, R. Bridson and R. Fedkiw, "Nonconvex Rigid Bodies with Stacking" (SIGGRAPH 2003) for correcting
positions apart from velocities; E. Catto, "Modeling and Solving Constraints" (GDC 2009) and Box2D 2.x for the passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.lanes import const
from engine.mixing import RULES
from engine.solvers import joint_rows
from engine.solvers import sequential_impulses as talk
from engine.solvers.moving import advance, begin, take_speeds, update_positions
from engine.solvers.ngs import contacts as touching
from engine.solvers.ngs import joints as joined
from engine.solvers.sequential_impulses import solve_contacts
from engine.solvers.soft_step import table
from engine.solvers.soft_step.tables import mover_dtype
from engine.solvers.solver import Solver
from engine.tables import empty

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

PART = 0.2
"""Part of the overlap beyond the slop that a pass pushes out, usual 0.1 to 0.3. Near 1: contacts of one body that
correct the same overlap overshoot together; smaller: what was made overlapping stays so for long."""

MOST = 0.2
"""Furthest that a pass moves a constraint [m], [rad]. Larger: what is far wrong is thrown about; smaller: a joint that
was torn apart closes slowly."""

VELOCITY_PASSES, POSITION_PASSES = 10, 4
"""As many passes over positions for so many over velocities, at least one. More: joints and heaps are a little tighter,
at the price of a velocity pass each; fewer: what overlaps takes longer to part."""


@kernel
def solve_velocities(
    bodies, motions, arbiters, contacts, count, points, joints, turns, slides, rows, frames, movers, step
):
    """Prepares all constraints, and passes over them `iterations` times: joints first, so that contacts have the last
    word. rows: None where no joint does anything.
    """
    touching.prepare(arbiters, contacts, count, motions, points, step)
    if rows is not None:
        joint_rows.prepare(rows, frames, joints, turns, slides, bodies, motions, movers, step)
        joined.warm_start(rows, frames, motions)
    for _ in range(step.iterations):
        if rows is not None:
            joined.solve(rows, frames, motions, step)
        solve_contacts(arbiters, contacts, points, count, motions, True)
    touching.store(arbiters, contacts, count)
    if rows is not None:
        joined.note_given(rows)
        joint_rows.store(rows, frames, joints, turns, slides, step.parts)


@kernel
def solve_positions(motions, arbiters, contacts, count, rows, frames, movers, step):
    """Passes over the positions, where the movers have taken the bodies."""
    part, most = const(PART, step.dt), const(MOST, step.dt)
    for _ in range((step.iterations * POSITION_PASSES + VELOCITY_PASSES - 1) // VELOCITY_PASSES):
        touching.correct(arbiters, contacts, count, motions, movers, step.slop, part, most)
        if rows is not None:
            joined.correct(rows, frames, movers, most)


@kernel
def solve_all(
    bodies, motions, movers, order, moved, arbiters, contacts, count, points, bounces, joints, turns, slides, rows,
    frames, steps,
):  # fmt: skip
    """Velocities, then positions, then what bounces. order: rows of all bodies, moved: of those that move.

    Tables are None where nothing calls for them.
    """
    step = steps[0]
    begin(order, motions, movers)
    solve_velocities(
        bodies, motions, arbiters, contacts, count, points, joints, turns, slides, rows, frames, movers, step
    )
    begin(order, motions, movers)
    advance(moved, movers, step.dt)
    if step.position_correction != 0:
        solve_positions(motions, arbiters, contacts, count, rows, frames, movers, step)
    if bounces is not None:
        touching.bounce_back(arbiters, contacts, points, bounces, count, motions, step.restitution_threshold)
        take_speeds(moved, motions, movers)


def a_pair(state: State, name: str, dtype: np.dtype) -> np.ndarray:
    """A table with room for the two contacts of every arbiter."""
    found, count = state.scratch.get(name), state.arbiters.count
    if found is None or len(found) < count:
        found = state.scratch[name] = empty((2 * count, 2), dtype)
    table: np.ndarray = found
    return table


def bouncing(state: State) -> np.ndarray | None:
    """What bouncing needs to know, where anything may."""
    called_for = "restitution" in state.effects
    return a_pair(state, "ngs, bounces", touching.bounce_dtype(state.precision)) if called_for else None


def note_approach(state: State, settings: Settings) -> None:
    """Notes speeds of approach before anything acts, where anything bounces."""
    motions, pairs, bounces = state.bodies.tables["motions"], state.arbiters, bouncing(state)
    if bounces is not None:
        touching.note_speeds(
            pairs.rows, pairs.contacts, pairs.count, motions,
            state.column("restitution", state.shapes, "restitution"), RULES.index(settings.restitution_mixing), bounces,
        )  # fmt: skip


def apply_forces(state: State, settings: Settings) -> int:
    """Stage 2 of the talk."""
    note_approach(state, settings)
    return talk.apply_forces(state, settings)


def solve(state: State, settings: Settings) -> None:
    """Stage 3 of the talk, and where bodies go."""
    tables, pairs = state.bodies.tables, state.arbiters
    found = joint_rows.rows_of(state)
    joints: tuple = (None,) * 5
    if found is not None:
        joints = (*(state.joints.tables[name] for name in ("joints", "turns", "slides")), *found)
    movers = table(state, "movers", mover_dtype(state.precision), len(tables["bodies"]), exactly=True)
    points = a_pair(state, "ngs, points", talk.point_dtype(state.precision))
    arguments = (
        tables["bodies"], tables["motions"], movers, state.awake_order, state.moving, pairs.rows, pairs.contacts,
        pairs.count, points, bouncing(state), *joints, state.steps,
    )  # fmt: skip
    solve_all(*arguments)


NGS = Solver(
    "ngs",
    apply_forces,
    solve,
    update_positions,
    iterations=VELOCITY_PASSES,
    visits=(VELOCITY_PASSES + POSITION_PASSES) / VELOCITY_PASSES,
    speculative=True,
    lacks=("rolling resistance", "conveyor", "continuous collision", "bullets", *joint_rows.LACKING),
)
