"""The system of an island: assembled and factored once a substep, solved in every pass.

Blocks of three by three. Column c of L has a block for each joint that comes after c in the order and is coupled to it,
directly or because eliminating an earlier joint coupled them. See plan.py for the lists.
"""

from __future__ import annotations

from typing import NamedTuple

from engine.jit import kernel
from engine.lanes import const
from engine.solvers.soft_step.direct.rows import ARM1, ARM2, LX, LY, ROWS
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2


class Symmetric(NamedTuple):
    """A symmetric block."""

    xx: float
    xy: float
    xz: float
    yy: float
    yz: float
    zz: float


# Elements one by one, and no rows of blocks as arrays: making those took longer than what is done with them.


@kernel
def product(jacobians, k, i, j, mass, inertia1, inertia2):
    """J_i M^-1 J_j^T of two rows of one joint."""
    linear = jacobians[k, i, LX] * jacobians[k, j, LX] + jacobians[k, i, LY] * jacobians[k, j, LY]
    turn1 = jacobians[k, i, ARM1] * jacobians[k, j, ARM1]
    turn2 = jacobians[k, i, ARM2] * jacobians[k, j, ARM2]
    return mass * linear + inertia1 * turn1 + inertia2 * turn2


@kernel
def write_diagonals(first, last, rows, jacobians, diagonals, give):
    """K_kk = J_k M^-1 J_k^T, each row softened by a part of its own; 1 for a row that is not there."""
    for k in range(first, last):
        row = rows[k]
        mass = row.inverse_mass1 + row.inverse_mass2
        for i in range(ROWS):
            for j in range(i + 1):
                value = product(jacobians, k, i, j, mass, row.inverse_inertia1, row.inverse_inertia2)
                if i == j:
                    value = value + give * value if value > 0.0 else 1.0
                diagonals[k, i, j] = value


@kernel
def write_couplings(first, last, couplings, rows, jacobians, blocks):
    """Adds J_r M^-1 J_c^T of every body that two joints share."""
    for n in range(first, last):
        both = couplings[n]
        row = rows[both.row]
        if both.row_side == 0:
            mass, inertia, arm = row.inverse_mass1, row.inverse_inertia1, ARM1
        else:
            mass, inertia, arm = row.inverse_mass2, row.inverse_inertia2, ARM2
        if both.row_side != both.column_side:
            mass, inertia = -mass, -inertia
        other = ARM1 if both.column_side == 0 else ARM2
        r, c, block = both.row, both.column, both.block
        for i in range(ROWS):
            x, y, turn = mass * jacobians[r, i, LX], mass * jacobians[r, i, LY], inertia * jacobians[r, i, arm]
            for j in range(ROWS):
                blocks[block, i, j] += x * jacobians[c, j, LX] + y * jacobians[c, j, LY] + turn * jacobians[c, j, other]


@kernel
def inverse_of(d, k):
    """The inverse of a symmetric block, of which the lower half stands in d[k]."""
    xx, xy, xz, yy, yz, zz = d[k, 0, 0], d[k, 1, 0], d[k, 2, 0], d[k, 1, 1], d[k, 2, 1], d[k, 2, 2]
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    scale = 1.0 / (xx * a + xy * b + xz * c)
    return Symmetric(
        a * scale, b * scale, c * scale, (xx * zz - xz * xz) * scale, (xy * xz - xx * yz) * scale,
        (xx * yy - xy * xy) * scale,
    )  # fmt: skip


@kernel
def symmetric(d, k):
    """The symmetric block of which the lower half stands in d[k]."""
    return Symmetric(d[k, 0, 0], d[k, 1, 0], d[k, 2, 0], d[k, 1, 1], d[k, 2, 1], d[k, 2, 2])


@kernel
def write_symmetric(d, k, block):
    """Its lower half into d[k]."""
    d[k, 0, 0], d[k, 1, 0], d[k, 2, 0] = block.xx, block.xy, block.xz
    d[k, 1, 1], d[k, 2, 1], d[k, 2, 2] = block.yy, block.yz, block.zz


@kernel
def factor(first, last, below, updates, diagonals, blocks, factors):
    """K = L D L^T: diagonals become inverses of D, factors the blocks of L."""
    for c in range(first, last):
        d = inverse_of(diagonals, c)
        write_symmetric(diagonals, c, d)
        for n in range(below[c].first, below[c + 1].first):
            for i in range(ROWS):
                x, y, z = blocks[n, i, 0], blocks[n, i, 1], blocks[n, i, 2]
                factors[n, i, 0] = x * d.xx + y * d.xy + z * d.xz
                factors[n, i, 1] = x * d.xy + y * d.yy + z * d.yz
                factors[n, i, 2] = x * d.xz + y * d.yz + z * d.zz
        for n in range(below[c].update, below[c + 1].update):
            update = updates[n]
            if update.on_diagonal != 0:
                eliminate_diagonal(update.left, update.right, update.target, diagonals, blocks, factors)
            else:
                eliminate(update.left, update.right, update.target, blocks, factors)


