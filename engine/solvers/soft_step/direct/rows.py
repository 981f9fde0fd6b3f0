"""The rigid rows of a joint as numbers: three rows at most, each with an error and a Jacobian.

A row's rate is l . (v2 - v1) + arm2 w2 - arm1 w1. A row that a joint lacks is left zero. All in float64: the system is
as badly conditioned as masses differ and chains are long.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import const, over, sqrt
from engine.solvers.soft_step.joints.frames import BODY_FIELDS, FRAME_FIELDS, anchors_now, write_bodies, write_frame
from engine.solvers.soft_step.movers import load
from engine.tables import ALONG_NOTHING, LINE, POINT, REALS, STIFF
from engine.vec2 import Vec2, choose, cross, dot, rotate

ROWS = 3
LX, LY, ARM1, ARM2 = range(4)
"""Columns of a Jacobian: direction, then how it turns body1 and body2 [m]; of a row that turns: 0, 0, 1, 1."""


@cache
def direct_dtype(precision: str) -> np.dtype:
    """What stays the same in a step."""
    real = REALS[precision]
    names = (*BODY_FIELDS, *FRAME_FIELDS, "axis_x", "axis_y", "angle_before")
    whole = ("joint", "held", "rod", "turn")  # row of the joint; what it holds; 1: the way, the angle
    fields = [("body1", np.int32), ("body2", np.int32), *((name, np.int32) for name in whole)]
    return np.dtype(fields + [(name, real) for name in names])


@kernel
def prepare(first, last, order, joints, turns, slides, bodies, motions, rows, errors, jacobians):
    """Writes the rows as the step begins. order: rows of the joints."""
    for k in range(first, last):
        joint, row = joints[order[k]], rows[k]
        frame = write_bodies(row, joint, bodies, motions)
        write_frame(row, frame)
        motion = motions[joint.body1]
        lane = motion.cosine
        axis = rotate(Vec2(motion.cosine, motion.sine), Vec2(const(joint.axis_x, lane), const(joint.axis_y, lane)))
        row.axis_x, row.axis_y = axis.x, axis.y
        row.angle_before = frame.angle
        row.joint = order[k]
        row.held = joint.held
        row.rod = 1 if slides[order[k]].along != ALONG_NOTHING and slides[order[k]].spring == STIFF else 0
        row.turn = 1 if turns[order[k]].along != ALONG_NOTHING and turns[order[k]].spring == STIFF else 0
        length = slides[order[k]].target
        way = (frame.apart + frame.arm2) - frame.arm1
        write_geometry(row, k, frame.arm1, frame.arm2, way, axis, row.angle_before, length, errors, jacobians)


@kernel
def refresh(first, last, slides, rows, movers, errors, jacobians):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = rows[k]
        a, b = load(movers, row.body1), load(movers, row.body2)
        now = anchors_now(row, a, b)
        axis = rotate(a.q, Vec2(row.axis_x, row.axis_y))
        angle = row.angle_before + (b.turned - a.turned)
        write_geometry(row, k, now.r1, now.r2, now.way, axis, angle, slides[row.joint].target, errors, jacobians)


@kernel
def write_row(jacobians, k, i, direction, arm1, arm2):
    """One row of a Jacobian."""
    jacobians[k, i, LX] = direction.x
    jacobians[k, i, LY] = direction.y
    jacobians[k, i, ARM1] = arm1
    jacobians[k, i, ARM2] = arm2


@kernel
def write_geometry(row, k, r1, r2, way, axis, angle, length, errors, jacobians):
    """Writes errors and Jacobians of one joint."""
    zero, one = const(0.0, angle), const(1.0, angle)
    nothing = Vec2(zero, zero)
    count = 0
    if row.held == POINT:
        write_row(jacobians, k, 0, Vec2(one, zero), -r1.y, -r2.y)
        write_row(jacobians, k, 1, Vec2(zero, one), r1.x, r2.x)
        errors[k, 0], errors[k, 1] = way.x, way.y
        count = 2
    elif row.held >= LINE:
        u = Vec2(-axis.y, axis.x)
        write_row(jacobians, k, 0, u, cross(r1 + way, u), cross(r2, u))
        errors[k, 0] = dot(u, way)
        count = 1
    if row.rod != 0:
        far = sqrt(dot(way, way))
        n = choose(far > zero, way * over(one, far), Vec2(zero, one))
        write_row(jacobians, k, count, n, cross(r1 + way, n), cross(r2, n))
        errors[k, count] = far - length
        count += 1
    if row.turn != 0 or row.held == LINE:
        write_row(jacobians, k, count, nothing, one, one)
        errors[k, count] = angle
        count += 1
    for i in range(count, ROWS):
        write_row(jacobians, k, i, nothing, zero, zero)
        errors[k, i] = 0


@kernel
def carry(first, last, rows, accumulated, joints, turns, slides, step):
    """The impulses to begin with, those of the step before: the other way round of `store`."""
    for k in range(first, last):
        row = rows[k]
        joint, turn, slide = joints[row.joint], turns[row.joint], slides[row.joint]
        for i in range(ROWS):
            accumulated[k, i] = 0.0
        count = 0
        if row.held == POINT:
            accumulated[k, 0], accumulated[k, 1] = joint.impulse_x * step.carried, joint.impulse_y * step.carried
            count = 2
        elif row.held >= LINE:
            accumulated[k, 0] = joint.impulse_x * step.carried
            count = 1
        if row.rod != 0:
            accumulated[k, count] = slide.spring_impulse * step.carried
            count += 1
        if row.held == LINE:
            accumulated[k, count] = joint.impulse_y * step.carried
        elif row.turn != 0:
            accumulated[k, count] = turn.spring_impulse * step.carried


@kernel
def store(first, last, rows, given, accumulated, joints, turns, slides, step):
    """Keeps what was given, where the kind of joint has it: accumulated in the last substep, and in all."""
    for k in range(first, last):
        row = rows[k]
        joint, turn, slide = joints[row.joint], turns[row.joint], slides[row.joint]
        count = 0
        if row.held == POINT:
            joint.given_x, joint.given_y = given[k, 0], given[k, 1]
            joint.impulse_x, joint.impulse_y = accumulated[k, 0] * step.parts, accumulated[k, 1] * step.parts
            count = 2
        elif row.held >= LINE:
            joint.given_x = given[k, 0]
            joint.impulse_x = accumulated[k, 0] * step.parts
            count = 1
        if row.rod != 0:
            slide.spring_given = given[k, count]
            slide.spring_impulse = accumulated[k, count] * step.parts
            count += 1
        if row.held == LINE:
            joint.given_y = given[k, count]
            joint.impulse_y = accumulated[k, count] * step.parts
        elif row.turn != 0:
            turn.spring_given = given[k, count]
            turn.spring_impulse = accumulated[k, count] * step.parts
