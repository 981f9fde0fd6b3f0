"""The revolute joint in soft_step: its two anchors stay together as if by a stiff, damped spring.

With C the way from anchor to anchor, one pass gives the impulse -K^-1 (mass_scale (dC/dt + bias_rate C))
- impulse_scale P, K being the 2x2 matrix that turns an impulse into a change of dC/dt; see softness.py.

A joint with a softness of its own is that spring: softness 1/(dt (d + dt k)) and bias factor dt k/(d + dt k) give the
stiffness k [N/m] and the damper d [N s/m], which then act in every substep: (K + 1/(h (d + h k))) P = -dC/dt -
k/(d + h k) C - P_before/(h (d + h k)). A rigid one with a bias factor of its own loses that part of C a step.

Rows are made afresh each step, eight joints of a colour side by side, like those of contacts.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from engine.constants import JOINT_BIAS_FACTOR
from engine.jit import kernel
from engine.joints import revolute_motor
from engine.lanes import const, over, select
from engine.origin import center_of, origin_of
from engine.rows import at, numbers_at, pick, put
from engine.solvers.soft_step.movers import load, store
from engine.tables import REALS
from engine.vec2 import Vec2, cross, rotate, spin


@cache
def joint_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        "inverse_mass1", "inverse_inertia1", "inverse_mass2", "inverse_inertia2",
        "r1_x", "r1_y", "r2_x", "r2_y",  # anchors from the centres of mass, as the step began [m]
        "apart_x", "apart_y",  # from centre to centre, as the step began [m]
        "give",  # softness in a substep [1/kg]
        "bias_rate", "mass_scale", "impulse_scale",  # see softness.py
        "spring_rate",  # bias that stays when the push is taken back: a spring is a force and no error [1/s]
        "impulse_x", "impulse_y",  # accumulated in a substep, on body2 [N s]
        "given_x", "given_y",  # in all substeps [N s]
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


class Anchors(NamedTuple):
    """Where a joint's anchors are now, from the centres of mass [m], and how they move apart."""

    r1: Vec2
    r2: Vec2
    apart: Vec2  # [m]
    speed: Vec2  # [m/s]


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows, step):
    """Turns the anchors as the step begins, and takes the softness of each joint."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        body1, body2 = at(bodies, joint.body1), at(bodies, joint.body2)
        motion1, motion2 = at(motions, joint.body1), at(motions, joint.body2)
        lane = motion1.inverse_mass
        arm1 = Vec2(const(joint.anchor1_x - body1.local_x, lane), const(joint.anchor1_y - body1.local_y, lane))
        arm2 = Vec2(const(joint.anchor2_x - body2.local_x, lane), const(joint.anchor2_y - body2.local_y, lane))
        r1 = rotate(Vec2(motion1.cosine, motion1.sine), arm1)
        r2 = rotate(Vec2(motion2.cosine, motion2.sine), arm2)
        origin = origin_of(body1, lane)
        apart = center_of(body2, origin, lane) - center_of(body1, origin, lane)
        row = at(rows, k)
        row.body1 = const(joint.body1, row.body1)
        row.body2 = const(joint.body2, row.body2)
        row.inverse_mass1, row.inverse_inertia1 = lane, motion1.inverse_inertia
        row.inverse_mass2, row.inverse_inertia2 = motion2.inverse_mass, motion2.inverse_inertia
        row.r1_x, row.r1_y = r1.x, r1.y
        row.r2_x, row.r2_y = r2.x, r2.y
        row.apart_x, row.apart_y = apart.x, apart.y
        row.impulse_x = joint.impulse_x * step.carried
        row.impulse_y = joint.impulse_y * step.carried
        row.given_x = const(0.0, lane)
        row.given_y = const(0.0, lane)
        soften(joint, row, step)


@kernel
def soften(joint, row, step):
    """Writes how a joint gives way: as a spring of its own, as fast as its bias factor says, or as all joints do."""
    zero = const(0.0, joint.softness)
    one = const(1.0, joint.softness)
    correction = step.position_correction != 0
    springy = joint.softness > zero
    own = joint.bias_factor >= zero
    factor = select(own, joint.bias_factor, const(JOINT_BIAS_FACTOR, zero))
    if not correction:
        factor = zero
    whole = one / (select(springy, joint.softness, one) * step.dt)  # d + dt k
    k = factor * whole * step.inverse_dt
    d = whole - k * step.dt
    spring_rate = k / (d + step.h * k)
    row.give = select(springy, one / (step.h * (d + step.h * k)), zero)
    row.bias_rate = select(
        springy, spring_rate, select(own, factor * step.inverse_dt, const(step.joint_bias_rate, zero))
    )  # fmt: skip
    plain = springy | own
    row.mass_scale = select(plain, one, const(step.joint_mass_scale, zero))
    row.impulse_scale = select(plain, zero, const(step.joint_impulse_scale, zero))
    row.spring_rate = select(springy, spring_rate, zero)


@kernel
def prepare_motors(first, last, slots, rows, motored, speeds, torques, impulses, motors, step):
    """Writes the motors' rows; the columns of joints are those of engine/effects/motors.py."""
    for k in range(first, last):
        index = numbers_at(slots, rows, k)
        row = at(rows, k)
        motor = at(motors, k)
        zero = const(0.0, row.inverse_inertia1)
        there = pick(motored, index) != 0
        mass = over(const(1.0, zero), row.inverse_inertia1 + row.inverse_inertia2)
        motor.speed = const(pick(speeds, index), zero)
        motor.mass = select(there, mass, zero)
        motor.limit = select(there, const(pick(torques, index), zero) * step.h, zero)
        motor.impulse = const(pick(impulses, index), zero) * step.carried
        motor.given = zero


