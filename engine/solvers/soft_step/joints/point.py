"""Two anchors stay together as if by a stiff, damped spring: what a revolute joint is, and part of other kinds.

With C the way from anchor to anchor, one pass gives the impulse -K^-1 (mass_scale (dC/dt + bias_rate C))
- impulse_scale P, K being the 2x2 matrix that turns an impulse into a change of dC/dt; see softness.py.

The impulse acts on both bodies where body2's anchor is, so that angular momentum is kept however far it has yet to come:
dC/dt is then how C changes as body1, turning, sees it, as in line.py and slide.py.

A joint with a softness of its own is that spring: softness 1/(dt (d + dt k)) and bias factor dt k/(d + dt k) give the
stiffness k [N/m] and the damper d [N s/m], which then act in every substep: (K + 1/(h (d + h k))) P = -dC/dt -
k/(d + h k) C - P_before/(h (d + h k)). A rigid one with a bias factor of its own loses that part of C a step. One with
a frequency of its own is a spring of that frequency, for the mass that it holds.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.constants import JOINT_BIAS_FACTOR
from engine.jit import kernel
from engine.lanes import const, maximum, minimum, over, select, sqrt
from engine.rows import at, numbers_at
from engine.softness import soft_lanes
from engine.solvers.soft_step.joints.frames import BODY_FIELDS, FRAME_FIELDS, anchors_now, write_bodies, write_frame
from engine.solvers.soft_step.movers import load, store
from engine.tables import REALS
from engine.vec2 import Vec2, choose, cross, dot, spin


@cache
def point_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        *BODY_FIELDS,
        "r1_x", "r1_y", "r2_x", "r2_y",  # body2's anchor from both centres of mass, now [m]
        "way_x", "way_y",  # from anchor to anchor, now [m]
        "mass_xx", "mass_xy", "mass_yy",  # inverse of K [kg]
        "give",  # softness in a substep [1/kg]
        "bias_rate", "mass_scale", "impulse_scale",  # see softness.py
        "stays",  # 1: so when the push is taken back, too, for a spring is a force and no error; else 0
        "impulse_x", "impulse_y",  # accumulated in a substep, on body2 [N s]
        "given_x", "given_y",  # in all substeps [N s]
        *FRAME_FIELDS,
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


@cache
def cap_dtype(precision: str) -> np.dtype:
    """The largest impulse that a point gives in a substep [N s]."""
    return np.dtype([("most", REALS[precision])])


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows, step):
    """Turns the anchors as the step begins, and takes the softness of each joint."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        row = at(rows, k)
        frame = write_bodies(row, joint, bodies, motions)
        write_frame(row, frame)
        row.impulse_x = joint.impulse_x * step.carried
        row.impulse_y = joint.impulse_y * step.carried
        row.given_x = const(0.0, row.give)
        row.given_y = const(0.0, row.give)
        soften(joint, row, step)
        write_geometry(row, frame.apart + frame.arm2, frame.arm2, (frame.apart + frame.arm2) - frame.arm1)


