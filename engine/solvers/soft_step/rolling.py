"""Rolling resistance: a moment against the turning of round shapes on each other, bounded by load and radius."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, over


@kernel
def prepare(constraints, count, arbiters, shapes, coefficients, rollings, steps):
    """Writes the turning part of each constraint: of two shapes the one that resists more counts."""
    step = steps[0]
    for k in range(count):
        c = constraints[k]
        row = rollings[k]
        arbiter = arbiters[c.arbiter]
        lane = c.nx
        reach1 = const(coefficients[arbiter.shape1] * shapes[arbiter.shape1].radius, lane)
        reach2 = const(coefficients[arbiter.shape2] * shapes[arbiter.shape2].radius, lane)
        inverse = c.inverse_inertia1 + c.inverse_inertia2
        row.reach = maximum(reach1, reach2)
        row.mass = over(const(1.0, lane), inverse)
        row.impulse = arbiter.rolling_impulse * step.carried


@kernel
def warm_start(constraints, rollings, count, movers):
    """Gives the bodies the turning impulses of the substep before."""
    for k in range(count):
        c = constraints[k]
        movers[c.body1].w -= c.inverse_inertia1 * rollings[k].impulse
        movers[c.body2].w += c.inverse_inertia2 * rollings[k].impulse


@kernel
def change(spin, mass, impulse, limit):
    """The impulse to add so that the bodies do not turn on each other, |P_r| <= reach P_n [N m s]."""
    return clamp(impulse - mass * spin, -limit, limit) - impulse


@kernel
def store_impulses(constraints, rollings, count, arbiters, steps):
    """Keeps the turning impulses."""
    parts = steps[0].parts
    for k in range(count):
        arbiters[constraints[k].arbiter].rolling_impulse = rollings[k].impulse * parts
