"""What the stages of the program do, alone or with other threads."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.program import done, part_of, take, wait
from engine.solvers.soft_step import contacts, friction, movers, passes, restitution, rolling
from engine.solvers.soft_step.direct.work import solve_islands
from engine.solvers.soft_step.joints import work as joints
from engine.solvers.soft_step.schedule import (
    BEGIN,
    BIASED,
    BOUNCE,
    CHAINS,
    DRIVE,
    FORGET,
    JOINTS,
    LINES,
    POINTS,
    POSITIONS,
    PREPARE,
    RELAX,
    RELAX_LAST,
    SLIDES,
    STORE,
    TURNS,
    VELOCITIES,
    VERBS,
    WARM,
)  # fmt: skip
from engine.threads import close, enter, leave

# _nrt=False: numba counts no references to the forty tables, in each stage anew, which took longer than most stages.
# Whoever calls holds them all. Nothing may be allocated here.


@kernel(_nrt=False)
def do_part(
    kind, first, last, bodies, motions, moved, order, dynamic, moving, drives, arbiters, touching, shapes, slots, rows,
    frictions, belts, rollings, bounces, tangent_speed, rolling_resistance, restitutions, rule, joint_table, turns,
    slides, turn_slots, turn_rows, turn_springs, turn_motors, turn_limits, slide_slots, slide_rows, slide_springs,
    slide_motors, slide_limits, line_slots, line_rows, point_slots, point_rows, softs, chains, gravity, scales,
    linear, angular, steps,
):  # fmt: skip
    """One part of one stage: blocks from `first` to before `last`. Tables are None where nothing calls for them."""
    step = steps[0]
    nought = const(0.0, step.h)
    one = const(1.0, step.h)
    if kind == BIASED:
        passes.solve_biased(first, last, rows, moved, step)
    elif kind == RELAX or kind == RELAX_LAST:
        passes.relax(first, last, rows, frictions, belts, rollings, moved, one if kind == RELAX_LAST else nought, step)
    elif kind == WARM:
        passes.warm_start(first, last, rows, frictions, rollings, moved)
    elif kind == VELOCITIES:
        movers.integrate_velocities(first, last, dynamic, drives, moved, linear, angular, step)
    elif kind == POSITIONS:
        movers.integrate_positions(first, last, moving, moved, step.h)
    elif kind == BEGIN:
        movers.begin(first, last, order, motions, moved)
    elif kind == DRIVE:
        movers.drive(first, last, dynamic, bodies, motions, gravity, scales, drives, step)
    elif kind == PREPARE:
        contacts.prepare(first, last, slots, arbiters, touching, motions, rows, step)
        if frictions is not None:
            friction.prepare(first, last, slots, rows, arbiters, touching, frictions, step)
        if belts is not None:
            friction.prepare_belts(first, last, slots, rows, arbiters, belts, tangent_speed)
        if rollings is not None:
            rolling.prepare(first, last, slots, rows, arbiters, shapes, rolling_resistance, rollings, step)
        if bounces is not None:
            restitution.prepare(first, last, slots, rows, arbiters, restitutions, rule, motions, bounces)
    elif kind == STORE:
        contacts.store_impulses(first, last, slots, rows, frictions, rollings, arbiters, touching, step)
    elif kind == FORGET:
        passes.forget(first, last, rows, frictions, rollings)
    if bounces is not None:
        if kind == BOUNCE:
            restitution.apply(first, last, rows, bounces, moved, step)
    if joint_table is not None:
        rows, verb = (kind - JOINTS) // VERBS, (kind - JOINTS) % VERBS
        if turn_rows is not None:
            if rows == TURNS:
                joints.turn(
                    verb, first, last, turn_slots, turn_rows, turn_springs, turn_motors, turn_limits, joint_table,
                    turns, bodies, motions, moved, step,
                )  # fmt: skip
        if slide_rows is not None:
            if rows == SLIDES:
                joints.slide(
                    verb, first, last, slide_slots, slide_rows, slide_springs, slide_motors, slide_limits, joint_table,
                    slides, bodies, motions, moved, step,
                )  # fmt: skip
        if line_rows is not None:
            if rows == LINES:
                joints.line(verb, first, last, line_slots, line_rows, joint_table, bodies, motions, moved, step)
        if point_rows is not None:
            if rows == POINTS:
                joints.point(
                    verb, first, last, point_slots, point_rows, softs, joint_table, bodies, motions, moved, step
                )  # fmt: skip
        if chains is not None:
            if rows == CHAINS:
                solve_islands(verb, first, last, chains, joint_table, turns, slides, bodies, motions, moved, step)


@kernel(_nrt=False)
def run(leads, threads, board, program, stages, counters, *tables):
    """All stages, one after the other; one thread of several takes parts of each as long as there are any."""
    if not leads and not enter(board):
        return
    for k in range(stages):
        stage = program[k]
        number = take(counters, k) if threads > 1 else 0
        while number < stage.parts:
            part = part_of(stage, number)
            do_part(stage.kind, part.first, part.last, *tables)
            if threads == 1:
                break
            done(counters, k)
            number = take(counters, k)
        if threads > 1:
            wait(counters, k, stage)
    if leads and threads > 1:
        close(board)
    elif not leads:
        leave(board)
