"""How body2 turns over body1, where springs, motors or limits act on it (free.py): rate w2 - w1, mass 1/(1/I1 + 1/I2).

A point that the joint holds besides is taken for free: its own rows come after these in every pass, and both agree as
the passes go on.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import const, over
from engine.rows import at, numbers_at
from engine.solvers.soft_step.joints import free
from engine.solvers.soft_step.joints.frames import write_bodies
from engine.solvers.soft_step.movers import load, store
from engine.tables import REALS


@cache
def turn_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        "inverse_mass1", "inverse_inertia1", "inverse_mass2", "inverse_inertia2",
        "mass",  # of the turning [kg m^2]
        "angle",  # of body2 over body1, now [rad]
        "angle_before",  # as the step began
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows):
    """Writes the rows as the step begins."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        row = at(rows, k)
        frame = write_bodies(row, joint, bodies, motions)
        row.mass = over(const(1.0, frame.angle), row.inverse_inertia1 + row.inverse_inertia2)
        row.angle_before = frame.angle
        row.angle = frame.angle


@kernel
def refresh(first, last, rows, movers):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = at(rows, k)
        row.angle = row.angle_before + (load(movers, row.body2).turned - load(movers, row.body1).turned)


@kernel
def push(row, movers, a, b, turn):
    """Gives body2 an impulse that turns it, and body1 the other way."""
    store(movers, row.body1, a.v, a.w - row.inverse_inertia1 * turn, a.turned)
    store(movers, row.body2, b.v, b.w + row.inverse_inertia2 * turn, b.turned)


@kernel
def warm_start(first, last, rows, springs, motors, limits, movers):
    """Gives the bodies the impulses of the substep before. Here and below a table is None that no joint calls for."""
    for k in range(first, last):
        row = at(rows, k)
        turn = free.carried(const(0.0, row.mass), springs, motors, limits, k)
        push(row, movers, load(movers, row.body1), load(movers, row.body2), turn)


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
        inverse = row.inverse_inertia1 + row.inverse_inertia2
        turn = free.solve(
            row.angle, b.w - a.w, inverse, row.mass, springs, motors, limits, k, biased, kept, step
        )  # fmt: skip
        push(row, movers, a, b, turn)
