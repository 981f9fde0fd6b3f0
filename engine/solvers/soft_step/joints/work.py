"""What each verb does to each kind of rows: what a stage of the program comes down to."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.solvers.soft_step.joints import along as directions
from engine.solvers.soft_step.joints import free, point_softness
from engine.solvers.soft_step.joints import line as lines
from engine.solvers.soft_step.joints import point as points
from engine.solvers.soft_step.joints import slide as slidings
from engine.solvers.soft_step.joints import turn as turnings
from engine.solvers.soft_step.schedule import (
    BIASED_ROWS,
    FORGET_ROWS,
    PREPARE_ROWS,
    REFRESH_ROWS,
    RELAX_ROWS,
    RELAX_ROWS_LAST,
    STORE_ROWS,
    WARM_ROWS,
)  # fmt: skip

# Tables of springs, motors, limits and softness are None where no joint calls for them.


@kernel
def kept_of(verb, step):
    """1 in the last pass of a substep, whose impulses are what the substep gave; 0 in others."""
    return const(1.0, step.h) if verb == RELAX_ROWS_LAST else const(0.0, step.h)


@kernel
def solves(verb):
    """Whether it is a pass over the rows."""
    return verb in (BIASED_ROWS, RELAX_ROWS, RELAX_ROWS_LAST)


@kernel
def prepare_free(first, last, slots, springs, motors, limits, free_parts, step):
    """Springs, motors and limits as the step begins."""
    if springs is not None:
        free.prepare_springs(first, last, slots, free_parts, springs, step)
    if motors is not None:
        free.prepare_motors(first, last, slots, free_parts, motors, step)
    if limits is not None:
        free.prepare_limits(first, last, slots, free_parts, limits, step)


@kernel
def along(verb, first, last, slots, rows, springs, motors, limits, free_parts, moved, step):
    """What is done alike to rows that turn and to rows that slide."""
    if verb == PREPARE_ROWS:
        prepare_free(first, last, slots, springs, motors, limits, free_parts, step)
    elif verb == WARM_ROWS:
        directions.warm_start(first, last, rows, springs, motors, limits, moved)
    elif verb == FORGET_ROWS:
        directions.forget(first, last, rows, springs, motors, limits)
    elif verb == STORE_ROWS:
        free.store_impulses(first, last, slots, springs, motors, limits, free_parts, step)
    elif solves(verb):
        biased = verb == BIASED_ROWS
        directions.solve(first, last, rows, springs, motors, limits, moved, biased, kept_of(verb, step), step)


@kernel
def turn(verb, first, last, slots, rows, springs, motors, limits, joints, turns, bodies, motions, moved, step):
    """Rows that turn."""
    if verb == PREPARE_ROWS:
        turnings.prepare(first, last, slots, joints, bodies, motions, rows)
    elif verb == REFRESH_ROWS:
        turnings.refresh(first, last, rows, moved)
    along(verb, first, last, slots, rows, springs, motors, limits, turns, moved, step)


@kernel
def slide(verb, first, last, slots, rows, springs, motors, limits, joints, slides, bodies, motions, moved, step):
    """Rows that slide."""
    if verb == PREPARE_ROWS:
        slidings.prepare(first, last, slots, joints, slides, bodies, motions, rows)
    elif verb == REFRESH_ROWS:
        slidings.refresh(first, last, rows, moved)
    along(verb, first, last, slots, rows, springs, motors, limits, slides, moved, step)


@kernel
def line(verb, first, last, slots, rows, joints, bodies, motions, moved, step):
    """Rows that hold a point on a line."""
    if verb == PREPARE_ROWS:
        lines.prepare(first, last, slots, joints, bodies, motions, rows, step)
    elif verb == REFRESH_ROWS:
        lines.refresh(first, last, rows, moved)
    elif verb == WARM_ROWS:
        lines.warm_start(first, last, rows, moved)
    elif verb == FORGET_ROWS:
        lines.forget(first, last, rows)
    elif verb == STORE_ROWS:
        lines.store_impulses(first, last, slots, rows, joints, step)
    elif solves(verb):
        lines.solve(first, last, rows, moved, verb == BIASED_ROWS, kept_of(verb, step), step)


@kernel
def point(verb, first, last, slots, rows, softs, joints, bodies, motions, moved, step):
    """Rows that hold two points together."""
    if verb == PREPARE_ROWS:
        points.prepare(first, last, slots, joints, bodies, motions, rows, step)
        if softs is not None:
            point_softness.prepare(first, last, slots, joints, softs, step)
    elif verb == WARM_ROWS:
        points.warm_start(first, last, rows, softs, moved)
    elif verb == FORGET_ROWS:
        points.forget(first, last, rows)
    elif verb == STORE_ROWS:
        points.store_impulses(first, last, slots, rows, joints, step)
    elif solves(verb):
        points.solve(first, last, rows, softs, moved, verb == BIASED_ROWS, kept_of(verb, step), step)
