"""Rolling resistance: a moment against the turning of round shapes on each other, bounded by load and radius."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const, maximum, over
from engine.rows import at, numbers_at, pick


@kernel
def prepare(first, last, slots, constraints, arbiters, shapes, coefficients, rollings, step):
    """Writes the turning part of each constraint: of two shapes the one that resists more counts."""
    for k in range(first, last):
        c = at(constraints, k)
        row = at(rollings, k)
        arbiter = at(arbiters, numbers_at(slots, constraints, k))
        lane = c.nx
        reach1 = const(pick(coefficients, arbiter.shape1) * at(shapes, arbiter.shape1).radius, lane)
        reach2 = const(pick(coefficients, arbiter.shape2) * at(shapes, arbiter.shape2).radius, lane)
        row.reach = maximum(reach1, reach2)
        row.mass = over(const(1.0, lane), c.inverse_inertia1 + c.inverse_inertia2)
        row.impulse = arbiter.rolling_impulse * step.carried


@kernel
def change(spin, mass, impulse, limit):
    """The impulse to add so that the bodies do not turn on each other, |P_r| <= reach P_n [N m s]."""
    return clamp(impulse - mass * spin, -limit, limit) - impulse
