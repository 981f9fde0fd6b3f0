"""The two passes over all contacts in a substep: one that pushes overlap out, and one that takes the push back.

The first may leave bodies with the speed at which they part; positions follow that speed, and the second pass (relax)
then removes it from the velocities, so that no energy is made of overlap. Friction acts in the second, when the normal
impulses are those that really hold the bodies.
"""

from __future__ import annotations

from engine.jit import kernel
from engine.solvers.soft_step import friction, rolling
from engine.solvers.soft_step.contacts import approach, biased_change, relaxed_change, separation_now
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2, cross, right_of


@kernel
def solve_biased(constraints, count, movers, push_out, inverse_h):
    """One pass over the normal parts, with bias."""
    for k in range(count):
        c = constraints[k]
        m1 = movers[c.body1]
        m2 = movers[c.body2]
        a = load(m1)
        b = load(m2)
        normal = Vec2(c.nx, c.ny)
        v1, w1, v2, w2 = a.v, a.w, b.v, b.w

        r1, r2 = Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y)
        s = separation_now(a.d, a.q, b.d, b.q, r1, r2, normal, c.a_separation)
        speed = approach(v1, w1, v2, w2, r1, r2, normal)
        change = biased_change(
            speed, s, c.a_mass, c.a_impulse, c.bias_rate, c.mass_scale, c.impulse_scale, push_out, inverse_h
        )  # fmt: skip
        c.a_impulse += change
        push = normal * change
        v1, w1 = v1 - push * c.inverse_mass1, w1 - c.inverse_inertia1 * cross(r1, push)
        v2, w2 = v2 + push * c.inverse_mass2, w2 + c.inverse_inertia2 * cross(r2, push)

        r1, r2 = Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y)
        s = separation_now(a.d, a.q, b.d, b.q, r1, r2, normal, c.b_separation)
        speed = approach(v1, w1, v2, w2, r1, r2, normal)
        change = biased_change(
            speed, s, c.b_mass, c.b_impulse, c.bias_rate, c.mass_scale, c.impulse_scale, push_out, inverse_h
        )  # fmt: skip
        c.b_impulse += change
        push = normal * change
        v1, w1 = v1 - push * c.inverse_mass1, w1 - c.inverse_inertia1 * cross(r1, push)
        v2, w2 = v2 + push * c.inverse_mass2, w2 + c.inverse_inertia2 * cross(r2, push)
        store(m1, v1, w1)
        store(m2, v2, w2)


@kernel
def relax(constraints, frictions, belts, rollings, count, movers, inverse_h):
    """One pass without bias. frictions, belts, rollings: None where the effect is not called for."""
    for k in range(count):
        c = constraints[k]
        m1 = movers[c.body1]
        m2 = movers[c.body2]
        a = load(m1)
        b = load(m2)
        normal = Vec2(c.nx, c.ny)
        v1, w1, v2, w2 = a.v, a.w, b.v, b.w
        im1, im2 = c.inverse_mass1, c.inverse_mass2
        ii1, ii2 = c.inverse_inertia1, c.inverse_inertia2
        ra1, ra2 = Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y)
        rb1, rb2 = Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y)

        s = separation_now(a.d, a.q, b.d, b.q, ra1, ra2, normal, c.a_separation)
        change = relaxed_change(approach(v1, w1, v2, w2, ra1, ra2, normal), s, c.a_mass, c.a_impulse, inverse_h)
        c.a_impulse += change
        push = normal * change
        v1, w1 = v1 - push * im1, w1 - ii1 * cross(ra1, push)
        v2, w2 = v2 + push * im2, w2 + ii2 * cross(ra2, push)

        s = separation_now(a.d, a.q, b.d, b.q, rb1, rb2, normal, c.b_separation)
        change = relaxed_change(approach(v1, w1, v2, w2, rb1, rb2, normal), s, c.b_mass, c.b_impulse, inverse_h)
        c.b_impulse += change
        push = normal * change
        v1, w1 = v1 - push * im1, w1 - ii1 * cross(rb1, push)
        v2, w2 = v2 + push * im2, w2 + ii2 * cross(rb2, push)

        if frictions is not None:
            f = frictions[k]
            tangent = right_of(normal)
            speed = approach(v1, w1, v2, w2, ra1, ra2, tangent)
            if belts is not None:
                speed = speed - belts[k].speed
            change = friction.change(speed, f.a_mass, f.a_impulse, f.friction * c.a_impulse)
            f.a_impulse += change
            push = tangent * change
            v1, w1 = v1 - push * im1, w1 - ii1 * cross(ra1, push)
            v2, w2 = v2 + push * im2, w2 + ii2 * cross(ra2, push)

            speed = approach(v1, w1, v2, w2, rb1, rb2, tangent)
            if belts is not None:
                speed = speed - belts[k].speed
            change = friction.change(speed, f.b_mass, f.b_impulse, f.friction * c.b_impulse)
            f.b_impulse += change
            push = tangent * change
            v1, w1 = v1 - push * im1, w1 - ii1 * cross(rb1, push)
            v2, w2 = v2 + push * im2, w2 + ii2 * cross(rb2, push)

        if rollings is not None:
            r = rollings[k]
            turn = rolling.change(w2 - w1, r.mass, r.impulse, r.reach * (c.a_impulse + c.b_impulse))
            r.impulse += turn
            w1 = w1 - ii1 * turn
            w2 = w2 + ii2 * turn

        store(m1, v1, w1)
        store(m2, v2, w2)


@kernel
def add_given(constraints, frictions, count):
    """Sums up what a substep gave."""
    for k in range(count):
        constraints[k].a_given += constraints[k].a_impulse
        constraints[k].b_given += constraints[k].b_impulse
        if frictions is not None:
            frictions[k].a_given += frictions[k].a_impulse
            frictions[k].b_given += frictions[k].b_impulse
