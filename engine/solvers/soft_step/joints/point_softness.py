"""How a point gives way that does not do so like most: a spring, a bias factor of its own, or a largest force.

What stays, a spring or what has a largest force, acts on both bodies where body2's anchor is, however far that is from
body1's, so that angular momentum is kept: dC/dt is then how C changes as body1, turning, sees it, as in slide.py. What
holds rigidly acts on each body at its own anchor, where it is at rest for both.

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
from engine.lanes import const, select
from engine.rows import at, numbers_at
from engine.softness import soft_lanes
from engine.tables import REALS


@cache
def soft_dtype(precision: str) -> np.dtype:
    """How each point gives way."""
    names = (
        "give",  # softness in a substep [1/kg]
        "bias_rate", "mass_scale", "impulse_scale",  # see softness.py
        "stays",  # 1: so when the push is taken back, too, for a spring is a force and no error; else 0
        "most",  # the largest impulse in a substep [N s]
    )  # fmt: skip
    return np.dtype([(name, REALS[precision]) for name in names])


@kernel
def prepare(first, last, slots, joints, softs, step):
    """Writes how each gives way: as a spring, as fast as its bias factor says, or as all joints do."""
    for k in range(first, last):
        soften(at(joints, numbers_at(slots, softs, k)), at(softs, k), step)


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
    row.most = select(capped, const(joint.max_force, zero) * step.h, const(np.inf, zero))
