"""How bodies move within a substep: velocities from forces, positions from velocities (symplectic Euler).

Eight bodies at a time where there is something to compute. Lists of bodies are filled up to a multiple of eight with
the tables' last row, which is nobody's.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.atomics import count_up
from engine.integrate import place_origin, turn
from engine.jit import kernel
from engine.lanes import const, eight_of, holds_somewhere, select, sqrt
from engine.rows import at, load_row, pick, store_row
from engine.simd import WIDTH
from engine.threads import DONE, take_part, wait_for_all
from engine.vec2 import Vec2, dot, rotate


class Mover(NamedTuple):
    """A body in a pass, in lanes."""

    v: Vec2  # [m/s]
    w: Any  # [rad/s]
    turned: Any  # [rad]
    d: Vec2  # way since the step began [m]
    q: Vec2  # rotation since the step began


@kernel
def load(movers, rows):
    """Movers from their rows."""
    vx, vy, w, turned, dx, dy, cosine, sine = load_row(movers, rows)
    return Mover(Vec2(vx, vy), w, turned, Vec2(dx, dy), Vec2(cosine, sine))


@kernel
def store(movers, rows, v, w, turned):
    """What an impulse changes, back into the rows; `turned` comes along because it stands beside."""
    store_row(movers, rows, (v.x, v.y, w, turned))


@kernel
def begin(first, last, order, motions, movers):
    """Bodies as the step finds them. Adding 0 makes 0 of -0: a body that nothing moves is written by several lanes."""
    for k in range(first, last):
        rows = eight_of(order, WIDTH * k)
        vx, vy, w, _, _, _, _, _ = load_row(motions, rows)
        zero = const(0.0, vx)
        store_row(movers, rows, (vx + zero, vy + zero, w + zero, zero, zero, zero, const(1.0, vx), zero))


@kernel
def drive(first, last, dynamic, bodies, motions, gravity, scales, drives, step):
    """What forces will do to velocities in each substep: h (s g + F / m), and h torque / I.

    gravity, scales: None where the effect is not called for.
    """
    for k in range(first, last):
        rows = eight_of(dynamic, WIDTH * k)
        body = at(bodies, rows)
        motion = at(motions, rows)
        inverse_mass = motion.inverse_mass
        ax = inverse_mass * const(body.force_x, inverse_mass)
        ay = inverse_mass * const(body.force_y, inverse_mass)
        if gravity is not None:
            if scales is not None:
                scale = const(pick(scales, rows), inverse_mass)
                ax = ax + scale * step.gravity_x
                ay = ay + scale * step.gravity_y
            else:
                ax = ax + step.gravity_x
                ay = ay + step.gravity_y
        row = at(drives, k)
        row.vx = step.h * ax
        row.vy = step.h * ay
        row.w = step.h * (motion.inverse_inertia * const(body.torque, inverse_mass))


@kernel
def hold_speed(v, most):
    """A velocity, or one of the largest speed in its direction [m/s]."""
    squared = dot(v, v)
    above = squared > most * most
    if holds_somewhere(above):
        one = const(1.0, squared)
        return v * select(above, most / sqrt(select(above, squared, one)), one)
    return v


@kernel
def integrate_velocities(first, last, dynamic, drives, movers, linear, angular, step):
    """v += what forces do, then v /= 1 + h c, up to the largest speed; the same for the angular velocity.

    linear, angular: None where the effect is not called for.
    """
    for k in range(first, last):
        rows = eight_of(dynamic, WIDTH * k)
        mover = load(movers, rows)
        row = at(drives, k)
        v = mover.v + Vec2(row.vx, row.vy)
        w = mover.w + row.w
        one = const(1.0, w)
        if linear is not None:
            slower = one / (one + step.h * const(pick(linear, rows), w))
            v = v * slower
        if angular is not None:
            w = w * (one / (one + step.h * const(pick(angular, rows), w)))
        store(movers, rows, hold_speed(v, step.maximum_speed), w, mover.turned)


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
def integrate_positions(first, last, moving, movers, h):
    """d += h v, and the rotation likewise."""
    for k in range(first, last):
        rows = eight_of(moving, WIDTH * k)
        mover = load(movers, rows)
        angle = h * mover.w
        q = turned_by(mover.q, angle)
        d = mover.d + mover.v * h
        store_row(movers, rows, (mover.v.x, mover.v.y, mover.w, mover.turned + angle, d.x, d.y, q.x, q.y))


@kernel
def finish(first, last, order, bodies, motions, movers, steps):
    """Moves the bodies from `first` to before `last` to where the substeps took them; forces are used up.

    Returns how many have been still for long enough to sleep, or, if the state of one is no longer finite, -1 less the
    rank of the first. steps: None where nothing sleeps.
    """
    lost = -1
    still = first * 0  # a literal would be a type of its own
    if steps is not None:
        limits = limits_of(steps[0])
    for rank in range(first, last):
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
                lost = rank
            if steps is not None:
                still += time_still(motion, mover, limits)
    return still if lost < 0 else -1 - lost


class Limits(NamedTuple):
    """When a body is still, see engine/sleeping.py."""

    speed: Any  # square of the speed below which it is [m^2/s^2]
    way: Any  # square of the way that it goes in a step at that speed [m^2]
    dt: Any  # [s]
    enough: Any  # time after which it may sleep [s]


@kernel
def limits_of(step):
    """The limits that hold for a step."""
    speed = step.sleep_speed * step.sleep_speed
    return Limits(speed, speed * step.dt * step.dt, step.dt, step.sleep_time)


@kernel
def time_still(motion, mover, limits):
    """Times how long a body has been still. Returns whether that is long enough to sleep.

    What is pushed out of another has no speed left, but goes a way. Both sides are multiplied by 1 / I, as a division
    takes long; where nothing turns the body, w is 0.
    """
    mass, inertia = motion.inverse_mass, motion.inverse_inertia
    inertia = inertia if inertia > 0 else mass
    speed = mover.vx * mover.vx + mover.vy * mover.vy - limits.speed
    way = mover.dx * mover.dx + mover.dy * mover.dy - limits.way
    slow = inertia * speed + mass * (mover.w * mover.w) < 0
    near = inertia * way + mass * (mover.turned * mover.turned) < 0
    still = motion.still + limits.dt if slow and near else limits.dt * 0
    motion.still = still
    return still >= limits.enough


@kernel
def finish_together(leads, board, firsts, found, order, bodies, motions, movers, steps):
    """The same by several threads: part p from firsts[p] to before firsts[p + 1]."""
    part = take_part(board, len(found))
    while part >= 0:
        found[part] = finish(firsts[part], firsts[part + 1], order, bodies, motions, movers, steps)
        count_up(board, DONE)
        part = take_part(board, len(found))
    if leads:
        wait_for_all(board, len(found))
