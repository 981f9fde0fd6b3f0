"""How solvers that correct positions move bodies within a step: by movers (soft_step/movers.py), one at a time.

A mover's rotation is the cosine and sine of what its body turned by, as exact as the angle that the body then gets:
what is joined without error within the step is so afterwards.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.solvers.soft_step.movers import finish
from engine.trigonometry import cos_sin

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def begin(order, motions, movers):
    """Bodies as they are now, with their velocities. order: rows of all bodies."""
    for k in range(len(order)):
        motion, mover = motions[order[k]], movers[order[k]]
        mover.vx, mover.vy, mover.w = motion.vx, motion.vy, motion.w
        mover.turned, mover.dx, mover.dy = 0, 0, 0
        mover.cosine, mover.sine = 1, 0


@kernel
def turn(mover):
    """Takes cosine and sine of what a body turned by."""
    mover.cosine, mover.sine = cos_sin(np.float64(mover.turned))


@kernel
def advance(order, movers, dt):
    """x += dt v, angle += dt w. order: rows of those that move."""
    for k in range(len(order)):
        mover = movers[order[k]]
        mover.dx += dt * mover.vx
        mover.dy += dt * mover.vy
        mover.turned += dt * mover.w
        turn(mover)


@kernel
def shift(mover, inverse_mass, inverse_inertia, push, arm, sign):
    """Moves a body as an impulse `push` [kg m] would, if it lasted a second: by sign M^-1 P."""
    mover.dx += sign * inverse_mass * push.x
    mover.dy += sign * inverse_mass * push.y
    mover.turned += sign * inverse_inertia * arm
    turn(mover)


@kernel
def take_speeds(order, motions, movers):
    """Lets the movers go on as fast as the bodies now are."""
    for k in range(len(order)):
        motion, mover = motions[order[k]], movers[order[k]]
        mover.vx, mover.vy, mover.w = motion.vx, motion.vy, motion.w


def update_positions(state: State, settings: Settings) -> int:
    """Stage 4 of the talk: bodies go where velocities and corrections took them."""
    tables, order = state.bodies.tables, state.awake_order
    found = finish(0, len(order), order, tables["bodies"], tables["motions"], state.scratch["movers"], None)
    return -1 if found >= 0 else int(order[-1 - found])
