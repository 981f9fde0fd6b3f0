"""One step, stage by stage, in the talk's order. Each stage is Python that calls one kernel or a few.

Stage 1 of the talk, collision, is three here: pairs that are near, arbiters for them, and where they touch. What the
last three do is the solver's own: see engine/solvers/__init__.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.constants import BIAS_FACTOR, BOUNDS_MARGIN, SLOP
from engine.errors import StepError
from engine.narrow_phase.recycling import choose
from engine.settings import Settings
from engine.shapes.placing import write_placements
from engine.softness import stiffness
from engine.solvers import SOLVERS
from engine.state import State
from engine.tables import SOFTNESS_FIELDS


def broad_phase(state: State, settings: Settings) -> None:
    """Finds the pairs of shapes whose bounding boxes overlap."""
    order, shapes, hulls = state.shapes.order, state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    write_placements(order, shapes, bodies, motions, state.placements)
    margin = BOUNDS_MARGIN + 0.5 * float(state.steps["margin"][0])
    for write_bounds, ranks in state.bounds_plan:
        write_bounds(ranks, order, shapes, hulls, state.placements, margin, state.bounds)
    if state.broad_phase.update(state.bounds):
        state.pairs_are_stale = True


def update_arbiters(state: State, settings: Settings) -> None:
    """Lets arbiters come and go with the pairs."""
    if state.pairs_are_stale:
        state.follow(settings)


def narrow_phase(state: State, settings: Settings) -> None:
    """Finds where the shapes of each arbiter touch; those whose bodies hardly moved keep their contacts."""
    table, chosen = state.arbiters, state.chosen
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    shapes, hulls = state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    for collide, indices in zip(state.colliders, state.indices, strict=True):
        if len(indices):
            count = choose(
                indices, table.rows, table.contacts, state.ranks, state.bounds, shapes, bodies, motions, state.steps,
                chosen,
            )  # fmt: skip
            if count:
                collide(
                    chosen, count, table.rows, table.contacts, shapes, hulls, state.placements, bodies, motions,
                    state.steps,
                )  # fmt: skip


def apply_forces(state: State, settings: Settings) -> None:
    """Forces change velocities, or are gathered where the solver does it in substeps."""
    for gather in state.forces:
        gather(state, settings)
    lost = SOLVERS[settings.solver].apply_forces(state, settings)
    if lost >= 0:
        raise StepError(_describe_loss(state, lost, "apply forces"))


def solve_constraints(state: State, settings: Settings) -> None:
    """Contacts and joints change velocities."""
    SOLVERS[settings.solver].solve(state, settings)


def update_positions(state: State, settings: Settings) -> None:
    """Velocities change positions. StepError if a body's state is no longer finite."""
    lost = SOLVERS[settings.solver].update_positions(state, settings)
    if lost >= 0:
        motions = state.bodies.tables["motions"]
        unsolved = not np.isfinite([motions[name][lost] for name in ("vx", "vy", "w")]).all()
        raise StepError(_describe_loss(state, lost, "solve constraints" if unsolved else "update positions"))


STAGES: tuple[tuple[str, Callable[[State, Settings], None]], ...] = (
    ("broad phase", broad_phase),
    ("arbiters", update_arbiters),
    ("narrow phase", narrow_phase),
    ("apply forces", apply_forces),
    ("solve constraints", solve_constraints),
    ("update positions", update_positions),
)


def prepare_step(state: State, settings: Settings, dt: float) -> None:
    """Reads off settings and content what the stages need, unless nothing changed since the step before."""
    if state.prepared_for is not settings:
        state.stale = True
    carried = dt / state.last_dt if state.last_dt > 0.0 else 1.0  # a longer step gives greater impulses
    if state.prepared_for is not settings or (state.prepared_dt, state.prepared_carried) != (dt, carried):
        state.prepared_for, state.prepared_dt, state.prepared_carried = settings, dt, carried
        write_step(state.steps, settings, dt, carried)
    if state.stale:
        state.refresh(settings)


def write_step(step: np.ndarray, settings: Settings, dt: float, carried: float) -> None:
    """Writes what holds for the whole step where kernels read it. carried: dt over that of the step before."""
    solver = SOLVERS[settings.solver]
    n = settings.substeps
    values = {
        "dt": dt,
        "inverse_dt": 1.0 / dt,
        "gravity_x": settings.gravity[0],
        "gravity_y": settings.gravity[1],
        "bias_factor": BIAS_FACTOR if settings.position_correction else 0.0,
        "slop": SLOP,
        "iterations": settings.iterations,
        "accumulate_impulses": settings.accumulate_impulses,
        "warm_starting": settings.warm_starting,
        "position_correction": settings.position_correction,
        "margin": settings.speculative_distance if solver.speculative else 0.0,
        "recycling": settings.recycling_distance if solver.speculative and settings.recycling else 0.0,
        "substeps": n,
        "h": dt / n,
        "inverse_h": n / dt,
        "parts": n,
        "carried": carried / n,
        "push_out_speed": settings.push_out_speed,
        "restitution_threshold": settings.restitution_threshold,
    }
    soft = stiffness(settings, dt)
    values |= dict(zip(SOFTNESS_FIELDS, (*soft.contact, *soft.static, *soft.joint), strict=True))
    for name, value in values.items():
        step[name] = value


def _describe_loss(state: State, row: int, stage: str) -> str:
    """Names the body, its state, and the stage that broke it."""
    body, motion = state.bodies.tables["bodies"][row], state.bodies.tables["motions"][row]
    return (
        f"step {state.step_count + 1}, stage '{stage}': body {int(body['serial'])} is no longer finite: position "
        f"({float(body['x']):g}, {float(body['y']):g}), velocity ({float(motion['vx']):g}, {float(motion['vy']):g}), "
        f"angular velocity {float(motion['w']):g}"
    )
