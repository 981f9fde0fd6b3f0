"""The two passes over all contacts in a substep: one that pushes overlap out, and one that takes the push back.

The first may leave bodies with the speed at which they part; positions follow that speed, and the second pass (relax)
then removes it from the velocities, so that no energy is made of overlap. Friction acts in the second, when the normal
impulses are those that really hold the bodies.
"""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.rows import at
from engine.solvers.soft_step import friction, rolling
from engine.solvers.soft_step.contacts import (
    Speeds,
    approach,
    arms_a,
    arms_b,
    biased_change,
    pushed,
    relaxed_change,
    separation_now,
    softness_of,
)  # fmt: skip
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2, cross, right_of


@kernel
def warm_start(first, last, constraints, frictions, rollings, movers):
    """Gives the bodies the impulses of the substep before. frictions, rollings: None where not called for."""
    for k in range(first, last):
        c = at(constraints, k)
        m1 = load(movers, c.body1)
        m2 = load(movers, c.body2)
        normal = Vec2(c.nx, c.ny)
        push_a = normal * c.a_impulse
        push_b = normal * c.b_impulse
        if frictions is not None:
            f = at(frictions, k)
            tangent = right_of(normal)
            push_a = push_a + tangent * f.a_impulse
            push_b = push_b + tangent * f.b_impulse
        push = push_a + push_b
        turn1 = cross(Vec2(c.a_r1_x, c.a_r1_y), push_a) + cross(Vec2(c.b_r1_x, c.b_r1_y), push_b)
        turn2 = cross(Vec2(c.a_r2_x, c.a_r2_y), push_a) + cross(Vec2(c.b_r2_x, c.b_r2_y), push_b)
        if rollings is not None:
            turn1 = turn1 + at(rollings, k).impulse
            turn2 = turn2 + at(rollings, k).impulse
        store(movers, c.body1, m1.v - push * c.inverse_mass1, m1.w - c.inverse_inertia1 * turn1, m1.turned)
        store(movers, c.body2, m2.v + push * c.inverse_mass2, m2.w + c.inverse_inertia2 * turn2, m2.turned)


@kernel
def forget(first, last, constraints, frictions, rollings):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        c = at(constraints, k)
        zero = const(0.0, c.nx)
        c.a_impulse = zero
        c.b_impulse = zero
        if frictions is not None:
            f = at(frictions, k)
            f.a_impulse = zero
            f.b_impulse = zero
        if rollings is not None:
            at(rollings, k).impulse = zero


@kernel
def solve_biased(first, last, constraints, movers, step):
    """One pass over the normal parts, with bias."""
    for k in range(first, last):
        c = at(constraints, k)
        m1 = load(movers, c.body1)
        m2 = load(movers, c.body2)
        normal = Vec2(c.nx, c.ny)
        speeds = Speeds(m1.v, m1.w, m2.v, m2.w)
        soft = softness_of(c.inverse_mass1, c.inverse_mass2, step)

        arms = arms_a(c)
        s = separation_now(m1, m2, arms, normal, c.a_separation)
        change = biased_change(approach(speeds, arms, normal), s, c.a_mass, c.a_impulse, soft, step)
        c.a_impulse += change
        speeds = pushed(speeds, c, arms, normal * change)

        arms = arms_b(c)
        s = separation_now(m1, m2, arms, normal, c.b_separation)
        change = biased_change(approach(speeds, arms, normal), s, c.b_mass, c.b_impulse, soft, step)
        c.b_impulse += change
        speeds = pushed(speeds, c, arms, normal * change)
        store(movers, c.body1, speeds.v1, speeds.w1, m1.turned)
        store(movers, c.body2, speeds.v2, speeds.w2, m2.turned)


@kernel
def relax(first, last, constraints, frictions, belts, rollings, movers, kept, step):
    """One pass without bias. frictions, belts, rollings: None where the effect is not called for.

    kept: 1 in the last pass of a substep, whose impulses are what the substep gave; 0 in others.
    """
    for k in range(first, last):
        c = at(constraints, k)
        m1 = load(movers, c.body1)
        m2 = load(movers, c.body2)
        speeds = relax_normal(c, m1, m2, kept, step)
        if frictions is not None:
            speeds = rub(c, at(frictions, k), belts, k, speeds, kept)
        w1, w2 = speeds.w1, speeds.w2
        if rollings is not None:
            r = at(rollings, k)
            turn = rolling.change(w2 - w1, r.mass, r.impulse, r.reach * (c.a_impulse + c.b_impulse))
            r.impulse += turn
            w1 = w1 - c.inverse_inertia1 * turn
            w2 = w2 + c.inverse_inertia2 * turn
        store(movers, c.body1, speeds.v1, w1, m1.turned)
        store(movers, c.body2, speeds.v2, w2, m2.turned)


@kernel
def relax_normal(c, m1, m2, kept, step):
    """The normal part of it. Returns the speeds after."""
    normal = Vec2(c.nx, c.ny)
    speeds = Speeds(m1.v, m1.w, m2.v, m2.w)
    arms = arms_a(c)
    s = separation_now(m1, m2, arms, normal, c.a_separation)
    change = relaxed_change(approach(speeds, arms, normal), s, c.a_mass, c.a_impulse, step.inverse_h)
    c.a_impulse += change
    c.a_given += kept * c.a_impulse
    speeds = pushed(speeds, c, arms, normal * change)

    arms = arms_b(c)
    s = separation_now(m1, m2, arms, normal, c.b_separation)
    change = relaxed_change(approach(speeds, arms, normal), s, c.b_mass, c.b_impulse, step.inverse_h)
    c.b_impulse += change
    c.b_given += kept * c.b_impulse
    return pushed(speeds, c, arms, normal * change)


@kernel
def rub(c, f, belts, k, speeds, kept):
    """The sideways part. belts: None where no surface runs. Returns the speeds after."""
    tangent = right_of(Vec2(c.nx, c.ny))
    arms = arms_a(c)
    speed = approach(speeds, arms, tangent)
    if belts is not None:
        speed = speed - at(belts, k).speed
    change = friction.change(speed, f.a_mass, f.a_impulse, f.friction * c.a_impulse)
    f.a_impulse += change
    f.a_given += kept * f.a_impulse
    speeds = pushed(speeds, c, arms, tangent * change)

    arms = arms_b(c)
    speed = approach(speeds, arms, tangent)
    if belts is not None:
        speed = speed - at(belts, k).speed
    change = friction.change(speed, f.b_mass, f.b_impulse, f.friction * c.b_impulse)
    f.b_impulse += change
    f.b_given += kept * f.b_impulse
    return pushed(speeds, c, arms, tangent * change)
