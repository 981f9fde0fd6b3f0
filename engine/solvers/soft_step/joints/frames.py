"""Where the anchors of a joint are: as the step begins, and as the bodies move on."""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const
from engine.origin import center_of, origin_of
from engine.rows import at
from engine.vec2 import Vec2, rotate

BODY_FIELDS = ("inverse_mass1", "inverse_inertia1", "inverse_mass2", "inverse_inertia2")
FRAME_FIELDS = ("arm1_x", "arm1_y", "arm2_x", "arm2_y", "apart_x", "apart_y")
"""Anchors from the centres of mass, and from centre to centre, as the step began [m]."""


class Anchors(NamedTuple):
    """Where a joint's anchors are now, from the centres of mass, and the way from the first to the second [m]."""

    r1: Vec2
    r2: Vec2
    way: Vec2


class Frame(NamedTuple):
    """The same as the step begins; angle: of body2 over body1, less the joint's reference [rad]."""

    arm1: Vec2
    arm2: Vec2
    apart: Vec2
    angle: Any


@kernel
def write_bodies(row, joint, bodies, motions):
    """Writes whom a row joins, and how they weigh. Returns where its anchors are as the step begins."""
    body1, body2 = at(bodies, joint.body1), at(bodies, joint.body2)
    motion1, motion2 = at(motions, joint.body1), at(motions, joint.body2)
    lane = motion1.inverse_mass
    row.body1 = const(joint.body1, row.body1)
    row.body2 = const(joint.body2, row.body2)
    row.inverse_mass1, row.inverse_inertia1 = lane, motion1.inverse_inertia
    row.inverse_mass2, row.inverse_inertia2 = motion2.inverse_mass, motion2.inverse_inertia
    arm1 = Vec2(const(joint.anchor1_x - body1.local_x, lane), const(joint.anchor1_y - body1.local_y, lane))
    arm2 = Vec2(const(joint.anchor2_x - body2.local_x, lane), const(joint.anchor2_y - body2.local_y, lane))
    origin = origin_of(body1, lane)
    return Frame(
        rotate(Vec2(motion1.cosine, motion1.sine), arm1),
        rotate(Vec2(motion2.cosine, motion2.sine), arm2),
        center_of(body2, origin, lane) - center_of(body1, origin, lane),
        const((body2.angle - body1.angle) - joint.reference_angle, lane),
    )


@kernel
def write_frame(row, frame):
    """Keeps where the anchors are as the step begins."""
    row.arm1_x, row.arm1_y = frame.arm1.x, frame.arm1.y
    row.arm2_x, row.arm2_y = frame.arm2.x, frame.arm2.y
    row.apart_x, row.apart_y = frame.apart.x, frame.apart.y


@kernel
def anchors_now(row, a, b):
    """Where the anchors are after the bodies moved as their movers say."""
    r1 = rotate(a.q, Vec2(row.arm1_x, row.arm1_y))
    r2 = rotate(b.q, Vec2(row.arm2_x, row.arm2_y))
    return Anchors(r1, r2, ((b.d - a.d) + Vec2(row.apart_x, row.apart_y)) + (r2 - r1))
