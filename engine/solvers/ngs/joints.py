"""Joints of ngs, as scalar rows; two that are rigid and stand side by side are solved together.

Those are a point's x and y, and a slider's way across its axis and its angle: what couples them is strong, as arms are
long, and one by one they would need many passes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import clamp, const, over
from engine.solvers.joint_rows.impulses import Speeds, pushed, rate
from engine.solvers.joint_rows.rows import inverse_mass, measure
from engine.solvers.joint_rows.tables import ACROSS_AXIS, HOLDS, LOWER, SPRINGS, TURN, UPPER, X
from engine.solvers.moving import shift
from engine.solvers.soft_step.movers import load
from engine.vec2 import Vec2, dot


class Both(NamedTuple):
    """Impulses of two rows."""

    first: Any
    second: Any


@kernel
def has_twin(rows, k):
    """Whether row k is solved together with the next one."""
    row = rows[k]
    if row.use != HOLDS or k + 1 == len(rows):
        return False
    twin = rows[k + 1]
    across = row.measures == ACROSS_AXIS and twin.measures == TURN and twin.frame == row.frame and twin.use == HOLDS
    return row.measures == X or across


@kernel
def solve_both(frame, a, b, wanted_a, wanted_b):
    """The impulses of two rows or measures that change their rates by so much."""
    one = const(1.0, a.arm1)
    k_aa = inverse_mass(frame, a.n, a.arm1, a.arm2)
    k_bb = inverse_mass(frame, b.n, b.arm1, b.arm2)
    k_ab = frame.inverse_inertia1 * a.arm1 * b.arm1 + frame.inverse_inertia2 * a.arm2 * b.arm2
    k_ab += (frame.inverse_mass1 + frame.inverse_mass2) * dot(a.n, b.n)
    k_bb = k_bb if k_bb > 0 else one  # what nothing turns: then k_ab is 0, too, and its impulse does nothing
    inverse = over(one, k_aa * k_bb - k_ab * k_ab)
    return Both(inverse * (k_bb * wanted_a - k_ab * wanted_b), inverse * (k_aa * wanted_b - k_ab * wanted_a))


class Jacobian(NamedTuple):
    """A row's Jacobian."""

    n: Vec2
    arm1: Any
    arm2: Any


@kernel
def jacobian_of(row):
    """As it was prepared."""
    return Jacobian(Vec2(row.nx, row.ny), row.arm1, row.arm2)


@kernel
def speeds_of(motion1, motion2):
    """Velocities of two bodies."""
    return Speeds(Vec2(motion1.vx, motion1.vy), motion1.w, Vec2(motion2.vx, motion2.vy), motion2.w)


@kernel
def write_speeds(motion1, motion2, speeds):
    """Their new velocities."""
    motion1.vx, motion1.vy, motion1.w = speeds.v1.x, speeds.v1.y, speeds.w1
    motion2.vx, motion2.vy, motion2.w = speeds.v2.x, speeds.v2.y, speeds.w2


@kernel
def warm_start(rows, frames, motions):
    """Gives the bodies the impulses of the step before."""
    for k in range(len(rows)):
        row = rows[k]
        frame = frames[row.frame]
        motion1, motion2 = motions[frame.body1], motions[frame.body2]
        write_speeds(motion1, motion2, pushed(row, frame, speeds_of(motion1, motion2), row.impulse))


@kernel
def row_change(row, speed, step):
    """The impulse to add to one row, whose rate is `speed`: bounds hold for the sum."""
    bias = -row.speed
    mass, soft = row.mass, const(0.0, speed)
    if row.use == SPRINGS:
        give = row.damping + step.dt * row.stiffness
        soft = over(const(1.0, give), step.dt * give)
        bias = over(row.stiffness, give) * row.error
        inverse = over(const(1.0, mass), mass) + soft
        mass = over(const(1.0, inverse), inverse) if row.mass > 0 else row.mass
    elif (row.use == LOWER and row.error > 0) or (row.use == UPPER and row.error < 0):
        bias = row.error * step.inverse_dt
    total = clamp(row.impulse - mass * (speed + bias + soft * row.impulse), row.least, row.most)
    return total - row.impulse


@kernel
def solve(rows, frames, motions, step):
    """One pass over the velocities."""
    k = 0
    while k < len(rows):
        row = rows[k]
        frame = frames[row.frame]
        motion1, motion2 = motions[frame.body1], motions[frame.body2]
        speeds = speeds_of(motion1, motion2)
        if has_twin(rows, k):
            twin = rows[k + 1]
            both = solve_both(frame, jacobian_of(row), jacobian_of(twin), -rate(row, speeds), -rate(twin, speeds))
            row.impulse += both.first
            twin.impulse += both.second
            speeds = pushed(twin, frame, pushed(row, frame, speeds, both.first), both.second)
            k += 2
        else:
            impulse = row_change(row, rate(row, speeds), step)
            row.impulse += impulse
            speeds = pushed(row, frame, speeds, impulse)
            k += 1
        write_speeds(motion1, motion2, speeds)


@kernel
def note_given(rows):
    """What the passes gave."""
    for k in range(len(rows)):
        rows[k].given = rows[k].impulse


@kernel
def push_apart(frame, movers, found, push):
    """Moves two bodies along a measure's Jacobian."""
    one = const(1.0, push)
    m1, i1, m2, i2 = frame.inverse_mass1, frame.inverse_inertia1, frame.inverse_mass2, frame.inverse_inertia2
    shift(movers[frame.body1], m1, i1, found.n * push, found.arm1 * push, -one)
    shift(movers[frame.body2], m2, i2, found.n * push, found.arm2 * push, one)


@kernel
def correct(rows, frames, movers, most):
    """One pass over the positions: what is rigid, or beyond a limit, has no error afterwards, to first order."""
    k = 0
    while k < len(rows):
        row = rows[k]
        frame = frames[row.frame]
        a, b = load(movers, frame.body1), load(movers, frame.body2)
        found = measure(row, frame, a, b)
        zero = const(0.0, row.zero)
        if has_twin(rows, k):
            other = measure(rows[k + 1], frame, a, b)
            first = clamp(found.value - row.zero, -most, most)
            second = clamp(other.value - rows[k + 1].zero, -most, most)
            both = solve_both(frame, found, other, -first, -second)
            push_apart(frame, movers, found, both.first)
            push_apart(frame, movers, other, both.second)
            k += 2
            continue
        k += 1
        error = clamp(found.value - row.zero, -most, most)
        rigid = row.use == HOLDS or (row.use == LOWER and error < zero) or (row.use == UPPER and error > zero)
        if rigid:
            inverse = inverse_mass(frame, found.n, found.arm1, found.arm2)
            push_apart(frame, movers, found, -over(error, inverse))
