"""Contacts of ngs: velocities as in the talk, but without a bias that pushes overlap out; then positions."""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, over
from engine.mixing import mix
from engine.rows import pick
from engine.solvers.moving import shift
from engine.solvers.sequential_impulses import effective_mass
from engine.solvers.soft_step.contacts import Arms, separation_now
from engine.solvers.soft_step.movers import load
from engine.solvers.soft_step.restitution import VISITS, bounces_at, change
from engine.tables import REALS
from engine.vec2 import Vec2, cross, dot, right_of, rotate


@cache
def bounce_dtype(precision: str) -> np.dtype:
    """What bouncing needs to know of a contact from the time before the step."""
    real = REALS[precision]
    return np.dtype([("restitution", real), ("speed", real)])  # along the normal; < 0: they approach [m/s]


@kernel
def prepare(arbiters, contacts, count, motions, points, step):
    """Effective masses, the speeds of approach that are left to what is still apart, and the impulses to start from."""
    for index in range(count):
        arbiter = arbiters[index]
        motion1, motion2 = motions[arbiter.body1], motions[arbiter.body2]
        normal = Vec2(arbiter.nx, arbiter.ny)
        tangent = right_of(normal)
        for i in range(arbiter.count):
            contact, point = contacts[index, i], points[index, i]
            r1, r2 = Vec2(contact.r1_x, contact.r1_y), Vec2(contact.r2_x, contact.r2_y)
            zero = const(0.0, contact.separation)
            point.normal_mass = effective_mass(motion1, motion2, r1, r2, normal)
            point.tangent_mass = effective_mass(motion1, motion2, r1, r2, tangent)
            point.bias = -(maximum(contact.separation, zero) * step.inverse_dt)
            point.normal_arm1, point.normal_arm2 = cross(r1, normal), cross(r2, normal)
            point.tangent_arm1, point.tangent_arm2 = cross(r1, tangent), cross(r2, tangent)
            if step.warm_starting == 0:
                contact.normal_impulse, contact.tangent_impulse = zero, zero
            contact.normal_impulse = contact.normal_impulse * step.carried
            contact.tangent_impulse = contact.tangent_impulse * step.carried
            along, across = contact.normal_impulse, contact.tangent_impulse
            impulse = normal * along + tangent * across
            motion1.vx -= motion1.inverse_mass * impulse.x
            motion1.vy -= motion1.inverse_mass * impulse.y
            motion1.w -= motion1.inverse_inertia * (point.normal_arm1 * along + point.tangent_arm1 * across)
            motion2.vx += motion2.inverse_mass * impulse.x
            motion2.vy += motion2.inverse_mass * impulse.y
            motion2.w += motion2.inverse_inertia * (point.normal_arm2 * along + point.tangent_arm2 * across)


@kernel
def store(arbiters, contacts, count):
    """Notes what was given."""
    for index in range(count):
        for i in range(arbiters[index].count):
            contacts[index, i].given_normal = contacts[index, i].normal_impulse
            contacts[index, i].given_tangent = contacts[index, i].tangent_impulse


@kernel
def correct(arbiters, contacts, count, motions, movers, slop, part, most):
    """One pass over the positions: pushes each overlap beyond the slop out by a part of it, by `most` [m] at most.

    The separation is that of the contact's two points as they have moved, so what an earlier contact of the pass did is
    seen at once: a Gauss-Seidel pass over a problem that is not linear.
    """
    for index in range(count):
        arbiter = arbiters[index]
        motion1, motion2 = motions[arbiter.body1], motions[arbiter.body2]
        m1, i1 = motion1.inverse_mass, motion1.inverse_inertia
        m2, i2 = motion2.inverse_mass, motion2.inverse_inertia
        normal = Vec2(arbiter.nx, arbiter.ny)
        for i in range(arbiter.count):
            contact = contacts[index, i]
            a, b = load(movers, arbiter.body1), load(movers, arbiter.body2)
            r1, r2 = Vec2(contact.r1_x, contact.r1_y), Vec2(contact.r2_x, contact.r2_y)
            separation = separation_now(a, b, Arms(r1, r2), normal, contact.separation - dot(r2 - r1, normal))
            wanted = clamp(part * (separation + slop), -most, const(0.0, most))
            arm1, arm2 = cross(rotate(a.q, r1), normal), cross(rotate(b.q, r2), normal)
            inverse = m1 + m2 + (i1 * arm1 * arm1 + i2 * arm2 * arm2)
            push = -over(wanted, inverse)
            one = const(1.0, push)
            shift(movers[arbiter.body1], m1, i1, normal * push, arm1 * push, -one)
            shift(movers[arbiter.body2], m2, i2, normal * push, arm2 * push, one)


@kernel
def approach(motion1, motion2, normal, arm1, arm2):
    """Speed of body2 over body1 along the normal, at a contact [m/s]."""
    moving = dot(Vec2(motion2.vx - motion1.vx, motion2.vy - motion1.vy), normal)
    return moving + (motion2.w * arm2 - motion1.w * arm1)


@kernel
def note_speeds(arbiters, contacts, count, motions, coefficients, rule, bounces):
    """How fast shapes approach before anything acts, and how much of that comes back."""
    for index in range(count):
        arbiter = arbiters[index]
        normal = Vec2(arbiter.nx, arbiter.ny)
        mixed = mix(rule, pick(coefficients, arbiter.shape1), pick(coefficients, arbiter.shape2))
        for i in range(arbiter.count):
            contact, bounce = contacts[index, i], bounces[index, i]
            arm1 = cross(Vec2(contact.r1_x, contact.r1_y), normal)
            arm2 = cross(Vec2(contact.r2_x, contact.r2_y), normal)
            bounce.restitution = const(mixed, normal.x)
            bounce.speed = approach(motions[arbiter.body1], motions[arbiter.body2], normal, arm1, arm2)


@kernel
def bounce_back(arbiters, contacts, points, bounces, count, motions, threshold):
    """One pass: what met fast enough parts with e times that speed; a pair's two points in turn until they agree."""
    for index in range(count):
        arbiter = arbiters[index]
        motion1, motion2 = motions[arbiter.body1], motions[arbiter.body2]
        normal = Vec2(arbiter.nx, arbiter.ny)
        for _ in range(VISITS):
            for i in range(arbiter.count):
                contact, point, bounce = contacts[index, i], points[index, i], bounces[index, i]
                e, before = bounce.restitution, bounce.speed
                there = bounces_at(e, before, contact.given_normal, threshold)
                arm1, arm2 = point.normal_arm1, point.normal_arm2
                speed = approach(motion1, motion2, normal, arm1, arm2)
                more = change(there, speed, before, e, point.normal_mass, contact.normal_impulse)
                contact.normal_impulse += more
                contact.given_normal += more
                motion1.vx -= motion1.inverse_mass * normal.x * more
                motion1.vy -= motion1.inverse_mass * normal.y * more
                motion1.w -= motion1.inverse_inertia * arm1 * more
                motion2.vx += motion2.inverse_mass * normal.x * more
                motion2.vy += motion2.inverse_mass * normal.y * more
                motion2.w += motion2.inverse_inertia * arm2 * more
