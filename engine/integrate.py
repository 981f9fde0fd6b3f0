"""Stages 2 and 4 of the talk: forces change velocities, velocities change positions (symplectic Euler)."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel
from engine.tables import DYNAMIC
from engine.trigonometry import cos_sin


@kernel
def apply_forces(order, bodies, motions, steps):
    """Newton's second law: v += dt (g + F / m), w += dt torque / I. Talk, stage 2 "Apply Forces".

    Returns the rank of the first body whose velocity is no longer finite, -1 if there is none.
    """
    step = steps[0]
    lost = -1
    for rank in range(len(order)):
        body = bodies[order[rank]]
        if body.kind == DYNAMIC:
            motion = motions[order[rank]]
            motion.vx += step.dt * (step.gravity_x + motion.inverse_mass * body.force_x)
            motion.vy += step.dt * (step.gravity_y + motion.inverse_mass * body.force_y)
            motion.w += step.dt * (motion.inverse_inertia * body.torque)
            if lost < 0 and not (np.isfinite(motion.vx) and np.isfinite(motion.vy) and np.isfinite(motion.w)):
                lost = rank
    return lost


@kernel
def turn(body, motion):
    """Takes sine and cosine of the body's angle afresh."""
    c, s = cos_sin(body.angle)
    motion.cosine = c
    motion.sine = s


@kernel
def turn_row(bodies, motions, row):
    """`turn` for one row, from outside."""
    turn(bodies[row], motions[row])


@kernel
def update_positions(order, bodies, motions, steps):
    """x += dt v, angle += dt w; forces are used up. Talk, stage 4 "Update Positions".

    Returns the rank of the first body whose state is no longer finite, -1 if there is none.
    """
    step = steps[0]
    lost = -1
    for rank in range(len(order)):
        body = bodies[order[rank]]
        body.force_x = 0.0
        body.force_y = 0.0
        body.torque = 0.0
        if body.kind == DYNAMIC:
            motion = motions[order[rank]]
            body.x += step.dt * motion.vx
            body.y += step.dt * motion.vy
            body.angle += step.dt * motion.w
            turn(body, motion)
            if lost < 0 and not (np.isfinite(body.x) and np.isfinite(body.y) and np.isfinite(body.angle)):
                lost = rank
    return lost
