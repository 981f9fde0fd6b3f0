"""How body2's anchor slides over body1's, where springs, motors or limits act on it (free.py), or hold it.

Along an axis fixed to body1 (with d the way from anchor to anchor and n the axis, the value is n . d), or along d
itself, when the value is its length: a rod, a rope, a spring between two points. Either way the rate is
n . (v2 - v1) + w2 (r2 x n) - w1 ((r1 + d) x n); along.py has the passes.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.jit import kernel
from engine.lanes import const, over, select, sqrt
from engine.rows import at, numbers_at
from engine.solvers.soft_step.joints.along import ALONG_FIELDS
from engine.solvers.soft_step.joints.frames import BODY_FIELDS, FRAME_FIELDS, anchors_now, write_bodies, write_frame
from engine.solvers.soft_step.movers import load
from engine.tables import ALONG_WAY, REALS
from engine.vec2 import Vec2, choose, cross, dot, rotate


@cache
def slide_dtype(precision: str) -> np.dtype:
    """What a pass needs of a joint but for its two movers."""
    real = REALS[precision]
    names = (
        *BODY_FIELDS,
        *ALONG_FIELDS,
        *FRAME_FIELDS,
        "axis_x", "axis_y",  # in the world, as the step began
        "by_way",  # 1: along the way from anchor to anchor; 0: along the axis
    )  # fmt: skip
    return np.dtype([("body1", np.int32), ("body2", np.int32), *((name, real) for name in names)])


@kernel
def prepare(first, last, slots, joints, slides, bodies, motions, rows):
    """Turns anchors and axis as the step begins."""
    for k in range(first, last):
        index = numbers_at(slots, rows, k)
        joint, slide = at(joints, index), at(slides, index)
        row = at(rows, k)
        frame = write_bodies(row, joint, bodies, motions)
        write_frame(row, frame)
        motion = at(motions, joint.body1)
        lane = motion.cosine
        axis = rotate(Vec2(motion.cosine, motion.sine), Vec2(const(joint.axis_x, lane), const(joint.axis_y, lane)))
        row.axis_x, row.axis_y = axis.x, axis.y
        row.by_way = select(slide.along == ALONG_WAY, const(1.0, lane), const(0.0, lane))
        write_geometry(row, frame.arm1, frame.arm2, (frame.apart + frame.arm2) - frame.arm1, axis)


@kernel
def write_geometry(row, r1, r2, way, axis):
    """Writes value, Jacobian and effective mass. Anchors in one place are pushed apart upwards, if at all."""
    one, zero = const(1.0, axis.x), const(0.0, axis.x)
    length = sqrt(dot(way, way))
    apart = length > const(1e-9, length)
    straight = choose(apart, way * (one / select(apart, length, one)), Vec2(zero, one))
    by_way = row.by_way > zero
    n = choose(by_way, straight, axis)
    arm1, arm2 = cross(r1 + way, n), cross(r2, n)
    inverse = row.inverse_mass1 + row.inverse_mass2
    inverse = inverse + row.inverse_inertia1 * arm1 * arm1 + row.inverse_inertia2 * arm2 * arm2
    row.nx, row.ny = n.x, n.y
    row.arm1, row.arm2 = arm1, arm2
    row.inverse = inverse
    row.mass = over(one, inverse)
    row.value = select(by_way, length, dot(n, way))


@kernel
def refresh(first, last, rows, movers):
    """Brings the rows to where the bodies are."""
    for k in range(first, last):
        row = at(rows, k)
        a, b = load(movers, row.body1), load(movers, row.body2)
        now = anchors_now(row, a, b)
        write_geometry(row, now.r1, now.r2, now.way, rotate(a.q, Vec2(row.axis_x, row.axis_y)))