@kernel
def prepare_caps(first, last, slots, joints, caps, step):
    """Writes how much each may give."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, caps, k))
        none = const(np.inf, joint.softness)
        most = const(joint.max_force, none) * step.h
        at(caps, k).most = select(joint.max_force >= const(0.0, joint.max_force), most, none)


@kernel
def soften(joint, row, step):
    """Writes how a joint gives way: as a spring, as fast as its bias factor says, or as all joints do."""
    zero = const(0.0, joint.softness)
    one = const(1.0, joint.softness)
    springy = joint.softness > zero
    own = joint.bias_factor >= zero
    factor = select(own, joint.bias_factor, const(JOINT_BIAS_FACTOR, zero))
    if step.position_correction == 0:
        factor = zero
    whole = one / (select(springy, joint.softness, one) * step.dt)  # d + dt k
    k = factor * whole * step.inverse_dt
    d = whole - k * step.dt
    row.give = select(springy, one / (step.h * (d + step.h * k)), zero)
    hertz = const(joint.hertz, zero)
    tuned = hertz > zero
    soft = soft_lanes(hertz, const(joint.damping_ratio, zero), step.h)
    plain = springy | own
    rate = select(
        springy, k / (d + step.h * k), select(own, factor * step.inverse_dt, const(step.joint_bias_rate, zero))
    )  # fmt: skip
    row.bias_rate = select(tuned, soft.bias_rate, rate)
    scale = select(plain, one, const(step.joint_mass_scale, zero))
    row.mass_scale = select(tuned, soft.mass_scale, scale)
    scale = select(plain, zero, const(step.joint_impulse_scale, zero))
    row.impulse_scale = select(tuned, soft.impulse_scale, scale)
    capped = joint.max_force >= const(0.0, joint.max_force)  # else what it gives is taken back, and it creeps there
    row.stays = select(springy | tuned | capped, one, zero)


@kernel
def write_geometry(row, r1, r2, way):
    """Writes error, Jacobian and effective mass of a row."""
    i1, i2 = row.inverse_inertia1, row.inverse_inertia2
    free = row.inverse_mass1 + row.inverse_mass2 + row.give
    k_xx = free + i1 * r1.y * r1.y + i2 * r2.y * r2.y
    k_xy = -(i1 * r1.x * r1.y) - i2 * r2.x * r2.y
    k_yy = free + i1 * r1.x * r1.x + i2 * r2.x * r2.x
    inverse = over(const(1.0, k_xx), k_xx * k_yy - k_xy * k_xy)
    row.r1_x, row.r1_y = r1.x, r1.y
    row.r2_x, row.r2_y = r2.x, r2.y
    row.way_x, row.way_y = way.x, way.y
    row.mass_xx = inverse * k_yy
    row.mass_xy = -(inverse * k_xy)
    row.mass_yy = inverse * k_xx


@kernel
def refresh(first, last, rows, movers):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = at(rows, k)
        now = anchors_now(row, load(movers, row.body1), load(movers, row.body2))
        write_geometry(row, now.r1 + now.way, now.r2, now.way)


@kernel
def warm_start(first, last, rows, movers):
    """Gives the bodies the impulses of the substep before."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        impulse = Vec2(row.impulse_x, row.impulse_y)
        turn1 = row.inverse_inertia1 * cross(Vec2(row.r1_x, row.r1_y), impulse)
        turn2 = row.inverse_inertia2 * cross(Vec2(row.r2_x, row.r2_y), impulse)
        store(movers, row.body1, a.v - impulse * row.inverse_mass1, a.w - turn1, a.turned)
        store(movers, row.body2, b.v + impulse * row.inverse_mass2, b.w + turn2, b.turned)


@kernel
def forget(first, last, rows):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        row = at(rows, k)
        row.impulse_x = const(0.0, row.give)
        row.impulse_y = const(0.0, row.give)


@kernel
def change(row, speed, before, biased):
    """What removes the relative velocity of the two anchors, and part of what is between them [N s]."""
    bias_rate, mass_scale, impulse_scale = row.bias_rate, row.mass_scale, row.impulse_scale
    if not biased:
        one = const(1.0, bias_rate)
        bias_rate = bias_rate * row.stays
        mass_scale = one + row.stays * (mass_scale - one)
        impulse_scale = impulse_scale * row.stays
    wanted = -(speed + Vec2(row.way_x, row.way_y) * bias_rate) - before * row.give
    return Vec2(
        mass_scale * (row.mass_xx * wanted.x + row.mass_xy * wanted.y) - impulse_scale * before.x,
        mass_scale * (row.mass_xy * wanted.x + row.mass_yy * wanted.y) - impulse_scale * before.y,
    )


@kernel
def held_to(total, most):
    """An impulse that is no longer than `most`."""
    zero = const(0.0, most)
    length = sqrt(dot(total, total))
    scale = minimum(const(1.0, most), most / maximum(length, const(1e-30, most)))
    return choose(length > zero, total * scale, total)


@kernel
def solve(first, last, rows, caps, movers, biased, kept):
    """One pass over the rows: with bias, or taking the push back. caps: None where nothing is held to a largest force.

    kept: 1 in the last pass of a substep, whose impulses are what the substep gave; 0 in others.
    """
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        r1, r2 = Vec2(row.r1_x, row.r1_y), Vec2(row.r2_x, row.r2_y)
        before = Vec2(row.impulse_x, row.impulse_y)
        speed = (b.v + spin(b.w, r2)) - (a.v + spin(a.w, r1))
        impulse = change(row, speed, before, biased)
        if caps is not None:
            impulse = held_to(before + impulse, at(caps, k).most) - before
        row.impulse_x += impulse.x
        row.impulse_y += impulse.y
        row.given_x += kept * row.impulse_x
        row.given_y += kept * row.impulse_y
        turn1, turn2 = row.inverse_inertia1 * cross(r1, impulse), row.inverse_inertia2 * cross(r2, impulse)
        store(movers, row.body1, a.v - impulse * row.inverse_mass1, a.w - turn1, a.turned)
        store(movers, row.body2, b.v + impulse * row.inverse_mass2, b.w + turn2, b.turned)


@kernel
def store_impulses(first, last, slots, rows, joints, step):
    """Keeps the impulses, as for a whole step, and what was given."""
    for k in range(first, last):
        row = at(rows, k)
        joint = at(joints, numbers_at(slots, rows, k))
        joint.impulse_x = row.impulse_x * step.parts
        joint.impulse_y = row.impulse_y * step.parts
        joint.given_x = row.given_x
        joint.given_y = row.given_y
