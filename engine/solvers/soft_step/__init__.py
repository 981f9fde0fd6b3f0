"""The default solver: a step in substeps, contacts and joints as damped springs, each push taken back (relax).

A substep: velocities from forces, impulses of the substep before (warm start), a pass with bias, positions from
velocities, a pass without bias. Last of all, once a step, bouncing. Small steps beat many passes (M. Macklin et al.,
"Small Steps in Physics Simulation", 2019); the whole is E. Catto's Soft Step ("Solver2D", box2d.org, 2024).
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from engine.atomics import new_counters
from engine.continuous.content import content_of, stop_fast
from engine.mixing import RULES
from engine.program import COUNTERS, PARTS_A_THREAD, STAGE, clear_counters
from engine.rows import wide
from engine.simd import WIDTH
from engine.solvers.soft_step import movers, tables
from engine.solvers.soft_step.direct.chains import find_chains
from engine.solvers.soft_step.joints.free import limit_dtype, motor_dtype, spring_dtype
from engine.solvers.soft_step.joints.line import line_dtype
from engine.solvers.soft_step.joints.point import point_dtype
from engine.solvers.soft_step.joints.point_softness import soft_dtype
from engine.solvers.soft_step.joints.slide import slide_dtype
from engine.solvers.soft_step.joints.turn import turn_dtype
from engine.solvers.soft_step.schedule import most_stages, write_program
from engine.solvers.soft_step.speeds import find_fast
from engine.solvers.soft_step.work import run
from engine.solvers.solver import Solver
from engine.tables import empty
from engine.threads import share, shares, usable

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

wide_dtype = cache(wide)
FREE = {"joint springs": spring_dtype, "joint motors": motor_dtype, "joint limits": limit_dtype}


def table(state: State, name: str, dtype: np.dtype, count: int, effect: str = "", exactly: bool = False) -> Any:
    """A table to work on, with room for `count`, or for exactly so many; None where its effect is not active."""
    if effect and effect not in state.effects:
        return None
    found = state.scratch.get(name)
    if found is None or len(found) < count or found.dtype != dtype or (exactly and len(found) != count):
        found = state.scratch[name] = empty(count if exactly else max(16, count + count // 2), dtype)
    return found


def rows(state: State, name: str, dtype: np.dtype, blocks: int, effect: str = "") -> Any:
    """A table of constraints, as many side by side as the state solves at once."""
    return table(state, name, wide_dtype(dtype, state.lanes), blocks, effect)


def apply_forces(state: State, settings: Settings) -> int:
    """Forces act in the substeps."""
    return -1


class Plan(NamedTuple):
    """What a solve needs, until content, settings or what touches change."""

    asked: int  # threads that a step may use
    threads: int  # that pay
    stages: int  # of the program
    arguments: tuple  # of `run` in one thread


def plan_of(state: State, settings: Settings) -> Plan:
    """The plan, made anew where it no longer holds. Colours must be up to date."""
    plan = state.solve_plan
    if plan is None or plan.asked != state.threads:
        plan = state.solve_plan = make_plan(state, settings)
    return plan


def make_plan(state: State, settings: Settings) -> Plan:
    """Looks up all tables, and writes the program."""
    p = state.precision
    pairs, layout, joint_layout, steps = state.arbiters, state.layout, state.joint_layout, state.steps
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    threads = usable(state.threads, len(state.awake_order))
    blocks = layout.blocks
    bounces = rows(state, "bounces", tables.restitution_dtype(p), blocks, "restitution")
    colours = int((np.diff(layout.firsts) > 0).sum()) + joint_layout.stages
    program = table(state, "program", STAGE, most_stages(settings.substeps, settings.iterations, colours))
    stages = write_program(
        program, len(state.body_lanes) // WIDTH, len(state.dynamic_lanes) // WIDTH, len(state.moving_lanes) // WIDTH,
        layout.firsts, joint_layout.firsts, state.chains.count if state.chains else 0, bounces is not None, threads,
        steps,
    )  # fmt: skip
    counters = state.scratch.get("counters")
    if counters is None or len(counters) < COUNTERS * len(program):
        counters = state.scratch["counters"] = new_counters(COUNTERS * len(program))
    arguments = (
        True, 1, counters, program, stages, counters,
        bodies, motions, table(state, "movers", tables.mover_dtype(p), len(bodies), exactly=True),
        state.body_lanes, state.dynamic_lanes, state.moving_lanes,
        table(state, "drives", wide_dtype(tables.drive_dtype(p), WIDTH), len(state.dynamic_lanes) // WIDTH),
        pairs.rows, pairs.contacts, state.shapes.tables["shapes"], layout.slots,
        rows(state, "constraints", tables.constraint_dtype(p), blocks),
        rows(state, "frictions", tables.friction_dtype(p), blocks, "friction"),
        rows(state, "belts", tables.belt_dtype(p), blocks, "conveyor"),
        rows(state, "rollings", tables.rolling_dtype(p), blocks, "rolling resistance"),
        bounces,
        state.column("conveyor", state.shapes, "tangent_speed"),
        state.column("rolling resistance", state.shapes, "rolling_resistance"),
        state.column("restitution", state.shapes, "restitution"),
        RULES.index(settings.restitution_mixing),
        *joint_arguments(state),
        steps if "gravity" in state.effects else None, state.gravity_scales, state.linear_damping,
        state.angular_damping, steps,
    )  # fmt: skip
    return Plan(state.threads, threads, stages, arguments)


def joint_arguments(state: State) -> tuple:
    """The tables of joints that a pass takes: None where none calls for them."""
    layout, slots, p = state.joint_layout, state.joint_layout.slots, state.precision
    if state.active_joints is None:
        return (None,) * (3 + 5 + 5 + 2 + 3 + 1)

    def rows_of(name: str, dtype: np.dtype) -> Any:
        return rows(state, f"joints, {name}", dtype, layout.blocks(name)) if name in layout.called_for else None

    def free_of(name: str) -> tuple:
        blocks = layout.blocks(name)
        there = name in layout.called_for
        return tuple(
            rows(state, f"joints, {name}, {effect}", dtype(p), blocks, effect) if there else None
            for effect, dtype in FREE.items()
        )

    softs = rows(state, "softs", soft_dtype(p), layout.blocks("points")) if layout.soft else None
    return (
        state.active_joints, state.joints.tables["turns"], state.joints.tables["slides"],
        slots["turns"], rows_of("turns", turn_dtype(p)), *free_of("turns"),
        slots["slides"], rows_of("slides", slide_dtype(p)), *free_of("slides"),
        slots["lines"], rows_of("lines", line_dtype(p)),
        slots["points"], rows_of("points", point_dtype(p)), softs,
        state.chains.tables() if state.chains else None,
    )  # fmt: skip


def solve(state: State, settings: Settings) -> None:
    """All substeps."""
    state.follow_contacts()
    plan = plan_of(state, settings)
    if plan.threads == 1:
        run(*plan.arguments)
    else:
        _, _, counters, *program = plan.arguments
        clear_counters(counters, plan.stages)
        share(plan.threads, run, plan.threads, new_counters(3), *program)


def hurrying(state: State) -> tuple:
    """What `find_fast` takes."""
    content = content_of(state)
    slowest, fast = (None, None) if content is None else (content.slowest, content.fast)
    return state.dynamic_lanes, state.scratch["movers"], slowest, fast, state.steps


def update_positions(state: State, settings: Settings) -> int:
    """Bodies go where the substeps took them, or until they would go through something."""
    count = find_fast(*hurrying(state))
    content = content_of(state)
    if content is not None and count:
        stop_fast(state, content, count)
    bodies, motions, order = state.bodies.tables["bodies"], state.bodies.tables["motions"], state.awake_order
    moved = state.scratch["movers"]
    threads = usable(state.threads, len(order))
    if threads == 1:
        ready = movers.finish(0, len(order), order, bodies, motions, moved, state.timed)
    else:
        parts = PARTS_A_THREAD * threads
        found = np.empty(parts, np.int64)
        firsts = shares(len(order), parts)
        share(
            threads, movers.finish_together, new_counters(2), firsts, found, order, bodies, motions, moved,
            state.timed,
        )  # fmt: skip
        ready = found.sum() if found.min() >= 0 else found[found < 0].max()  # of the lost the first
    if ready < 0:
        return int(order[-1 - ready])
    state.ready[0] = ready
    return -1


SOFT_STEP = Solver(
    "soft_step",
    apply_forces,
    solve,
    update_positions,
    iterations=1,
    substeps=4,
    has_substeps=True,
    visits=2,  # with its bias, and again without
    speculative=True,
    find_chains=find_chains,
)
