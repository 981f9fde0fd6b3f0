"""How bodies move within a substep: velocities from forces, positions from velocities (symplectic Euler)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.integrate import place_origin, turn
from engine.jit import kernel
from engine.lanes import const
from engine.vec2 import Vec2, rotate


class Mover(NamedTuple):
    """A body in a pass, in lanes."""

    v: Vec2  # [m/s]
    w: Any  # [rad/s]
    d: Vec2  # way since the step began [m]
    q: Vec2  # rotation since the step began


@kernel
def load(row):
    """A mover from its row."""
    return Mover(Vec2(row.vx, row.vy), row.w, Vec2(row.dx, row.dy), Vec2(row.cosine, row.sine))


@kernel
def store(row, v, w):
    """What an impulse changes, back into the row."""
    row.vx = v.x
    row.vy = v.y
    row.w = w


@kernel
def begin(order, motions, movers):
    """All bodies as the step finds them."""
    for rank in range(len(order)):
        motion = motions[order[rank]]
        row = movers[order[rank]]
        lane = motion.vx
        row.vx = motion.vx
        row.vy = motion.vy
        row.w = motion.w
        row.turned = const(0.0, lane)
        row.dx = const(0.0, lane)
        row.dy = const(0.0, lane)
        row.cosine = const(1.0, lane)
        row.sine = const(0.0, lane)


@kernel
def integrate_velocities(dynamic, bodies, motions, movers, gravity, scales, linear, angular, step):
    """v += h (s g + F / m), then v /= 1 + h c; the same for the angular velocity.

    gravity, scales, linear, angular: None where the effect is not called for.
    """
    for k in range(len(dynamic)):
        row = dynamic[k]
        body = bodies[row]
        motion = motions[row]
        mover = movers[row]
        lane = mover.vx
        one = const(1.0, lane)
        ax = motion.inverse_mass * const(body.force_x, lane)
        ay = motion.inverse_mass * const(body.force_y, lane)
        if gravity is not None:
            pull_x = step.gravity_x
            pull_y = step.gravity_y
            if scales is not None:
                scale = const(scales[row], lane)
                pull_x = scale * pull_x
                pull_y = scale * pull_y
            ax = ax + pull_x
            ay = ay + pull_y
        vx = mover.vx + step.h * ax
        vy = mover.vy + step.h * ay
        w = mover.w + step.h * (motion.inverse_inertia * const(body.torque, lane))
        if linear is not None:
            slower = one / (one + step.h * const(linear[row], lane))
            vx = vx * slower
            vy = vy * slower
        if angular is not None:
            w = w * (one / (one + step.h * const(angular[row], lane)))
        mover.vx = vx
        mover.vy = vy
        mover.w = w


@kernel
def turned_by(q, angle):
    """The rotation q, turned on by an angle: by 2 atan(angle / 2), which is a rotation whatever the angle.

    It lags behind by angle^3 / 12, and only the separations within the step see it.
    """
    half = const(0.5, angle) * angle
    square = half * half
    one = const(1.0, angle)
    scale = one / (one + square)
    return rotate(q, Vec2((one - square) * scale, (half + half) * scale))


@kernel
def integrate_positions(moving, movers, h):
    """d += h v, and the rotation likewise."""
    for k in range(len(moving)):
        mover = movers[moving[k]]
        angle = h * mover.w
        q = turned_by(Vec2(mover.cosine, mover.sine), angle)
        mover.dx += h * mover.vx
        mover.dy += h * mover.vy
        mover.turned += angle
        mover.cosine = q.x
        mover.sine = q.y


@kernel
def finish(order, bodies, motions, movers):
    """Moves the bodies to where the substeps took them; forces are used up.

    Returns the row of the first body whose state is no longer finite, -1 if there is none.
    """
    lost = -1
    for rank in range(len(order)):
        row = order[rank]
        body = bodies[row]
        body.force_x = 0.0
        body.force_y = 0.0
        body.torque = 0.0
        if body.kind != 0:
            mover = movers[row]
            motion = motions[row]
            motion.vx = mover.vx
            motion.vy = mover.vy
            motion.w = mover.w
            body.center_x += mover.dx
            body.center_y += mover.dy
            body.angle += mover.turned
            turn(body, motion)
            place_origin(body, motion)
            finite = np.isfinite(body.x) and np.isfinite(body.y) and np.isfinite(body.angle)
            finite = finite and np.isfinite(motion.vx) and np.isfinite(motion.vy) and np.isfinite(motion.w)
            if lost < 0 and not finite:
                lost = row
    return lost