@kernel
def eliminate(left, right, target, blocks, factors):
    """Takes L_r B_s^T off a block."""
    for i in range(ROWS):
        x, y, z = factors[left, i, 0], factors[left, i, 1], factors[left, i, 2]
        for j in range(ROWS):
            blocks[target, i, j] -= x * blocks[right, j, 0] + y * blocks[right, j, 1] + z * blocks[right, j, 2]


@kernel
def eliminate_diagonal(left, right, target, diagonals, blocks, factors):
    """Takes L_r B_r^T, of which half is enough, off a diagonal block."""
    for i in range(ROWS):
        x, y, z = factors[left, i, 0], factors[left, i, 1], factors[left, i, 2]
        for j in range(i + 1):
            diagonals[target, i, j] -= x * blocks[right, j, 0] + y * blocks[right, j, 1] + z * blocks[right, j, 2]


@kernel
def write_wanted(first, last, rows, errors, jacobians, movers, rate, wanted):
    """-(J v + rate C)"""
    for k in range(first, last):
        row = rows[k]
        a, b = load(movers, row.body1), load(movers, row.body2)
        x, y = b.v.x - a.v.x, b.v.y - a.v.y
        for i in range(ROWS):
            speed = jacobians[k, i, LX] * x + jacobians[k, i, LY] * y
            speed = speed + (jacobians[k, i, ARM2] * b.w - jacobians[k, i, ARM1] * a.w)
            wanted[k, i] = -speed - rate * errors[k, i]


@kernel
def yield_to(first, last, rows, jacobians, accumulated, give, wanted):
    """What is wanted less what the rows give way under what they bear already, each by a part of its own diagonal.

    So the impulses come to the same in all, whatever part of them a substep began with.
    """
    for k in range(first, last):
        row = rows[k]
        mass = row.inverse_mass1 + row.inverse_mass2
        for i in range(ROWS):
            diagonal = product(jacobians, k, i, i, mass, row.inverse_inertia1, row.inverse_inertia2)
            wanted[k, i] -= give * diagonal * accumulated[k, i]


@kernel
def substitute(first, last, below, places, diagonals, factors, wanted):
    """Solves L D L^T P = wanted in place."""
    for c in range(first, last):
        x, y, z = wanted[c, 0], wanted[c, 1], wanted[c, 2]
        for n in range(below[c].first, below[c + 1].first):
            r = places[n]
            for i in range(ROWS):
                wanted[r, i] -= factors[n, i, 0] * x + factors[n, i, 1] * y + factors[n, i, 2] * z
    for back in range(last - first):
        c = last - 1 - back
        d = symmetric(diagonals, c)
        x, y, z = wanted[c, 0], wanted[c, 1], wanted[c, 2]
        p = d.xx * x + d.xy * y + d.xz * z
        q = d.xy * x + d.yy * y + d.yz * z
        s = d.xz * x + d.yz * y + d.zz * z
        for n in range(below[c].first, below[c + 1].first):
            r = places[n]
            x, y, z = wanted[r, 0], wanted[r, 1], wanted[r, 2]
            p = p - (factors[n, 0, 0] * x + factors[n, 1, 0] * y + factors[n, 2, 0] * z)
            q = q - (factors[n, 0, 1] * x + factors[n, 1, 1] * y + factors[n, 2, 1] * z)
            s = s - (factors[n, 0, 2] * x + factors[n, 1, 2] * y + factors[n, 2, 2] * z)
        wanted[c, 0], wanted[c, 1], wanted[c, 2] = p, q, s


@kernel
def push(first, last, rows, jacobians, impulses, movers):
    """Gives the bodies impulses, three a joint."""
    for k in range(first, last):
        row = rows[k]
        a, b = load(movers, row.body1), load(movers, row.body2)
        x = y = turn1 = turn2 = 0.0
        for i in range(ROWS):
            p = impulses[k, i]
            x += p * jacobians[k, i, LX]
            y += p * jacobians[k, i, LY]
            turn1 += p * jacobians[k, i, ARM1]
            turn2 += p * jacobians[k, i, ARM2]
        along = Vec2(const(x, a.w), const(y, a.w))
        w1 = a.w - row.inverse_inertia1 * const(turn1, a.w)
        w2 = b.w + row.inverse_inertia2 * const(turn2, a.w)
        store(movers, row.body1, a.v - along * row.inverse_mass1, w1, a.turned)
        store(movers, row.body2, b.v + along * row.inverse_mass2, w2, b.turned)


@kernel
def add_up(first, last, impulses, accumulated, given, kept):
    """Adds them to those of the substep, and these, where kept is 1, to those of the step."""
    for k in range(first, last):
        for i in range(ROWS):
            accumulated[k, i] += impulses[k, i]
            given[k, i] += kept * accumulated[k, i]
