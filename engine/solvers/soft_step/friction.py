"""The sideways part of contacts: friction, and belts that run."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const
from engine.solvers.soft_step.contacts import mass_along
from engine.vec2 import Vec2, cross, right_of


@kernel
def prepare(constraints, count, arbiters, contacts, frictions, steps):
    """Writes the sideways part of each constraint."""
    step = steps[0]
    for k in range(count):
        c = constraints[k]
        f = frictions[k]
        arbiter = arbiters[c.arbiter]
        tangent = right_of(Vec2(c.nx, c.ny))
        f.friction = arbiter.friction
        m = c.inverse_mass1 + c.inverse_mass2
        i1, i2 = c.inverse_inertia1, c.inverse_inertia2
        zero = const(0.0, m)
        f.a_mass = mass_along(m, i1, i2, Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y), tangent)
        f.a_impulse = contacts[c.arbiter, 0].tangent_impulse * step.carried
        f.a_given = zero
        f.b_given = zero
        f.b_mass = zero
        f.b_impulse = zero
        if arbiter.count > 1:
            f.b_mass = mass_along(m, i1, i2, Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y), tangent)
            f.b_impulse = contacts[c.arbiter, 1].tangent_impulse * step.carried


@kernel
def prepare_belts(constraints, count, arbiters, belts, tangent_speed):
    """Surfaces run clockwise round their shapes: the top of a floor to the right, the bottom of a box to the left."""
    for k in range(count):
        arbiter = arbiters[constraints[k].arbiter]
        belts[k].speed = tangent_speed[arbiter.shape1] + tangent_speed[arbiter.shape2]


@kernel
def warm_start(constraints, frictions, count, movers):
    """Gives the bodies the tangent impulses of the substep before."""
    for k in range(count):
        c = constraints[k]
        f = frictions[k]
        mover1 = movers[c.body1]
        mover2 = movers[c.body2]
        tangent = right_of(Vec2(c.nx, c.ny))
        push_a = tangent * f.a_impulse
        push_b = tangent * f.b_impulse
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
def change(speed, mass, impulse, limit):
    """The impulse to add so that the surfaces do not slide, within the cone |P_t| <= mu P_n [N s]."""
    return clamp(impulse - mass * speed, -limit, limit) - impulse


@kernel
def store_impulses(constraints, frictions, count, contacts, arbiters, steps):
    """Keeps the tangent impulses."""
    parts = steps[0].parts
    for k in range(count):
        c = constraints[k]
        f = frictions[k]
        first = contacts[c.arbiter, 0]
        first.tangent_impulse = f.a_impulse * parts
        first.given_tangent = f.a_given
        if arbiters[c.arbiter].count > 1:
            second = contacts[c.arbiter, 1]
            second.tangent_impulse = f.b_impulse * parts
            second.given_tangent = f.b_given
