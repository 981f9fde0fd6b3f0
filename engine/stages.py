"""One step, stage by stage, in the talk's order. Each stage is Python that calls one kernel or a few.

Stage 1 of the talk, collision, is three here: pairs that are near, arbiters for them, and where they touch. What the
last three do is the solver's own: see engine/solvers/__init__.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.atomics import new_counters
from engine.awake import list_all
from engine.breaking import break_joints
from engine.constants import BIAS_FACTOR, BOUNDS_MARGIN, SLOP
from engine.continuous.ahead import drop_ahead
from engine.continuous.content import NAME as CONTINUOUS
from engine.continuous.content import ahead
from engine.errors import StepError
from engine.narrow_phase import TOGETHER
from engine.narrow_phase.recycling import choose_pairs, choose_together, write_boxes, write_some_boxes
from engine.program import PARTS_A_THREAD
from engine.settings import Settings
from engine.simd import WIDTH
from engine.sleeping import carry_impulses
from engine.softness import stiffness
from engine.solvers import SOLVERS
from engine.solvers.solver import rounded_step
from engine.state import NOTHING, State
from engine.tables import SOFTNESS_FIELDS
from engine.threads import share, shares, usable


def broad_phase(state: State, settings: Settings) -> None:
    """Finds the pairs of shapes whose bounding boxes overlap."""
    arguments = bounding(state)
    ranks = None if state.boxes_are_stale else state.watched_ranks
    for write_bounds, group in state.full_plan if ranks is None else state.awake_plan:
        write_bounds(group, *arguments)
    if ranks is None:
        write_boxes(*boxing(state, NOTHING))
    else:
        write_some_boxes(*boxing(state, ranks))
    state.boxes_are_stale = False
    if state.broad_phase.update(state.bounds, ranks):
        state.pairs_are_stale = True


def boxing(state: State, ranks: np.ndarray) -> tuple:
    """What kernels take that write the boxes of all shapes, or of those of some ranks."""
    return state.bounds, state.shapes.order, state.boxes, ranks


def bounding(state: State) -> tuple:
    """What kernels that write bounding boxes take after the group of shapes."""
    shapes, hulls = state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    return shapes, hulls, bodies, motions, state.placements, state.bounds_margin, state.bounds


def update_arbiters(state: State, settings: Settings) -> None:
    """Lets arbiters come and go with the pairs."""
    if state.pairs_are_stale:
        state.follow(settings)


def narrow_phase(state: State, settings: Settings) -> None:
    """Finds where the shapes of each arbiter touch; those whose bodies hardly moved keep their contacts."""
    chosen, arguments = state.chosen, colliding(state)
    for collide, indices, number in state.meetings:
        count = _choose(state, indices, number)
        chosen[count : count + WIDTH] = state.arbiters.nothing
        threads = usable(state.threads, count) if collide in TOGETHER else 1
        if threads > 1:
            firsts = shares(count, PARTS_A_THREAD * threads, WIDTH)
            share(threads, TOGETHER[collide], new_counters(2), firsts, chosen, *arguments)
        elif count:
            collide(chosen, 0, count, *arguments)
    if CONTINUOUS in state.effects:
        drop_ahead(*ahead(state))


def colliding(state: State) -> tuple:
    """What colliders take after the arbiters to look at."""
    table, bodies = state.arbiters, state.bodies.tables
    shapes, hulls = state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    return (
        table.rows, table.contacts, shapes, hulls, state.placements, bodies["bodies"], bodies["motions"], state.steps,
    )  # fmt: skip


def choosing(state: State, indices: np.ndarray, chosen: np.ndarray) -> tuple:
    """What `choose_pairs` takes after the first and the last of the indices to look at."""
    table, bodies = state.arbiters, state.bodies.tables
    return (
        indices, table.rows, table.contacts, state.boxes, bodies["bodies"], bodies["motions"], state.steps, chosen,
    )  # fmt: skip


def _choose(state: State, indices: np.ndarray, number: int) -> int:
    """Puts those of the arbiters at `indices` that need their contacts found anew into `chosen`: how many there are."""
    chosen = state.chosen
    arguments = choosing(state, indices, chosen)
    threads = usable(state.threads, number)
    if threads == 1:
        return int(choose_pairs(0, number, *arguments))
    parts = PARTS_A_THREAD * threads
    firsts, counts = shares(number, parts, WIDTH), np.empty(parts, np.int64)
    share(threads, choose_together, new_counters(2), firsts, counts, *arguments)
    total = 0
    for first, count in zip(firsts, counts, strict=False):
        chosen[total : total + count] = chosen[first : first + count].copy()
        total += int(count)
    return total


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
        raise lost_in_solver(state, lost)
    if "breaking joints" in state.effects:
        break_joints(state, settings)


def lost_in_solver(state: State, lost: int) -> StepError:
    """The error to raise for a body, by row, that is no longer finite after its position was updated."""
    motions = state.bodies.tables["motions"]
    unsolved = not np.isfinite([motions[name][lost] for name in ("vx", "vy", "w")]).all()
    return StepError(_describe_loss(state, lost, "solve constraints" if unsolved else "update positions"))


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
        if state.prepared_dt > 0.0 and state.active_joints is not None:
            state.lists_are_stale |= rounded_step(dt) != rounded_step(state.prepared_dt)  # chains are chosen for it
        state.prepared_for, state.prepared_dt, state.prepared_carried = settings, dt, carried
        write_step(state.steps, settings, dt, carried)
        state.bounds_margin = BOUNDS_MARGIN + 0.5 * float(state.steps["margin"][0])
        if carried != 1.0:
            carry_impulses(state, carried)
    if state.stale:
        state.refresh(settings)
    elif state.lists_are_stale:
        list_all(state)


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
        "maximum_speed": settings.maximum_speed,
        "sleep_speed": settings.sleep_speed,
        "sleep_time": settings.sleep_time,
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
