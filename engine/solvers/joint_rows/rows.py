"""Rows as numbers: values and Jacobians, which follow from where bodies are; what a row aims at, and may give."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from engine.constants import JOINT_BIAS_FACTOR
from engine.jit import kernel
from engine.lanes import const, over, sqrt
from engine.solvers.joint_rows.impulses import begin
from engine.solvers.joint_rows.tables import (
    ACROSS_AXIS,
    ALONG_THE_WAY,
    DRIVES,
    HOLDS,
    LOWER,
    SPRINGS,
    TURN,
    UPPER,
    X,
    Y,
)  # fmt: skip
from engine.solvers.soft_step.joints.frames import anchors_now, write_bodies, write_frame
from engine.solvers.soft_step.movers import load
from engine.tables import POINT
from engine.vec2 import Vec2, choose, cross, dot, rotate


class Measure(NamedTuple):
    """Where a row is."""

    value: Any  # [m] or [rad]
    n: Vec2  # its Jacobian
    arm1: Any
    arm2: Any


@kernel
def measure(row, frame, a, b):
    """Value and Jacobian of a row while its bodies are where the movers a and b say."""
    one, zero = const(1.0, row.error), const(0.0, row.error)
    if row.measures == TURN:
        return Measure(frame.angle_before + (b.turned - a.turned), Vec2(zero, zero), one, one)
    now = anchors_now(frame, a, b)
    if row.measures == X:
        return Measure(now.way.x, Vec2(one, zero), -now.r1.y, -now.r2.y)
    if row.measures == Y:
        return Measure(now.way.y, Vec2(zero, one), now.r1.x, now.r2.x)
    reach = now.r1 + now.way
    if row.measures == ALONG_THE_WAY:
        length = sqrt(dot(now.way, now.way))
        n = choose(length > zero, now.way * over(one, length), Vec2(zero, one))
        return Measure(length, n, cross(reach, n), cross(now.r2, n))
    axis = rotate(a.q, Vec2(frame.axis_x, frame.axis_y))
    n = choose(row.measures == ACROSS_AXIS, Vec2(-axis.y, axis.x), axis)
    return Measure(dot(n, now.way), n, cross(reach, n), cross(now.r2, n))


@kernel
def inverse_mass(frame, n, arm1, arm2):
    """J M^-1 J^T [1/kg]."""
    turning = frame.inverse_inertia1 * arm1 * arm1 + frame.inverse_inertia2 * arm2 * arm2
    return (frame.inverse_mass1 + frame.inverse_mass2) * dot(n, n) + turning


@kernel
def place(row, frame, movers):
    """Brings one row to where its bodies are."""
    found = measure(row, frame, load(movers, frame.body1), load(movers, frame.body2))
    row.nx, row.ny = found.n.x, found.n.y
    row.arm1, row.arm2 = found.arm1, found.arm2
    row.error = found.value - row.zero
    row.mass = over(const(1.0, row.error), inverse_mass(frame, found.n, found.arm1, found.arm2))


@kernel
def refresh(rows, frames, movers):
    """Brings all rows to where their bodies are."""
    for k in range(len(rows)):
        place(rows[k], frames[rows[k].frame], movers)


@kernel
def prepare(rows, frames, joints, turns, slides, bodies, motions, movers, step):
    """Writes frames and rows as a step begins, movers having begun. Impulses are those to start a substep with."""
    for k in range(len(frames)):
        frame = frames[k]
        joint = joints[frame.joint]
        found = write_bodies(frame, joint, bodies, motions)
        write_frame(frame, found)
        motion = motions[joint.body1]
        lane = motion.cosine
        axis = rotate(Vec2(motion.cosine, motion.sine), Vec2(const(joint.axis_x, lane), const(joint.axis_y, lane)))
        frame.axis_x, frame.axis_y = axis.x, axis.y
        frame.angle_before = found.angle
    for k in range(len(rows)):
        row = rows[k]
        frame = frames[row.frame]
        joint, turn, slide = joints[frame.joint], turns[frame.joint], slides[frame.joint]
        if row.measures < ACROSS_AXIS:
            row.use = SPRINGS if joint.softness > 0 or joint.hertz > 0.0 else HOLDS
        free = turn if row.measures == TURN else slide
        write_aim(row, joint, free, step)
        place(row, frame, movers)
        if row.use == DRIVES:
            row.zero = row.error + row.zero
            row.error = const(0.0, row.error)
        soften(row, frame, joint, free, step)
        begin(row, joint, free, step)


@kernel
def write_aim(row, joint, free, step):
    """Where the error is 0, which rate is wanted, and the bounds of the impulse."""
    lane = row.error
    none = const(np.inf, lane)
    row.zero, row.speed = const(0.0, lane), const(0.0, lane)
    row.least, row.most = -none, none
    if row.use == DRIVES:
        row.speed = const(free.motor_speed, lane)
        row.most = const(free.max_motor, lane) * step.h
        row.least = -row.most
    elif row.use == LOWER:
        row.zero, row.least = const(free.lower, lane), const(0.0, lane)
    elif row.use == UPPER:
        row.zero, row.most = const(free.upper, lane), const(0.0, lane)
    elif row.measures > ACROSS_AXIS and not (row.measures == TURN and joint.held > POINT):
        row.zero = const(free.target, lane)
        if free.max_spring >= 0.0:
            row.most = const(free.max_spring, lane) * step.h
            row.least = -row.most


@kernel
def point_mass(frame):
    """What an anchor weighs, over both directions: 2 / trace K [kg]. Of springs that hold a point."""
    free = frame.inverse_mass1 + frame.inverse_mass2
    one = const(1.0, free)
    two = one + one
    square1 = frame.arm1_x * frame.arm1_x + frame.arm1_y * frame.arm1_y
    square2 = frame.arm2_x * frame.arm2_x + frame.arm2_y * frame.arm2_y
    return over(two, two * free + frame.inverse_inertia1 * square1 + frame.inverse_inertia2 * square2)


@kernel
def soften(row, frame, joint, free, step):
    """Stiffness m omega^2 and damping 2 m zeta omega of a spring that has a frequency.

    Those of a revolute joint with a softness s and a part b of the separation to remove in a step: s = 1 / (dt (d + dt
    k)) and b = dt k / (d + dt k), so k = b / (s dt^2) and d = (1 - b) / (s dt).
    """
    lane = row.error
    row.stiffness, row.damping = const(0.0, lane), const(0.0, lane)
    if row.use != SPRINGS:
        return
    if row.measures < ACROSS_AXIS and joint.softness > 0:
        part = const(JOINT_BIAS_FACTOR, lane) if joint.bias_factor < 0 else joint.bias_factor
        rate = step.inverse_dt / joint.softness
        row.stiffness = part * rate * step.inverse_dt
        row.damping = (const(1.0, lane) - part) * rate
        return
    if row.measures < ACROSS_AXIS:
        mass, hertz, ratio = point_mass(frame), const(joint.hertz, lane), const(joint.damping_ratio, lane)
    else:
        mass, hertz, ratio = row.mass, const(free.hertz, lane), const(free.damping_ratio, lane)
    omega = const(2.0 * math.pi, lane) * hertz
    row.stiffness = mass * omega * omega
    row.damping = const(2.0, lane) * mass * ratio * omega