@kernel
def anchors_of(row, a, w1, b, w2):
    """Where the anchors are, and how they move, the bodies turning at w1 and w2."""
    r1 = rotate(a.q, Vec2(row.r1_x, row.r1_y))
    r2 = rotate(b.q, Vec2(row.r2_x, row.r2_y))
    apart = ((b.d - a.d) + Vec2(row.apart_x, row.apart_y)) + (r2 - r1)
    return Anchors(r1, r2, apart, (b.v + spin(w2, r2)) - (a.v + spin(w1, r1)))


@kernel
def warm_start(first, last, rows, motors, movers):
    """Gives the bodies the impulses of the substep before. Here and below, motors: None where no joint has one."""
    for k in range(first, last):
        row = at(rows, k)
        a = load(movers, row.body1)
        b = load(movers, row.body2)
        r1 = rotate(a.q, Vec2(row.r1_x, row.r1_y))
        r2 = rotate(b.q, Vec2(row.r2_x, row.r2_y))
        impulse = Vec2(row.impulse_x, row.impulse_y)
        turn1, turn2 = cross(r1, impulse), cross(r2, impulse)
        if motors is not None:
            turn1 = turn1 + at(motors, k).impulse
            turn2 = turn2 + at(motors, k).impulse
        store(movers, row.body1, a.v - impulse * row.inverse_mass1, a.w - row.inverse_inertia1 * turn1, a.turned)
        store(movers, row.body2, b.v + impulse * row.inverse_mass2, b.w + row.inverse_inertia2 * turn2, b.turned)


@kernel
def forget(first, last, rows, motors):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        row = at(rows, k)
        zero = const(0.0, row.give)
        row.impulse_x = zero
        row.impulse_y = zero
        if motors is not None:
            at(motors, k).impulse = zero


@kernel
def wanted_impulse(row, anchors, before, bias_rate, mass_scale, impulse_scale):
    """What removes the relative velocity of the two anchors, and part of what is between them [N s]."""
    i1, i2 = row.inverse_inertia1, row.inverse_inertia2
    r1, r2 = anchors.r1, anchors.r2
    free = row.inverse_mass1 + row.inverse_mass2 + row.give
    k_xx = free + i1 * r1.y * r1.y + i2 * r2.y * r2.y
    k_xy = -(i1 * r1.x * r1.y) - i2 * r2.x * r2.y
    k_yy = free + i1 * r1.x * r1.x + i2 * r2.x * r2.x
    inverse = over(mass_scale, k_xx * k_yy - k_xy * k_xy)
    wanted = -(anchors.speed + anchors.apart * bias_rate) - before * row.give
    return Vec2(
        inverse * (k_yy * wanted.x - k_xy * wanted.y) - impulse_scale * before.x,
        inverse * (k_xx * wanted.y - k_xy * wanted.x) - impulse_scale * before.y,
    )


@kernel
def solve(first, last, rows, motors, movers, biased, kept):
    """One pass over the joints, each joint's motor first: with bias, or taking the push back.

    kept: 1 in the last pass of a substep, whose impulses are what the substep gave; 0 in others.
    """
    for k in range(first, last):
        row = at(rows, k)
        a = load(movers, row.body1)
        b = load(movers, row.body2)
        w1, w2 = a.w, b.w
        if motors is not None:
            motor = at(motors, k)
            turn = revolute_motor.change(w2 - w1, motor.speed, motor.mass, motor.impulse, motor.limit)
            motor.impulse += turn
            motor.given += kept * motor.impulse
            w1 = w1 - row.inverse_inertia1 * turn
            w2 = w2 + row.inverse_inertia2 * turn
        anchors = anchors_of(row, a, w1, b, w2)
        before = Vec2(row.impulse_x, row.impulse_y)
        bias_rate, mass_scale, impulse_scale = row.spring_rate, const(1.0, w1), const(0.0, w1)
        if biased:
            bias_rate, mass_scale, impulse_scale = row.bias_rate, row.mass_scale, row.impulse_scale
        impulse = wanted_impulse(row, anchors, before, bias_rate, mass_scale, impulse_scale)
        row.impulse_x += impulse.x
        row.impulse_y += impulse.y
        row.given_x += kept * row.impulse_x
        row.given_y += kept * row.impulse_y
        w1 = w1 - row.inverse_inertia1 * cross(anchors.r1, impulse)
        w2 = w2 + row.inverse_inertia2 * cross(anchors.r2, impulse)
        store(movers, row.body1, a.v - impulse * row.inverse_mass1, w1, a.turned)
        store(movers, row.body2, b.v + impulse * row.inverse_mass2, w2, b.turned)


@kernel
def store_impulses(first, last, slots, rows, motors, joints, motor_impulses, motor_given, step):
    """Keeps the impulses, as for a whole step, and what was given."""
    for k in range(first, last):
        index = numbers_at(slots, rows, k)
        row = at(rows, k)
        joint = at(joints, index)
        joint.impulse_x = row.impulse_x * step.parts
        joint.impulse_y = row.impulse_y * step.parts
        joint.given_x = row.given_x
        joint.given_y = row.given_y
        if motors is not None:
            put(motor_impulses, index, at(motors, k).impulse * step.parts)
            put(motor_given, index, at(motors, k).given)
