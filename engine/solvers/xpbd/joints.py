"""Joints by position: rows (engine/solvers/joint_rows) are brought to where they hold, springs by their compliance."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import clamp, const, over
from engine.solvers.joint_rows.impulses import Speeds, pushed, rate
from engine.solvers.joint_rows.rows import place
from engine.solvers.joint_rows.tables import ACROSS_AXIS, DRIVES, HOLDS, LOWER, SPRINGS, UPPER, X
from engine.solvers.xpbd.contacts import keep_speeds, move
from engine.vec2 import Vec2


@kernel
def begin(rows, frames, rests, movers, step):
    """As a substep begins: no multiplier yet. rests: the errors that it leaves, 0 but without position correction."""
    for k in range(len(rows)):
        row = rows[k]
        row.impulse = rests[k] = const(0.0, row.error)
        if step.position_correction == 0:
            place(row, frames[row.frame], movers)
            if row.use == HOLDS or (row.use == LOWER and row.error < rests[k]):
                rests[k] = row.error
            elif row.use == UPPER and row.error > rests[k]:
                rests[k] = row.error


@kernel
def speeds_of(movers, frame):
    """How the two bodies of a joint move."""
    one, other = movers[frame.body1], movers[frame.body2]
    return Speeds(Vec2(one.vx, one.vy), one.w, Vec2(other.vx, other.vy), other.w)


@kernel
def move_row(movers, row, frame, change, inverse_h):
    """Moves body2 by a multiplier along the row [kg m], and body1 against it."""
    push = Vec2(row.nx, row.ny) * change
    move(movers[frame.body1], frame.inverse_mass1, frame.inverse_inertia1, -push, -(row.arm1 * change), inverse_h)
    move(movers[frame.body2], frame.inverse_mass2, frame.inverse_inertia2, push, row.arm2 * change, inverse_h)


@kernel
def coupled(rows, k):
    """Whether row k and the next are the two that hold one point, or one axis: they are solved together."""
    if k + 1 >= len(rows):
        return False
    row, following = rows[k], rows[k + 1]
    first = row.use == HOLDS and (row.measures == X or row.measures == ACROSS_AXIS)
    return first and following.use == HOLDS and following.frame == row.frame


@kernel
def both(row, following, frame, error, following_error):
    """The multipliers that remove two errors at once: K (a, b) = -errors, K = J M^-1 J^T. Zeros if nothing can move."""
    k_ab = (frame.inverse_mass1 + frame.inverse_mass2) * (row.nx * following.nx + row.ny * following.ny)
    k_ab = k_ab + frame.inverse_inertia1 * row.arm1 * following.arm1
    k_ab = k_ab + frame.inverse_inertia2 * row.arm2 * following.arm2
    one = const(1.0, error)
    k_aa, k_bb = over(one, row.mass), over(one, following.mass)
    inverse = over(one, k_aa * k_bb - k_ab * k_ab)
    a = (k_ab * following_error - k_bb * error) * inverse
    b = (k_ab * error - k_aa * following_error) * inverse
    if inverse == const(0.0, error):
        a, b = -row.mass * error, -following.mass * following_error
    return a, b


@kernel
def multiplier(row, rest, speeds, step):
    """The multiplier of a row after a visit, before it is bounded [kg m].

    A spring of stiffness k and damping d gives lambda / h^2 = -k C - d dC/dt at the substep's end: eq. 4 with the
    compliance 1 / k, multiplied by k h^2 so that k may be 0, and the damping of M. Macklin et al., "XPBD" (2016),
    eq. 26.
    """
    h = step.h
    if row.use == SPRINGS:
        wanted = -h * h * (row.stiffness * row.error + row.damping * rate(row, speeds)) - row.impulse
        softened = h * (h * row.stiffness + row.damping)
        return row.impulse + over(wanted * row.mass, softened + row.mass)
    if row.use == DRIVES:
        return row.impulse - row.mass * h * (rate(row, speeds) - row.speed)
    return row.impulse - row.mass * (row.error - rest)


@kernel
def solve_positions(rows, frames, rests, movers, step):
    """One pass."""
    k = 0
    while k < len(rows):
        row = rows[k]
        frame = frames[row.frame]
        place(row, frame, movers)
        if coupled(rows, k):
            following = rows[k + 1]
            place(following, frame, movers)
            a, b = both(row, following, frame, row.error - rests[k], following.error - rests[k + 1])
            row.impulse += a
            following.impulse += b
            move_row(movers, row, frame, a, step.inverse_h)
            move_row(movers, following, frame, b, step.inverse_h)
            k += 2
            continue
        total = multiplier(row, rests[k], speeds_of(movers, frame), step)
        total = clamp(total, row.least * step.h, row.most * step.h)
        change, row.impulse = total - row.impulse, total
        move_row(movers, row, frame, change, step.inverse_h)
        k += 1


@kernel
def solve_velocities(rows, frames, movers, step):
    """Speed that only came of bringing errors to nothing is taken back, as of contacts: what is rigid moves as one."""
    k = 0
    while k < len(rows):
        row = rows[k]
        frame = frames[row.frame]
        pair = coupled(rows, k)
        row.impulse *= step.inverse_h  # from here on impulses [N s]
        if pair:
            rows[k + 1].impulse *= step.inverse_h
        if (
            row.use == HOLDS
            or row.use == DRIVES
            or ((row.use == LOWER or row.use == UPPER) and row.impulse != const(0.0, row.error))
        ):
            place(row, frame, movers)
            speeds = speeds_of(movers, frame)
            if pair:
                following = rows[k + 1]
                place(following, frame, movers)
                a, b = both(row, following, frame, rate(row, speeds), rate(following, speeds))
                row.impulse += a
                following.impulse += b
                speeds = pushed(following, frame, pushed(row, frame, speeds, a), b)
            else:
                wanted = rate(row, speeds) - row.speed
                total = clamp(row.impulse - row.mass * wanted, row.least, row.most)
                change, row.impulse = total - row.impulse, total
                speeds = pushed(row, frame, speeds, change)
            keep_speeds(movers, frame, speeds)
        row.given += row.impulse
        if pair:
            rows[k + 1].given += rows[k + 1].impulse
        k += 2 if pair else 1
