"""Two anchors stay together as if by a stiff, damped spring: what a revolute joint is, and part of other kinds.

With C the way from anchor to anchor, one pass gives the impulse -K^-1 (mass_scale (dC/dt + bias_rate C))
- impulse_scale P, K being the 2x2 matrix that turns an impulse into a change of dC/dt; see softness.py. What gives way
otherwise than most, as a spring of its own or up to a largest force, has a row in two more tables: point_softness.py.

A row is no more than what a pass must read: it turns the anchors anew and inverts K anew, which takes less time than to
fetch them from memory.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from engine.jit import kernel
from engine.lanes import const, maximum, minimum, over, sqrt
from engine.rows import at, numbers_at
from engine.solvers.soft_step.joints.frames import (
    BODY_FIELDS,
    FRAME_FIELDS,
    Anchors,
    anchors_now,
    write_bodies,
    write_frame,
)
from engine.solvers.soft_step.movers import load, store
from engine.tables import REALS
from engine.vec2 import Vec2, choose, cross, dot, spin


@cache
def point_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        *BODY_FIELDS,
        *FRAME_FIELDS,
        "impulse_x", "impulse_y",  # accumulated in a substep, on body2 [N s]
        "given_x", "given_y",  # in all substeps [N s]
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


class Mass(NamedTuple):
    """The inverse of K [kg]."""

    xx: Any
    xy: Any
    yy: Any


# Below, softs: None where no point gives way otherwise than most.


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows, step):
    """Turns the anchors as the step begins."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        row = at(rows, k)
        write_frame(row, write_bodies(row, joint, bodies, motions))
        row.impulse_x = joint.impulse_x * step.carried
        row.impulse_y = joint.impulse_y * step.carried
        row.given_x = const(0.0, row.arm1_x)
        row.given_y = const(0.0, row.arm1_x)


@kernel
def points_now(row, softs, k, a, b):
    """Where an impulse acts on the two bodies, and the way between their anchors."""
    now = anchors_now(row, a, b)
    if softs is not None:
        return Anchors(now.r1 + now.way * at(softs, k).stays, now.r2, now.way)
    return now


@kernel
def mass_of(row, softs, k, r1, r2):
    """The effective mass."""
    i1, i2 = row.inverse_inertia1, row.inverse_inertia2
    free = row.inverse_mass1 + row.inverse_mass2
    if softs is not None:
        free = free + at(softs, k).give
    k_xx = free + i1 * r1.y * r1.y + i2 * r2.y * r2.y
    k_xy = -(i1 * r1.x * r1.y) - i2 * r2.x * r2.y
    k_yy = free + i1 * r1.x * r1.x + i2 * r2.x * r2.x
    inverse = over(const(1.0, k_xx), k_xx * k_yy - k_xy * k_xy)
    return Mass(inverse * k_yy, -(inverse * k_xy), inverse * k_xx)


@kernel
def push(row, movers, a, b, r1, r2, impulse):
    """Gives body2 an impulse, and body1 the other way."""
    turn1, turn2 = row.inverse_inertia1 * cross(r1, impulse), row.inverse_inertia2 * cross(r2, impulse)
    store(movers, row.body1, a.v - impulse * row.inverse_mass1, a.w - turn1, a.turned)
    store(movers, row.body2, b.v + impulse * row.inverse_mass2, b.w + turn2, b.turned)


@kernel
def warm_start(first, last, rows, softs, movers):
    """Gives the bodies the impulses of the substep before."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        now = points_now(row, softs, k, a, b)
        push(row, movers, a, b, now.r1, now.r2, Vec2(row.impulse_x, row.impulse_y))


@kernel
def forget(first, last, rows):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        row = at(rows, k)
        row.impulse_x = const(0.0, row.impulse_x)
        row.impulse_y = const(0.0, row.impulse_y)


@kernel
def change(softs, k, mass, speed, way, before, biased, step):
    """What removes the relative velocity of the two anchors, and part of what is between them [N s]."""
    zero, one = const(0.0, speed.x), const(1.0, speed.x)
    bias_rate, mass_scale, impulse_scale = zero, one, zero
    if biased:
        bias_rate, mass_scale = const(step.joint_bias_rate, zero), const(step.joint_mass_scale, zero)
        impulse_scale = const(step.joint_impulse_scale, zero)
    if softs is not None:
        soft = at(softs, k)
        bias_rate, mass_scale, impulse_scale = soft.bias_rate, soft.mass_scale, soft.impulse_scale
        if not biased:
            bias_rate, impulse_scale = bias_rate * soft.stays, impulse_scale * soft.stays
            mass_scale = one + soft.stays * (mass_scale - one)
    wanted = -(speed + way * bias_rate)
    if softs is not None:
        wanted = wanted - before * at(softs, k).give
    return Vec2(
        mass_scale * (mass.xx * wanted.x + mass.xy * wanted.y) - impulse_scale * before.x,
        mass_scale * (mass.xy * wanted.x + mass.yy * wanted.y) - impulse_scale * before.y,
    )


@kernel
def held_to(total, most):
    """An impulse that is no longer than `most`."""
    zero = const(0.0, most)
    length = sqrt(dot(total, total))
    scale = minimum(const(1.0, most), most / maximum(length, const(1e-30, most)))
    return choose(length > zero, total * scale, total)


@kernel
def solve(first, last, rows, softs, movers, biased, kept, step):
    """One pass over the rows: with bias, or taking the push back.

    kept: 1 in the last pass of a substep, whose impulses are what the substep gave; 0 in others.
    """
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        now = points_now(row, softs, k, a, b)
        r1, r2 = now.r1, now.r2
        before = Vec2(row.impulse_x, row.impulse_y)
        speed = (b.v + spin(b.w, r2)) - (a.v + spin(a.w, r1))
        impulse = change(softs, k, mass_of(row, softs, k, r1, r2), speed, now.way, before, biased, step)
        if softs is not None:
            most = at(softs, k).most
            held = held_to(before + impulse, most) - before
            impulse = choose(most < const(np.inf, most), held, impulse)
        row.impulse_x += impulse.x
        row.impulse_y += impulse.y
        row.given_x += kept * row.impulse_x
        row.given_y += kept * row.impulse_y
        push(row, movers, a, b, r1, r2, impulse)


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
