"""Stages 2 and 4 of the talk: forces change velocities, velocities change positions (symplectic Euler)."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel
from engine.lanes import const
from engine.tables import STATIC
from engine.trigonometry import cos_sin


@kernel
def apply_forces(dynamic, bodies, motions, gravity, scales, linear, angular, steps):
    """Newton's second law: v += dt (g + F / m), w += dt torque / I. Talk, stage 2 "Apply Forces".

    Then damping, v /= 1 + dt c. gravity, scales, linear, angular: None where the effect is not called for.
    Returns the row of the first body whose velocity is no longer finite, -1 if there is none.
    """
    step = steps[0]
    lost = -1
    for k in range(len(dynamic)):
        row = dynamic[k]
        body = bodies[row]
        motion = motions[row]
        lane = motion.vx
        pull_x = const(0.0, lane)
        pull_y = const(0.0, lane)
        if gravity is not None:
            pull_x = step.gravity_x
            pull_y = step.gravity_y
            if scales is not None:
                pull_x = const(scales[row], lane) * pull_x
                pull_y = const(scales[row], lane) * pull_y
        motion.vx += step.dt * (pull_x + motion.inverse_mass * body.force_x)
        motion.vy += step.dt * (pull_y + motion.inverse_mass * body.force_y)
        motion.w += step.dt * (motion.inverse_inertia * body.torque)
        one = const(1.0, lane)
        if linear is not None:
            slower = one / (one + step.dt * const(linear[row], lane))
            motion.vx *= slower
            motion.vy *= slower
        if angular is not None:
            motion.w *= one / (one + step.dt * const(angular[row], lane))
        if lost < 0 and not (np.isfinite(motion.vx) and np.isfinite(motion.vy) and np.isfinite(motion.w)):
            lost = row
    return lost


@kernel
def turn(body, motion):
    """Takes sine and cosine of the body's angle afresh."""
    c, s = cos_sin(body.angle)
    motion.cosine = c
    motion.sine = s


@kernel
def place_origin(body, motion):
    """Puts the body's origin where its centre of mass and its angle have it."""
    body.x = body.center_x - (motion.cosine * body.local_x - motion.sine * body.local_y)
    body.y = body.center_y - (motion.sine * body.local_x + motion.cosine * body.local_y)


@kernel
def place_center(body, motion):
    """Puts the body's centre of mass where its origin and its angle have it."""
    body.center_x = body.x + (motion.cosine * body.local_x - motion.sine * body.local_y)
    body.center_y = body.y + (motion.sine * body.local_x + motion.cosine * body.local_y)


@kernel
def place_rows(bodies, motions, rows):
    """`turn` and `place_center` for some rows, from outside."""
    for k in range(len(rows)):
        turn(bodies[rows[k]], motions[rows[k]])
        place_center(bodies[rows[k]], motions[rows[k]])


@kernel
def update_positions(order, bodies, motions, steps):
    """x += dt v, angle += dt w; forces are used up. Talk, stage 4 "Update Positions".

    Returns the row of the first body whose state is no longer finite, -1 if there is none.
    """
    step = steps[0]
    lost = -1
    for rank in range(len(order)):
        row = order[rank]
        body = bodies[row]
        body.force_x = 0.0
        body.force_y = 0.0
        body.torque = 0.0
        if body.kind != STATIC:
            motion = motions[row]
            body.center_x += step.dt * motion.vx
            body.center_y += step.dt * motion.vy
            body.angle += step.dt * motion.w
            turn(body, motion)
            place_origin(body, motion)
            finite = np.isfinite(body.x) and np.isfinite(body.y) and np.isfinite(body.angle)
            if lost < 0 and not finite:
                lost = row
    return lost
