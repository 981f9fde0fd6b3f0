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
from engine.solvers.soft_step.joints.along import ALONG_FIELDS
from engine.solvers.soft_step.joints.frames import BODY_FIELDS, write_bodies
from engine.solvers.soft_step.movers import load
from engine.tables import REALS


@cache
def turn_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (*BODY_FIELDS, *ALONG_FIELDS, "angle_before")  # of body2 over body1 as the step began [rad]
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


@kernel
def prepare(first, last, slots, joints, bodies, motions, rows):
    """Writes the rows as the step begins."""
    for k in range(first, last):
        joint = at(joints, numbers_at(slots, rows, k))
        row = at(rows, k)
        frame = write_bodies(row, joint, bodies, motions)
        zero, one = const(0.0, frame.angle), const(1.0, frame.angle)
        row.nx, row.ny = zero, zero
        row.arm1, row.arm2 = one, one
        row.inverse = row.inverse_inertia1 + row.inverse_inertia2
        row.mass = over(one, row.inverse)
        row.angle_before = frame.angle
        row.value = frame.angle


@kernel
def refresh(first, last, rows, movers):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = at(rows, k)
        row.value = row.angle_before + (load(movers, row.body2).turned - load(movers, row.body1).turned)
