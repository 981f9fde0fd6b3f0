"""One step, stage by stage, in the talk's order. Each stage is Python that calls one kernel or a few.

Stage 1 of the talk, collision, is three here: pairs that may touch, where they touch, and what they carry over.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.arbiters import begin_arbiters, match_arbiters
from engine.broad_phase import BROAD_PHASES
from engine.constants import BIAS_FACTOR, SLOP
from engine.errors import StepError
from engine.ignored import drop_ignored
from engine.integrate import apply_forces, update_positions
from engine.settings import Settings
from engine.solvers import SOLVERS
from engine.state import State


def broad_phase(state: State, settings: Settings) -> None:
    """Finds the pairs of bodies whose bounding boxes overlap."""
    bodies, motions, order = _bodies(state)
    for write_bounds in state.bounds_kernels:
        write_bounds(order, bodies, motions, state.bounds)
    find_pairs = BROAD_PHASES[settings.broad_phase]
    count = find_pairs(state.bounds, state.fixed, state.flags, state.pairs)
    if count > len(state.pairs):
        state.reserve_pairs(count)
        count = find_pairs(state.bounds, state.fixed, state.flags, state.pairs)
    if state.ignored is not None:
        count = drop_ignored(state.pairs, count, order, bodies, state.ignored)
    state.pair_count = count


def narrow_phase(state: State, settings: Settings) -> None:
    """Finds where the shapes of each pair touch."""
    bodies, motions, order = _bodies(state)
    state.reserve_found()
    found = state.found
    begin_arbiters(state.pairs, state.pair_count, order, bodies, found.rows)
    for collide in state.colliders:
        collide(state.pair_count, bodies, motions, found.rows, found.contacts)


def update_arbiters(state: State, settings: Settings) -> None:
    """Lets contacts that were there in the step before keep their impulses."""
    old, new = state.arbiters, state.found
    new.count = match_arbiters(old.rows, old.contacts, old.count, new.rows, new.contacts, state.pair_count, state.steps)
    state.arbiters, state.found = new, old


def forces(state: State, settings: Settings) -> None:
    """Gravity and applied forces change velocities. StepError if a body's is no longer finite."""
    bodies, motions, order = _bodies(state)
    lost = apply_forces(order, bodies, motions, state.steps)
    if lost >= 0:
        raise StepError(_describe_loss(state, int(order[lost]), "apply forces"))


def solve_constraints(state: State, settings: Settings) -> None:
    """Contacts and joints change velocities."""
    bodies, motions, _ = _bodies(state)
    table = state.arbiters
    solve = SOLVERS[settings.solver]
    solve(
        bodies, motions, table.rows, table.contacts, table.count, state.active_joints, state.joints.order, state.steps
    )


def positions(state: State, settings: Settings) -> None:
    """Velocities change positions. StepError if a body's state is no longer finite."""
    bodies, motions, order = _bodies(state)
    lost = update_positions(order, bodies, motions, state.steps)
    if lost >= 0:
        row = int(order[lost])
        unsolved = not np.isfinite([motions[name][row] for name in ("vx", "vy", "w")]).all()
        raise StepError(_describe_loss(state, row, "solve constraints" if unsolved else "update positions"))


STAGES: tuple[tuple[str, Callable[[State, Settings], None]], ...] = (
    ("broad phase", broad_phase),
    ("narrow phase", narrow_phase),
    ("arbiters", update_arbiters),
    ("apply forces", forces),
    ("solve constraints", solve_constraints),
    ("update positions", positions),
)


def prepare_step(state: State, settings: Settings, dt: float) -> None:
    """Writes what holds for the whole step where kernels read it, unless it stands there from the step before."""
    if state.prepared_for is settings and state.prepared_dt == dt:
        return
    state.prepared_for, state.prepared_dt = settings, dt
    step = state.steps
    step["dt"] = dt
    step["inverse_dt"] = 1.0 / dt
    step["gravity_x"], step["gravity_y"] = settings.gravity
    step["bias_factor"] = BIAS_FACTOR if settings.position_correction else 0.0
    step["slop"] = SLOP
    step["iterations"] = settings.iterations
    step["accumulate_impulses"] = settings.accumulate_impulses
    step["warm_starting"] = settings.warm_starting
    step["position_correction"] = settings.position_correction


def _bodies(state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    tables = state.bodies.tables
    return tables["bodies"], tables["motions"], state.bodies.order


def _describe_loss(state: State, row: int, stage: str) -> str:
    """Names the body, its state, and the stage that broke it."""
    bodies, motions, _ = _bodies(state)
    body, motion = bodies[row], motions[row]
    return (
        f"step {state.step_count + 1}, stage '{stage}': body {int(body['serial'])} is no longer finite: position "
        f"({float(body['x']):g}, {float(body['y']):g}), velocity ({float(motion['vx']):g}, {float(motion['vy']):g}), "
        f"angular velocity {float(motion['w']):g}"
    )
