"""Impulses of rows: where they are kept from step to step, and what they do to velocities."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const
from engine.solvers.joint_rows.tables import ACROSS_AXIS, DRIVES, LOWER, TURN, UPPER, X, Y
from engine.tables import POINT
from engine.vec2 import Vec2, dot


@kernel
def begin(row, joint, free, step):
    """The impulse of the step before, as much as a substep of this one starts from; nothing without warm starting."""
    if row.use == DRIVES:
        impulse = free.motor_impulse
    elif row.use == LOWER:
        impulse = free.lower_impulse
    elif row.use == UPPER:
        impulse = -free.upper_impulse
    elif row.measures == X or row.measures == ACROSS_AXIS:
        impulse = joint.impulse_x
    elif row.measures == Y or (row.measures == TURN and joint.held > POINT):
        impulse = joint.impulse_y
    else:
        impulse = free.spring_impulse
    nothing = const(0.0, row.error)
    row.impulse = impulse * step.carried if step.warm_starting != 0 else nothing
    row.given = nothing


@kernel
def store(rows, frames, joints, turns, slides, parts):
    """Keeps the impulses for the next step, as for all its `parts` substeps, and what was given."""
    for k in range(len(rows)):
        row = rows[k]
        index = frames[row.frame].joint
        joint = joints[index]
        free = turns[index] if row.measures == TURN else slides[index]
        impulse, given = row.impulse * parts, row.given
        if row.use == DRIVES:
            free.motor_impulse, free.motor_given = impulse, given
        elif row.use == LOWER:
            free.lower_impulse, free.lower_given = impulse, given
        elif row.use == UPPER:
            free.upper_impulse, free.upper_given = -impulse, -given
        elif row.measures == X or row.measures == ACROSS_AXIS:
            joint.impulse_x, joint.given_x = impulse, given
        elif row.measures == Y or (row.measures == TURN and joint.held > POINT):
            joint.impulse_y, joint.given_y = impulse, given
        else:
            free.spring_impulse, free.spring_given = impulse, given


class Speeds(NamedTuple):
    """Velocities of a row's two bodies [m/s], [rad/s]."""

    v1: Vec2
    w1: Any
    v2: Vec2
    w2: Any


@kernel
def rate(row, speeds):
    """dC/dt [m/s]."""
    return dot(speeds.v2 - speeds.v1, Vec2(row.nx, row.ny)) + (row.arm2 * speeds.w2 - row.arm1 * speeds.w1)


@kernel
def pushed(row, frame, speeds, impulse):
    """The velocities after an impulse along the row, on body2, and against it on body1 [N s]."""
    along = Vec2(row.nx, row.ny) * impulse
    return Speeds(
        speeds.v1 - along * frame.inverse_mass1,
        speeds.w1 - frame.inverse_inertia1 * row.arm1 * impulse,
        speeds.v2 + along * frame.inverse_mass2,
        speeds.w2 + frame.inverse_inertia2 * row.arm2 * impulse,
    )
