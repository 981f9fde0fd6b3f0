"""body2's anchor stays on a line through body1's anchor, and body2 does not turn over body1, or is left free to.

Two rows, solved together: across the axis, which is fixed to body1, and turning. With d the way from anchor to anchor
and u across the axis, the first is u . d = 0, whose rate is u . (v2 - v1) + w2 (r2 x u) - w1 ((r1 + d) x u), since u
turns with body1. They give way as joints do (softness.py).
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import const, over, select
from engine.rows import at, numbers_at
from engine.solvers.soft_step.joints.frames import BODY_FIELDS, FRAME_FIELDS, anchors_now, write_bodies, write_frame
from engine.solvers.soft_step.movers import load, store
from engine.tables import ACROSS, REALS
from engine.vec2 import Vec2, cross, dot, rotate


@cache
def line_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        *BODY_FIELDS,
        "ux", "uy",  # across the axis, now
        "arm1", "arm2",  # how an impulse across turns body1 and body2: (r1 + d) x u, r2 x u [m]
        "off", "angle",  # errors, now [m], [rad]
        "mass_uu", "mass_ut", "mass_tt",  # inverse of K
        "turns",  # 1: the turning is held; 0: it is free
        "impulse", "turn_impulse",  # accumulated in a substep, on body2 [N s], [N m s]
        "given", "turn_given",  # in all substeps
        *FRAME_FIELDS,
        "axis_x", "axis_y",  # in the world, as the step began
        "angle_before",  # of body2 over body1 as the step began [rad]
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows, step):
    """Turns anchors and axis as the step begins."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        row = at(rows, k)
        frame = write_bodies(row, joint, bodies, motions)
        write_frame(row, frame)
        motion = at(motions, joint.body1)
        lane = motion.cosine
        axis = rotate(Vec2(motion.cosine, motion.sine), Vec2(const(joint.axis_x, lane), const(joint.axis_y, lane)))
        row.axis_x, row.axis_y = axis.x, axis.y
        row.angle_before = frame.angle
        row.turns = select(joint.held != ACROSS, const(1.0, lane), const(0.0, lane))
        row.impulse = joint.impulse_x * step.carried
        row.turn_impulse = joint.impulse_y * step.carried
        row.given = const(0.0, lane)
        row.turn_given = const(0.0, lane)
        write_geometry(row, frame.arm1, frame.arm2, (frame.apart + frame.arm2) - frame.arm1, axis, frame.angle)


@kernel
def write_geometry(row, r1, r2, way, axis, angle):
    """Writes errors, Jacobians and effective mass."""
    one, zero = const(1.0, angle), const(0.0, angle)
    u = Vec2(-axis.y, axis.x)
    arm1, arm2 = cross(r1 + way, u), cross(r2, u)
    i1, i2 = row.inverse_inertia1, row.inverse_inertia2
    k_uu = row.inverse_mass1 + row.inverse_mass2 + i1 * arm1 * arm1 + i2 * arm2 * arm2
    k_ut = row.turns * (i1 * arm1 + i2 * arm2)
    k_tt = row.turns * (i1 + i2)
    turns = k_tt > zero
    inverse = over(one, k_uu * select(turns, k_tt, one) - k_ut * k_ut)
    row.ux, row.uy = u.x, u.y
    row.arm1, row.arm2 = arm1, arm2
    row.off, row.angle = dot(u, way), row.turns * angle
    row.mass_uu = inverse * select(turns, k_tt, one)
    row.mass_ut = -(inverse * k_ut)
    row.mass_tt = select(turns, inverse * k_uu, zero)


@kernel
def refresh(first, last, rows, movers):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        now = anchors_now(row, a, b)
        axis = rotate(a.q, Vec2(row.axis_x, row.axis_y))
        write_geometry(row, now.r1, now.r2, now.way, axis, row.angle_before + (b.turned - a.turned))


@kernel
def push(row, movers, a, b, impulse, turn):
    """Gives the bodies an impulse across, and one that turns."""
    across = Vec2(row.ux, row.uy) * impulse
    w1 = a.w - row.inverse_inertia1 * (row.arm1 * impulse + turn)
    w2 = b.w + row.inverse_inertia2 * (row.arm2 * impulse + turn)
    store(movers, row.body1, a.v - across * row.inverse_mass1, w1, a.turned)
    store(movers, row.body2, b.v + across * row.inverse_mass2, w2, b.turned)


@kernel
def warm_start(first, last, rows, movers):
    """Gives the bodies the impulses of the substep before."""
    for k in range(first, last):
        row = at(rows, k)
        push(row, movers, load(movers, row.body1), load(movers, row.body2), row.impulse, row.turn_impulse)


@kernel
def forget(first, last, rows):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        row = at(rows, k)
        row.impulse = const(0.0, row.off)
        row.turn_impulse = const(0.0, row.off)


@kernel
def solve(first, last, rows, movers, biased, kept, step):
    """One pass over the rows: with bias, or taking the push back; kept as in point.py."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        speed = dot(b.v - a.v, Vec2(row.ux, row.uy)) + (row.arm2 * b.w - row.arm1 * a.w)
        spin = row.turns * (b.w - a.w)
        mass_scale, impulse_scale = const(1.0, spin), const(0.0, spin)
        if biased:
            mass_scale, impulse_scale = const(step.joint_mass_scale, spin), const(step.joint_impulse_scale, spin)
            speed = speed + step.joint_bias_rate * row.off
            spin = spin + step.joint_bias_rate * row.angle
        impulse = -(mass_scale * (row.mass_uu * speed + row.mass_ut * spin)) - impulse_scale * row.impulse
        turn = -(mass_scale * (row.mass_ut * speed + row.mass_tt * spin)) - impulse_scale * row.turn_impulse
        row.impulse += impulse
        row.turn_impulse += turn
        row.given += kept * row.impulse
        row.turn_given += kept * row.turn_impulse
        push(row, movers, a, b, impulse, turn)


@kernel
def store_impulses(first, last, slots, rows, joints, step):
    """Keeps the impulses, as for a whole step, and what was given."""
    for k in range(first, last):
        row = at(rows, k)
        joint = at(joints, numbers_at(slots, rows, k))
        joint.impulse_x = row.impulse * step.parts
        joint.impulse_y = row.turn_impulse * step.parts
        joint.given_x = row.given
        joint.given_y = row.turn_given
