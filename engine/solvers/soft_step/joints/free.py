"""What acts where a joint leaves its bodies free: a spring, a motor and two limits, along one direction.

`value` is where the joint is along that direction, `speed` its rate, both of body2 over body1: an angle [rad] or a
translation [m]. `inverse` is what an impulse of 1 changes of the speed, `mass` one over it. A spring drives the value
to its target, softly, or as stiffly as joints are; a motor drives the speed to its own; a limit is a contact: it pushes
and never pulls. Springs and motors give at most so much. Each stands in a table of its own, None where no joint has
one; a row without one has no mass in it, and gives nothing.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, select
from engine.rows import at, numbers_at
from engine.softness import soft_lanes
from engine.tables import NO_SPRING, REALS, SPRING


@cache
def spring_dtype(precision: str) -> np.dtype:
    """A spring's part of a row."""
    real = REALS[precision]
    names = (
        "there",  # 1, or 0: there is none
        "target",  # [rad] or [m]
        "bias_rate", "mass_scale", "impulse_scale",  # see softness.py
        "stays",  # 1: so when the push is taken back, too; 0: an error, and no force
        "most",  # largest impulse of a substep
        "impulse", "given",  # accumulated in a substep, in all substeps
    )  # fmt: skip
    return np.dtype([(name, real) for name in names])


@cache
def motor_dtype(precision: str) -> np.dtype:
    """A motor's part of a row."""
    return np.dtype([(name, REALS[precision]) for name in ("speed", "most", "impulse", "given")])


@cache
def limit_dtype(precision: str) -> np.dtype:
    """Both limits of a row."""
    names = ("there", "lower", "upper", "lower_impulse", "upper_impulse", "lower_given", "upper_given")
    return np.dtype([(name, REALS[precision]) for name in names])


@kernel
def prepare_springs(first, last, slots, free, springs, step):
    """Writes the springs; `free` holds what joints leave free: their turns, or their slides."""
    for k in range(first, last):
        part = at(free, numbers_at(slots, springs, k))
        s = at(springs, k)
        zero = const(0.0, part.spring_impulse)
        one = const(1.0, zero)
        soft = soft_lanes(const(part.hertz, zero), const(part.damping_ratio, zero), step.h)
        springy = part.spring == SPRING
        s.there = select(part.spring != NO_SPRING, one, zero)
        s.target = const(part.target, zero)
        s.bias_rate = select(springy, soft.bias_rate, const(step.joint_bias_rate, zero))
        s.mass_scale = select(springy, soft.mass_scale, const(step.joint_mass_scale, zero))
        s.impulse_scale = select(springy, soft.impulse_scale, const(step.joint_impulse_scale, zero))
        most = const(part.max_spring, zero)
        s.stays = select(springy | (most >= zero), one, zero)  # what has a largest force is a force, and no error
        s.most = select(most >= zero, most * step.h, const(np.inf, zero))
        s.impulse = part.spring_impulse * step.carried
        s.given = zero


@kernel
def prepare_motors(first, last, slots, free, motors, step):
    """Writes the motors."""
    for k in range(first, last):
        part = at(free, numbers_at(slots, motors, k))
        m = at(motors, k)
        zero = const(0.0, part.motor_impulse)
        m.speed = const(part.motor_speed, zero)
        m.most = select(part.motored != 0, const(part.max_motor, zero) * step.h, zero)
        m.impulse = part.motor_impulse * step.carried
        m.given = zero


@kernel
def prepare_limits(first, last, slots, free, limits, step):
    """Writes the limits."""
    for k in range(first, last):
        part = at(free, numbers_at(slots, limits, k))
        row = at(limits, k)
        zero = const(0.0, part.lower_impulse)
        row.there = select(part.limited != 0, const(1.0, zero), zero)
        row.lower, row.upper = const(part.lower, zero), const(part.upper, zero)
        row.lower_impulse = part.lower_impulse * step.carried
        row.upper_impulse = part.upper_impulse * step.carried
        row.lower_given = zero
        row.upper_given = zero


@kernel
def carried(nothing, springs, motors, limits, k):
    """What all of them gave in the substep before."""
    impulse = nothing
    if springs is not None:
        impulse = impulse + at(springs, k).impulse
    if motors is not None:
        impulse = impulse + at(motors, k).impulse
    if limits is not None:
        impulse = impulse + (at(limits, k).lower_impulse - at(limits, k).upper_impulse)
    return impulse


