"""The system of an island: assembled and factored once a substep, solved in every pass.

Blocks of three by three. Column c of L has a block for each joint that comes after c in the order and is coupled to it,
directly or because eliminating an earlier joint coupled them. See plan.py for the lists.
"""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.solvers.soft_step.direct.rows import ARM1, ARM2, LX, LY, ROWS
from engine.solvers.soft_step.movers import load, store
from engine.vec2 import Vec2

REGULAR = 1e-9
"""Part of its own diagonal that is added to each row, so that a loop that holds the same thing twice can be solved.
Larger: joints give way under great loads; zero: closed rings of welds divide by nothing."""


@kernel
def write_diagonals(first, last, rows, jacobians, diagonals, give):
    """K_kk = J_k M^-1 J_k^T; 1 for a row that is not there."""
    for k in range(first, last):
        row = rows[k]
        mass = row.inverse_mass1 + row.inverse_mass2
        i1, i2 = row.inverse_inertia1, row.inverse_inertia2
        for i in range(ROWS):
            a = jacobians[k, i]
            for j in range(i + 1):
                b = jacobians[k, j]
                value = mass * (a[LX] * b[LX] + a[LY] * b[LY]) + i1 * a[ARM1] * b[ARM1] + i2 * a[ARM2] * b[ARM2]
                diagonals[k, i, j] = value
                diagonals[k, j, i] = value
            if diagonals[k, i, i] > 0:
                diagonals[k, i, i] += give * diagonals[k, i, i]
            else:
                diagonals[k, i, i] = 1


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
        other = ARM1 if both.column_side == 0 else ARM2
        if both.row_side != both.column_side:
            mass, inertia = -mass, -inertia
        for i in range(ROWS):
            a = jacobians[both.row, i]
            for j in range(ROWS):
                b = jacobians[both.column, j]
                blocks[both.block, i, j] += mass * (a[LX] * b[LX] + a[LY] * b[LY]) + inertia * a[arm] * b[other]


@kernel
def invert(d):
    """Replaces a symmetric block by its inverse."""
    a, b, c, e, f, i = d[0, 0], d[1, 0], d[2, 0], d[1, 1], d[2, 1], d[2, 2]
    aa = e * i - f * f
    bb = c * f - b * i
    cc = b * f - c * e
    scale = 1 / (a * aa + b * bb + c * cc)
    d[0, 0] = aa * scale
    d[1, 0] = d[0, 1] = bb * scale
    d[2, 0] = d[0, 2] = cc * scale
    d[1, 1] = (a * i - c * c) * scale
    d[2, 1] = d[1, 2] = (b * c - a * f) * scale
    d[2, 2] = (a * e - b * b) * scale


@kernel
def factor(first, last, below, updates, diagonals, blocks, factors):
    """K = L D L^T: diagonals become inverses of D, factors the blocks of L."""
    for c in range(first, last):
        d = diagonals[c]
        invert(d)
        for n in range(below[c].first, below[c + 1].first):
            for i in range(ROWS):
                for j in range(ROWS):
                    factors[n, i, j] = (
                        blocks[n, i, 0] * d[0, j] + blocks[n, i, 1] * d[1, j] + blocks[n, i, 2] * d[2, j]
                    )
        for n in range(below[c].update, below[c + 1].update):
            update = updates[n]
            left, right = factors[update.left], blocks[update.right]
            target = diagonals[update.target] if update.diagonal != 0 else blocks[update.target]
            for i in range(ROWS):
                for j in range(ROWS):
                    target[i, j] -= left[i, 0] * right[j, 0] + left[i, 1] * right[j, 1] + left[i, 2] * right[j, 2]


@kernel
def write_wanted(first, last, rows, errors, jacobians, movers, rate, wanted):
    """-(J v + rate C)"""
    for k in range(first, last):
        row = rows[k]
        a, b = load(movers, row.body1), load(movers, row.body2)
        x, y = b.v.x - a.v.x, b.v.y - a.v.y
        for i in range(ROWS):
            j = jacobians[k, i]
            wanted[k, i] = -(j[LX] * x + j[LY] * y + j[ARM2] * b.w - j[ARM1] * a.w) - rate * errors[k, i]


@kernel
def substitute(first, last, below, places, diagonals, factors, wanted):
    """Solves L D L^T P = wanted in place."""
    for c in range(first, last):
        for n in range(below[c].first, below[c + 1].first):
            r = places[n]
            for i in range(ROWS):
                wanted[r, i] -= (
                    factors[n, i, 0] * wanted[c, 0] + factors[n, i, 1] * wanted[c, 1] + factors[n, i, 2] * wanted[c, 2]
                )
    for back in range(last - first):
        c = last - 1 - back
        d = diagonals[c]
        x, y, z = wanted[c, 0], wanted[c, 1], wanted[c, 2]
        for i in range(ROWS):
            wanted[c, i] = d[i, 0] * x + d[i, 1] * y + d[i, 2] * z
        for n in range(below[c].first, below[c + 1].first):
            r = places[n]
            for i in range(ROWS):
                wanted[c, i] -= (
                    factors[n, 0, i] * wanted[r, 0] + factors[n, 1, i] * wanted[r, 1] + factors[n, 2, i] * wanted[r, 2]
                )


@kernel
def give(first, last, rows, jacobians, wanted, accumulated, given, kept, movers):
    """Gives the bodies the impulses that were found."""
    for k in range(first, last):
        row = rows[k]
        a, b = load(movers, row.body1), load(movers, row.body2)
        x = y = turn1 = turn2 = 0.0
        for i in range(ROWS):
            p, j = wanted[k, i], jacobians[k, i]
            accumulated[k, i] += p
            given[k, i] += kept * accumulated[k, i]
            x += p * j[LX]
            y += p * j[LY]
            turn1 += p * j[ARM1]
            turn2 += p * j[ARM2]
        push = Vec2(const(x, a.w), const(y, a.w))
        w1 = a.w - row.inverse_inertia1 * const(turn1, a.w)
        w2 = b.w + row.inverse_inertia2 * const(turn2, a.w)
        store(movers, row.body1, a.v - push * row.inverse_mass1, w1, a.turned)
        store(movers, row.body2, b.v + push * row.inverse_mass2, w2, b.turned)
