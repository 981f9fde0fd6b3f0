"""The normal part of contacts: damped springs that push bodies out of each other, and never pull."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, maximum, over, select
from engine.rows import at, load_row, numbers_at, store_row
from engine.vec2 import Vec2, choose, cross, dot, rotate, spin

FIRST_IMPULSE = 6  # normal_impulse among the numbers of a contact's row: then come tangent_impulse and what was given


@kernel
def mass_along(inverse_mass, inverse_inertia1, inverse_inertia2, r1, r2, direction):
    """Mass that an impulse along a unit direction feels: 1 / (1/m1 + 1/m2 + (r1 x d)^2/I1 + (r2 x d)^2/I2) [kg]."""
    arm1 = cross(r1, direction)
    arm2 = cross(r2, direction)
    inverse = inverse_mass + inverse_inertia1 * arm1 * arm1 + inverse_inertia2 * arm2 * arm2
    return over(const(1.0, inverse), inverse)


@kernel
def prepare(first, last, slots, arbiters, contacts, motions, constraints, step):
    """Writes the constraints of the arbiters in `slots`; that of no arbiter has no mass, and gives nothing."""
    for k in range(first, last):
        index = numbers_at(slots, constraints, k)
        c = at(constraints, k)
        arbiter = at(arbiters, index)
        body1, body2 = arbiter.body1, arbiter.body2
        _, _, _, m1, i1, _, _, _ = load_row(motions, body1)
        _, _, _, m2, i2, _, _, _ = load_row(motions, body2)
        nx, ny, _, _, _, _, _, _ = load_row(arbiters, index)
        normal = Vec2(nx, ny)
        c.body1, c.body2 = body1, body2
        c.nx, c.ny = nx, ny
        c.inverse_mass1, c.inverse_inertia1 = m1, i1
        c.inverse_mass2, c.inverse_inertia2 = m2, i2
        zero = const(0.0, m1)

        r1_x, r1_y, r2_x, r2_y, separation, _, impulse, _ = load_row(contacts, index, 0)
        r1, r2 = Vec2(r1_x, r1_y), Vec2(r2_x, r2_y)
        c.a_r1_x, c.a_r1_y = r1.x, r1.y
        c.a_r2_x, c.a_r2_y = r2.x, r2.y
        c.a_separation = separation - dot(r2 - r1, normal)
        c.a_mass = mass_along(m1 + m2, i1, i2, r1, r2, normal)
        c.a_impulse = impulse * step.carried
        c.a_given = zero

        there = arbiter.count > 1  # the second point; where it is not, the first stands for it, without mass
        r1_x, r1_y, r2_x, r2_y, separation, _, impulse, _ = load_row(contacts, index, 1)
        r1, r2 = choose(there, Vec2(r1_x, r1_y), r1), choose(there, Vec2(r2_x, r2_y), r2)
        c.b_r1_x, c.b_r1_y = r1.x, r1.y
        c.b_r2_x, c.b_r2_y = r2.x, r2.y
        c.b_separation = separation - dot(r2 - r1, normal)
        c.b_mass = select(there, mass_along(m1 + m2, i1, i2, r1, r2, normal), zero)
        c.b_impulse = select(there, impulse * step.carried, zero)
        c.b_given = zero


class Softness(NamedTuple):
    """How contacts give way; see softness.py."""

    bias_rate: Any
    mass_scale: Any
    impulse_scale: Any


@kernel
def softness_of(inverse_mass1, inverse_mass2, step):
    """Contacts with what no impulse moves are stiffer than others."""
    zero = const(0.0, inverse_mass1)
    held = (inverse_mass1 == zero) | (inverse_mass2 == zero)
    return Softness(
        select(held, step.static_bias_rate, step.contact_bias_rate),
        select(held, step.static_mass_scale, step.contact_mass_scale),
        select(held, step.static_impulse_scale, step.contact_impulse_scale),
    )


class Arms(NamedTuple):
    """Where a contact is from the centres of mass of its two bodies, as the step began [m]."""

    r1: Vec2
    r2: Vec2


class Speeds(NamedTuple):
    """How two bodies move [m/s], [rad/s]."""

    v1: Vec2
    w1: Any
    v2: Vec2
    w2: Any


@kernel
def arms_a(c):
    """The arms of a constraint's first point."""
    return Arms(Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y))


@kernel
def arms_b(c):
    """And of its second."""
    return Arms(Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y))


@kernel
def approach(speeds, arms, direction):
    """Speed of the contact point of body2 over that of body1, along a direction [m/s]."""
    return dot((speeds.v2 + spin(speeds.w2, arms.r2)) - (speeds.v1 + spin(speeds.w1, arms.r1)), direction)


@kernel
def pushed(speeds, c, arms, push):
    """The speeds after an impulse at a contact, on body2, and against it on body1 [N s]."""
    return Speeds(
        speeds.v1 - push * c.inverse_mass1,
        speeds.w1 - c.inverse_inertia1 * cross(arms.r1, push),
        speeds.v2 + push * c.inverse_mass2,
        speeds.w2 + c.inverse_inertia2 * cross(arms.r2, push),
    )


@kernel
def separation_now(mover1, mover2, arms, normal, separation):
    """The separation after the bodies moved since the step began [m]."""
    turned = rotate(mover2.q, arms.r2) - rotate(mover1.q, arms.r1)
    return dot((mover2.d - mover1.d) + turned, normal) + separation


@kernel
def biased_change(speed, s, mass, impulse, soft, step):
    """The impulse to add: of the spring where shapes overlap; where they are apart, what lets them just meet [N s]."""
    zero = const(0.0, s)
    apart = s > zero
    bias = select(apart, s * step.inverse_h, maximum(soft.bias_rate * s, -step.push_out_speed))
    scale = select(apart, const(1.0, s), soft.mass_scale)
    give = select(apart, zero, soft.impulse_scale)
    total = maximum(impulse - mass * scale * (speed + bias) - give * impulse, zero)
    return select(mass > zero, total - impulse, zero)


@kernel
def relaxed_change(speed, s, mass, impulse, inverse_h):
    """The impulse to add so that bodies neither approach nor part, less what the spring gave too much [N s]."""
    zero = const(0.0, s)
    bias = select(s > zero, s * inverse_h, zero)
    return maximum(impulse - mass * (speed + bias), zero) - impulse


@kernel
def store_impulses(first, last, slots, constraints, frictions, rollings, arbiters, contacts, step):
    """Keeps for the next step, and for whoever asks, what the contacts gave."""
    for k in range(first, last):
        index = numbers_at(slots, constraints, k)
        c = at(constraints, k)
        zero = const(0.0, c.nx)
        a_tangent, a_given, b_tangent, b_given = zero, zero, zero, zero
        if frictions is not None:
            f = at(frictions, k)
            a_tangent, a_given = f.a_impulse * step.parts, f.a_given
            b_tangent, b_given = f.b_impulse * step.parts, f.b_given
        store_row(contacts, index, (c.a_impulse * step.parts, a_tangent, c.a_given, a_given), 0, FIRST_IMPULSE)
        store_row(contacts, index, (c.b_impulse * step.parts, b_tangent, c.b_given, b_given), 1, FIRST_IMPULSE)
        if rollings is not None:
            at(arbiters, index).rolling_impulse = at(rollings, k).impulse * step.parts
