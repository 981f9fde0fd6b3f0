"""The sideways part of contacts: friction, and belts that run."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const, select
from engine.rows import at, load_row, numbers_at, pick
from engine.solvers.soft_step.contacts import mass_along
from engine.vec2 import Vec2, right_of


@kernel
def prepare(first, last, slots, constraints, arbiters, contacts, frictions, step):
    """Writes the sideways part of each constraint."""
    for k in range(first, last):
        index = numbers_at(slots, constraints, k)
        c = at(constraints, k)
        f = at(frictions, k)
        tangent = right_of(Vec2(c.nx, c.ny))
        m = c.inverse_mass1 + c.inverse_mass2
        i1, i2 = c.inverse_inertia1, c.inverse_inertia2
        zero = const(0.0, m)
        there = at(arbiters, index).count > 1
        _, _, mu, _, _, _, _, _ = load_row(arbiters, index)
        f.friction = mu
        f.a_mass = mass_along(m, i1, i2, Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y), tangent)
        _, _, _, _, _, _, _, impulse = load_row(contacts, index, 0)
        f.a_impulse = impulse * step.carried
        f.a_given = zero
        mass = mass_along(m, i1, i2, Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y), tangent)
        f.b_mass = select(there, mass, zero)
        _, _, _, _, _, _, _, impulse = load_row(contacts, index, 1)
        f.b_impulse = select(there, impulse * step.carried, zero)
        f.b_given = zero


@kernel
def prepare_belts(first, last, slots, constraints, arbiters, belts, tangent_speed):
    """Surfaces run clockwise round their shapes: the top of a floor to the right, the bottom of a box to the left."""
    for k in range(first, last):
        arbiter = at(arbiters, numbers_at(slots, constraints, k))
        speed = pick(tangent_speed, arbiter.shape1) + pick(tangent_speed, arbiter.shape2)
        at(belts, k).speed = const(speed, at(constraints, k).nx)


@kernel
def change(speed, mass, impulse, limit):
    """The impulse to add so that the surfaces do not slide, within the cone |P_t| <= mu P_n [N s]."""
    return clamp(impulse - mass * speed, -limit, limit) - impulse
