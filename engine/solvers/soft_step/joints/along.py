"""Passes over rows along one direction, in which bodies are free but for springs, motors and limits (free.py).

A row's rate is n . (v2 - v1) + arm2 w2 - arm1 w1: of a slide along n (slide.py), or of a turn, whose n is nothing and
whose arms are 1 (turn.py).
"""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.rows import at
from engine.solvers.soft_step.joints import free
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2, dot

ALONG_FIELDS = (
    "nx", "ny",  # the direction, now
    "arm1", "arm2",  # how an impulse along it turns body1 and body2 [m]
    "inverse",  # what an impulse of 1 changes of the rate [1/kg]
    "mass",  # one over it [kg]
    "value",  # where the joint is along it, now [m]
)  # fmt: skip
"""Units of a slide; a turn has rad for m, kg m^2 for kg."""


@kernel
def push(row, movers, a, b, impulse):
    """Gives body2 an impulse along the direction, and body1 the other way."""
    along = Vec2(row.nx, row.ny) * impulse
    w1 = a.w - row.inverse_inertia1 * row.arm1 * impulse
    w2 = b.w + row.inverse_inertia2 * row.arm2 * impulse
    store(movers, row.body1, a.v - along * row.inverse_mass1, w1, a.turned)
    store(movers, row.body2, b.v + along * row.inverse_mass2, w2, b.turned)


@kernel
def warm_start(first, last, rows, springs, motors, limits, movers):
    """Gives the bodies the impulses of the substep before. Here and below a table is None that no joint calls for."""
    for k in range(first, last):
        row = at(rows, k)
        impulse = free.carried(const(0.0, row.mass), springs, motors, limits, k)
        push(row, movers, load(movers, row.body1), load(movers, row.body2), impulse)


@kernel
def forget(first, last, rows, springs, motors, limits):
    """Without warm starting each substep begins with nothing."""
    for k in range(first, last):
        free.forget(const(0.0, at(rows, k).mass), springs, motors, limits, k)


@kernel
def solve(first, last, rows, springs, motors, limits, movers, biased, kept, step):
    """One pass over the rows: with bias, or taking the push back; kept as in point.py."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        speed = dot(b.v - a.v, Vec2(row.nx, row.ny)) + (row.arm2 * b.w - row.arm1 * a.w)
        impulse = free.solve(row.value, speed, row.inverse, row.mass, springs, motors, limits, k, biased, kept, step)
        push(row, movers, a, b, impulse)
