"""Bouncing: once a step, after all substeps, so that nothing gains from being solved twice."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const, maximum, select
from engine.mixing import mix
from engine.solvers.soft_step.contacts import approach
from engine.solvers.soft_step.movers import store
from engine.vec2 import Vec2, cross

VISITS = 8
"""Of the two points of a pair. One only: a box that falls flat tumbles, and a capsule jumps higher than it fell. With
each, what is left shrinks by the square of (1/m - a^2/I) / (1/m + a^2/I), a being half of their distance."""


@kernel
def prepare(constraints, count, arbiters, coefficients, rule, movers, restitutions):
    """Notes how fast the shapes approach before anything is solved."""
    for k in range(count):
        c = constraints[k]
        row = restitutions[k]
        arbiter = arbiters[c.arbiter]
        row.restitution = const(mix(rule, coefficients[arbiter.shape1], coefficients[arbiter.shape2]), c.nx)
        m1 = movers[c.body1]
        m2 = movers[c.body2]
        v1, v2, normal = Vec2(m1.vx, m1.vy), Vec2(m2.vx, m2.vy), Vec2(c.nx, c.ny)
        row.a_speed = approach(
            v1, m1.w, v2, m2.w, Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y), normal
        )  # fmt: skip
        row.b_speed = approach(
            v1, m1.w, v2, m2.w, Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y), normal
        )  # fmt: skip


@kernel
def change(speed, before, restitution, mass, impulse, given, threshold):
    """The impulse to add so that shapes that met faster than the threshold part with e times that speed [N s].

    Only where they did meet (given > 0), and none at all where e is zero.
    """
    zero = const(0.0, speed)
    total = maximum(impulse - mass * (speed + restitution * before), zero)
    bounces = (restitution > zero) & (before < -threshold) & (given > zero)
    return select(bounces, total - impulse, zero)


@kernel
def apply(constraints, restitutions, count, movers, steps):
    """One pass over all contacts; the two points of one pair are visited in turn until they agree."""
    threshold = steps[0].restitution_threshold
    for k in range(count):
        c = constraints[k]
        row = restitutions[k]
        m1 = movers[c.body1]
        m2 = movers[c.body2]
        normal = Vec2(c.nx, c.ny)
        v1, w1, v2, w2 = Vec2(m1.vx, m1.vy), m1.w, Vec2(m2.vx, m2.vy), m2.w
        ra1, ra2 = Vec2(c.a_r1_x, c.a_r1_y), Vec2(c.a_r2_x, c.a_r2_y)
        rb1, rb2 = Vec2(c.b_r1_x, c.b_r1_y), Vec2(c.b_r2_x, c.b_r2_y)
        for _ in range(VISITS):
            speed = approach(v1, w1, v2, w2, ra1, ra2, normal)
            more = change(speed, row.a_speed, row.restitution, c.a_mass, c.a_impulse, c.a_given, threshold)
            c.a_impulse += more
            c.a_given += more
            push = normal * more
            v1, w1 = v1 - push * c.inverse_mass1, w1 - c.inverse_inertia1 * cross(ra1, push)
            v2, w2 = v2 + push * c.inverse_mass2, w2 + c.inverse_inertia2 * cross(ra2, push)
            speed = approach(v1, w1, v2, w2, rb1, rb2, normal)
            more = change(speed, row.b_speed, row.restitution, c.b_mass, c.b_impulse, c.b_given, threshold)
            c.b_impulse += more
            c.b_given += more
            push = normal * more
            v1, w1 = v1 - push * c.inverse_mass1, w1 - c.inverse_inertia1 * cross(rb1, push)
            v2, w2 = v2 + push * c.inverse_mass2, w2 + c.inverse_inertia2 * cross(rb2, push)
        store(m1, v1, w1)
        store(m2, v2, w2)