@kernel
def forget(nothing, springs, motors, limits, k):
    """Without warm starting each substep begins with nothing."""
    if springs is not None:
        at(springs, k).impulse = nothing
    if motors is not None:
        at(motors, k).impulse = nothing
    if limits is not None:
        at(limits, k).lower_impulse = nothing
        at(limits, k).upper_impulse = nothing


@kernel
def spring_change(s, value, speed, mass, biased):
    """The impulse to add: an implicit step of the spring, or what holds the joint where it is."""
    one = const(1.0, mass)
    bias_rate, mass_scale, impulse_scale = s.bias_rate, s.mass_scale, s.impulse_scale
    if not biased:
        bias_rate = bias_rate * s.stays
        mass_scale = one + s.stays * (mass_scale - one)
        impulse_scale = impulse_scale * s.stays
    wanted = -(s.there * mass * mass_scale * (speed + bias_rate * (value - s.target))) - impulse_scale * s.impulse
    return clamp(s.impulse + wanted, -s.most, s.most) - s.impulse


@kernel
def motor_change(m, speed, mass):
    """The impulse to add so that the bodies have the motor's speed, as far as it is strong enough."""
    return clamp(m.impulse - mass * (speed - m.speed), -m.most, m.most) - m.impulse


@kernel
def limit_change(room, speed, mass, impulse, biased, step):
    """The impulse to add so that the joint stays on this side of a limit; `room` to it, < 0 beyond; speed away from it.

    While there is room, the joint may use it up within the substep.
    """
    zero, one = const(0.0, mass), const(1.0, mass)
    free = room > zero
    bias, mass_scale, impulse_scale = zero, one, zero
    if biased:
        bias = step.joint_bias_rate * room
        mass_scale, impulse_scale = const(step.joint_mass_scale, mass), const(step.joint_impulse_scale, mass)
    bias = select(free, room * step.inverse_h, bias)
    total = (
        impulse - mass * select(free, one, mass_scale) * (speed + bias) - select(free, zero, impulse_scale) * impulse
    )
    return maximum(total, zero) - impulse


@kernel
def solve(value, speed, inverse, mass, springs, motors, limits, k, biased, kept, step):
    """One pass of spring, motor and limits, one after another. Returns the impulse to give body2, body1 against it."""
    impulse = const(0.0, mass)
    if springs is not None:
        s = at(springs, k)
        change = spring_change(s, value, speed, mass, biased)
        s.impulse += change
        s.given += kept * s.impulse
        impulse = impulse + change
        speed = speed + inverse * change
    if motors is not None:
        m = at(motors, k)
        change = motor_change(m, speed, mass)
        m.impulse += change
        m.given += kept * m.impulse
        impulse = impulse + change
        speed = speed + inverse * change
    if limits is not None:
        row = at(limits, k)
        there = mass * row.there
        change = limit_change(value - row.lower, speed, there, row.lower_impulse, biased, step)
        row.lower_impulse += change
        row.lower_given += kept * row.lower_impulse
        impulse = impulse + change
        speed = speed + inverse * change
        change = limit_change(row.upper - value, -speed, there, row.upper_impulse, biased, step)
        row.upper_impulse += change
        row.upper_given += kept * row.upper_impulse
        impulse = impulse - change
    return impulse


@kernel
def store_impulses(first, last, slots, springs, motors, limits, free, step):
    """Keeps the impulses, as for a whole step, and what was given."""
    for k in range(first, last):
        if springs is not None:
            part, s = at(free, numbers_at(slots, springs, k)), at(springs, k)
            part.spring_impulse = s.impulse * step.parts
            part.spring_given = s.given
        if motors is not None:
            part, m = at(free, numbers_at(slots, motors, k)), at(motors, k)
            part.motor_impulse = m.impulse * step.parts
            part.motor_given = m.given
        if limits is not None:
            part, row = at(free, numbers_at(slots, limits, k)), at(limits, k)
            part.lower_impulse = row.lower_impulse * step.parts
            part.upper_impulse = row.upper_impulse * step.parts
            part.lower_given = row.lower_given
            part.upper_given = row.upper_given
