"""Bouncing: once a step, after all substeps, so that nothing gains from being solved twice."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const, holds_somewhere, maximum, select
from engine.mixing import mix
from engine.rows import at, numbers_at, pick
from engine.solvers.soft_step.contacts import Speeds, approach, arms_a, arms_b, pushed
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2

VISITS = 8
"""Of the two points of a pair. One only: a box that falls flat tumbles, and a capsule jumps higher than it fell. With
each, what is left shrinks by the square of (1/m - a^2/I) / (1/m + a^2/I), a being half of their distance."""


@kernel
def prepare(first, last, slots, constraints, arbiters, coefficients, rule, motions, bounces):
    """Notes how fast the shapes approach before anything is solved."""
    for k in range(first, last):
        c = at(constraints, k)
        row = at(bounces, k)
        arbiter = at(arbiters, numbers_at(slots, constraints, k))
        mixed = mix(rule, pick(coefficients, arbiter.shape1), pick(coefficients, arbiter.shape2))
        row.restitution = const(mixed, c.nx)
        m1 = at(motions, c.body1)
        m2 = at(motions, c.body2)
        speeds, normal = Speeds(Vec2(m1.vx, m1.vy), m1.w, Vec2(m2.vx, m2.vy), m2.w), Vec2(c.nx, c.ny)
        row.a_speed = approach(speeds, arms_a(c), normal)
        row.b_speed = approach(speeds, arms_b(c), normal)


@kernel
def bounces_at(row_restitution, before, given, threshold):
    """Whether shapes met at a point faster than the threshold, and are of a kind that bounces."""
    zero = const(0.0, before)
    return (row_restitution > zero) & (before < -threshold) & (given > zero)


@kernel
def change(bounces, speed, before, restitution, mass, impulse):
    """The impulse to add so that shapes that met part with e times that speed [N s]."""
    zero = const(0.0, speed)
    total = maximum(impulse - mass * (speed + restitution * before), zero)
    return select(bounces, total - impulse, zero)


@kernel
def apply(first, last, constraints, bounces, movers, step):
    """One pass over all contacts; the two points of one pair are visited in turn until they agree."""
    for k in range(first, last):
        c = at(constraints, k)
        row = at(bounces, k)
        e = row.restitution
        bounces_a = bounces_at(e, row.a_speed, c.a_given, step.restitution_threshold)
        bounces_b = bounces_at(e, row.b_speed, c.b_given, step.restitution_threshold)
        if not holds_somewhere(bounces_a | bounces_b):
            continue
        m1 = load(movers, c.body1)
        m2 = load(movers, c.body2)
        normal, first_arms, second_arms = Vec2(c.nx, c.ny), arms_a(c), arms_b(c)
        speeds = Speeds(m1.v, m1.w, m2.v, m2.w)
        for _ in range(VISITS):
            more = change(bounces_a, approach(speeds, first_arms, normal), row.a_speed, e, c.a_mass, c.a_impulse)
            c.a_impulse += more
            c.a_given += more
            speeds = pushed(speeds, c, first_arms, normal * more)
            more = change(bounces_b, approach(speeds, second_arms, normal), row.b_speed, e, c.b_mass, c.b_impulse)
            c.b_impulse += more
            c.b_given += more
            speeds = pushed(speeds, c, second_arms, normal * more)
        store(movers, c.body1, speeds.v1, speeds.w1, m1.turned)
        store(movers, c.body2, speeds.v2, speeds.w2, m2.turned)
