"""The normal part of contacts: damped springs that push bodies out of each other, and never pull."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const, maximum, over, select
from engine.vec2 import Vec2, cross, dot, rotate, spin


@kernel
def mass_along(inverse_mass, inverse_inertia1, inverse_inertia2, r1, r2, direction):
    """Mass that an impulse along a unit direction feels: 1 / (1/m1 + 1/m2 + (r1 x d)^2/I1 + (r2 x d)^2/I2) [kg]."""
    arm1 = cross(r1, direction)
    arm2 = cross(r2, direction)
    inverse = inverse_mass + inverse_inertia1 * arm1 * arm1 + inverse_inertia2 * arm2 * arm2
    return over(const(1.0, inverse), inverse)


@kernel
def prepare(total, arbiters, contacts, motions, constraints, steps):
    """Writes a constraint for each arbiter that touches. Returns how many there are."""
    step = steps[0]
    count = 0
    for k in range(total):
        arbiter = arbiters[k]
        if arbiter.count == 0:
            continue
        constraint = constraints[count]
        count += 1
        motion1 = motions[arbiter.body1]
        motion2 = motions[arbiter.body2]
        m1, i1 = motion1.inverse_mass, motion1.inverse_inertia
        m2, i2 = motion2.inverse_mass, motion2.inverse_inertia
        zero = const(0.0, m1)
        constraint.body1 = arbiter.body1
        constraint.body2 = arbiter.body2
        constraint.arbiter = k
        constraint.nx = arbiter.nx
        constraint.ny = arbiter.ny
        constraint.inverse_mass1 = m1
        constraint.inverse_inertia1 = i1
        constraint.inverse_mass2 = m2
        constraint.inverse_inertia2 = i2
        if m1 == zero or m2 == zero:
            constraint.bias_rate = step.static_bias_rate
            constraint.mass_scale = step.static_mass_scale
            constraint.impulse_scale = step.static_impulse_scale
        else:
            constraint.bias_rate = step.contact_bias_rate
            constraint.mass_scale = step.contact_mass_scale
            constraint.impulse_scale = step.contact_impulse_scale
        normal = Vec2(arbiter.nx, arbiter.ny)
        first = contacts[k, 0]
        r1 = Vec2(first.r1_x, first.r1_y)
        r2 = Vec2(first.r2_x, first.r2_y)
        constraint.a_r1_x, constraint.a_r1_y = r1.x, r1.y
        constraint.a_r2_x, constraint.a_r2_y = r2.x, r2.y
        constraint.a_separation = first.separation - dot(r2 - r1, normal)
        constraint.a_mass = mass_along(m1 + m2, i1, i2, r1, r2, normal)
        constraint.a_impulse = first.normal_impulse * step.carried
        constraint.a_given = zero
        constraint.b_given = zero
        if arbiter.count > 1:
            second = contacts[k, 1]
            r1 = Vec2(second.r1_x, second.r1_y)
            r2 = Vec2(second.r2_x, second.r2_y)
            constraint.b_r1_x, constraint.b_r1_y = r1.x, r1.y
            constraint.b_r2_x, constraint.b_r2_y = r2.x, r2.y
            constraint.b_separation = second.separation - dot(r2 - r1, normal)
            constraint.b_mass = mass_along(m1 + m2, i1, i2, r1, r2, normal)
            constraint.b_impulse = second.normal_impulse * step.carried
        else:
            constraint.b_r1_x, constraint.b_r1_y = r1.x, r1.y
            constraint.b_r2_x, constraint.b_r2_y = r2.x, r2.y
            constraint.b_separation = constraint.a_separation
            constraint.b_mass = zero
            constraint.b_impulse = zero
    return count


@kernel
def approach(v1, w1, v2, w2, r1, r2, direction):
    """Speed of the contact point of body2 over that of body1, along a direction [m/s]."""
    return dot((v2 + spin(w2, r2)) - (v1 + spin(w1, r1)), direction)


@kernel
def separation_now(d1, q1, d2, q2, r1, r2, normal, separation):
    """The separation after the bodies moved since the step began [m]."""
    return dot((d2 - d1) + (rotate(q2, r2) - rotate(q1, r1)), normal) + separation


@kernel
def biased_change(speed, s, mass, impulse, bias_rate, mass_scale, impulse_scale, push_out, inverse_h):
    """The impulse to add: of the spring where shapes overlap; where they are apart, what lets them just meet [N s]."""
    zero = const(0.0, s)
    apart = s > zero
    bias = select(apart, s * inverse_h, maximum(bias_rate * s, -push_out))
    scale = select(apart, const(1.0, s), mass_scale)
    give = select(apart, zero, impulse_scale)
    total = maximum(impulse - mass * scale * (speed + bias) - give * impulse, zero)
    return select(mass > zero, total - impulse, zero)


@kernel
def relaxed_change(speed, s, mass, impulse, inverse_h):
    """The impulse to add so that bodies neither approach nor part, less what the spring gave too much [N s]."""
    zero = const(0.0, s)
    bias = select(s > zero, s * inverse_h, zero)
    return maximum(impulse - mass * (speed + bias), zero) - impulse


@kernel
def warm_start(constraints, count, movers):
    """Gives the bodies the normal impulses of the substep before."""
    for k in range(count):
        c = constraints[k]
        mover1 = movers[c.body1]
        mover2 = movers[c.body2]
        normal = Vec2(c.nx, c.ny)
        push_a = normal * c.a_impulse
        push_b = normal * c.b_impulse
        push = push_a + push_b
        turn1 = cross(Vec2(c.a_r1_x, c.a_r1_y), push_a) + cross(Vec2(c.b_r1_x, c.b_r1_y), push_b)
        turn2 = cross(Vec2(c.a_r2_x, c.a_r2_y), push_a) + cross(Vec2(c.b_r2_x, c.b_r2_y), push_b)
        mover1.vx -= c.inverse_mass1 * push.x
        mover1.vy -= c.inverse_mass1 * push.y
        mover1.w -= c.inverse_inertia1 * turn1
        mover2.vx += c.inverse_mass2 * push.x
        mover2.vy += c.inverse_mass2 * push.y
        mover2.w += c.inverse_inertia2 * turn2


@kernel
def store_impulses(constraints, count, contacts, arbiters, steps):
    """Keeps for the next step, and for whoever asks, what the contacts gave; friction adds its own."""
    parts = steps[0].parts
    zero = const(0.0, parts)
    for k in range(count):
        c = constraints[k]
        index = c.arbiter
        first = contacts[index, 0]
        first.normal_impulse = c.a_impulse * parts
        first.given_normal = c.a_given
        first.tangent_impulse = zero
        first.given_tangent = zero
        if arbiters[index].count > 1:
            second = contacts[index, 1]
            second.normal_impulse = c.b_impulse * parts
            second.given_normal = c.b_given
            second.tangent_impulse = zero
            second.given_tangent = zero
