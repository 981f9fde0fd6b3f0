"""A mixed linear complementarity problem with friction, solved by pivoting: which rows are at a bound, and which free?

    w = A x + b        low <= x <= high        w = 0 inside, w >= 0 at low, w <= 0 at high

with `high` of a friction row mu times the x of its normal row, and `low` against it. A guess of who is at which bound
makes it a linear system; whoever then breaks a rule changes sides: all of them at once as long as that makes fewer
break rules, else the last of them alone (J. Júdice and F. Pires, "A block principal pivoting algorithm for large-scale
strictly monotone linear complementarity problems", Computers & Operations Research 21, 1994). Without friction that
ends at the answer whenever A is positive definite; friction is part of the same systems, and where its answer is not
found so, its bounds are frozen, solved for, and renewed until they stand still.

A need not be regular: contacts share loads in many ways. It is made so by the proximal point method: A + EPSILON and
b - EPSILON x, again and again until x stands still (R. T. Rockafellar, SIAM J. Control Optim. 14, 1976). From x = 0
that ends, of all answers, at the one of least norm. All diagonal elements of A must be 1, or 0 where nothing moves.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

EPSILON = 1e-8
"""Of the diagonal. Larger: more rounds for chains of very different masses; smaller: loads that may be shared in many
ways are shared by rounding errors."""

ROUNDS = 60
"""Most rounds of the proximal point method; a stack of ten takes three."""

TOLERANCE = 1e-13
"""Part of the largest number of a problem that counts as 0."""

SLACK = 1e-8
"""The same of bounds, where who shares a load is a matter of rounding errors: of 1e-16 / EPSILON."""

MOST_CHANGES = 200
"""Of sides, before sweeps are to bring them nearer."""

PATIENCE = 5
"""Times that all change sides though that does not make fewer break rules."""

SWEEPS, TRIES = 100, 6
"""Where changing sides goes in circles: passes of Gauss-Seidel before it is tried again, and how often."""

FREE, AT_LOW, AT_HIGH = 0, -1, 1


@kernel
def eliminate(matrix, x, count):
    """Solves matrix x = x in place, by Gauss with partial pivoting. A column without a pivot leaves its x at 0."""
    for k in range(count):
        best = k
        for i in range(k + 1, count):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if matrix[best, k] == 0.0:
            continue
        if best != k:
            row = matrix[k, k:count].copy()
            matrix[k, k:count] = matrix[best, k:count]
            matrix[best, k:count] = row
            value = x[k]
            x[k] = x[best]
            x[best] = value
        for i in range(k + 1, count):
            if matrix[i, k] != 0.0:
                factor = matrix[i, k] / matrix[k, k]
                matrix[i, k + 1 : count] -= factor * matrix[k, k + 1 : count]
                x[i] -= factor * x[k]
    for k in range(count - 1, -1, -1):
        x[k] = x[k] / matrix[k, k] if matrix[k, k] != 0.0 else 0.0
        x[:k] -= x[k] * matrix[:k, k]


@kernel
def bound_of(side, i, x, low, high, ratio, normal):
    """Where a row is that is at a bound."""
    if normal[i] >= 0:
        return side * ratio[i] * max(x[normal[i]], 0.0)
    return low[i] if side == AT_LOW else high[i]


@kernel
def is_open(i, sides, normal):
    """Whether a friction row's contact does not press, so that it gives nothing."""
    return normal[i] >= 0 and sides[normal[i]] == AT_LOW


@kernel
def solve_sides(matrix, b, low, high, ratio, normal, sides, x):
    """Writes x, and returns w, for rows at the bounds that `sides` says."""
    count = len(b)
    free = np.empty(count, np.int64)
    found = 0
    for i in range(count):
        x[i] = 0.0
        if sides[i] == FREE and not is_open(i, sides, normal):
            free[found] = i
            found += 1
        elif normal[i] < 0 and sides[i] != FREE:
            x[i] = bound_of(sides[i], i, x, low, high, ratio, normal)
    pull = b.copy()
    for j in range(count):
        if x[j] != 0.0:
            pull += x[j] * matrix[:, j]
    whole = matrix.copy()
    for i in range(count):  # what slides goes with its normal row
        if normal[i] >= 0 and sides[i] != FREE:
            whole[:, normal[i]] += sides[i] * ratio[i] * matrix[:, i]
    system = np.empty((found, found))
    solution = np.empty(found)
    for k in range(found):
        solution[k] = -pull[free[k]]
        for j in range(found):
            system[k, j] = whole[free[k], free[j]]
    eliminate(system, solution, found)
    for k in range(found):
        x[free[k]] = solution[k]
    for i in range(count):
        if normal[i] >= 0 and sides[i] != FREE:
            x[i] = sides[i] * ratio[i] * x[normal[i]]
    w = b.copy()
    for j in range(count):
        w += x[j] * matrix[:, j]
    return w


@kernel
def wanted_side(i, x, w, low, high, ratio, normal, sides, small, loose):
    """The side that a row belongs on, as x and w are; its own if it breaks no rule."""
    if is_open(i, sides, normal):
        return sides[i]
    if sides[i] == FREE:
        upper = bound_of(AT_HIGH, i, x, low, high, ratio, normal)
        if x[i] > upper + loose:
            return AT_HIGH
        if x[i] < bound_of(AT_LOW, i, x, low, high, ratio, normal) - loose:
            return AT_LOW
        return FREE
    if sides[i] == AT_LOW:
        return FREE if w[i] < -small else AT_LOW
    return FREE if w[i] > small else AT_HIGH


@kernel
def pivot(matrix, b, low, high, ratio, normal, sides, x, slack):
    """Changes sides until nobody breaks a rule. Returns whether that was reached; x is then the answer.

    slack: part of the largest x by which bounds may be broken.
    """
    count = len(b)
    fewest, patience = count + 1, PATIENCE
    wanted = sides.copy()
    for _ in range(MOST_CHANGES):
        w = solve_sides(matrix, b, low, high, ratio, normal, sides, x)
        largest = np.abs(x).max()
        small, loose = TOLERANCE * max(np.abs(b).max(), largest), slack * largest
        breaking, last = 0, 0
        for i in range(count):
            wanted[i] = wanted_side(i, x, w, low, high, ratio, normal, sides, small, loose)
            if wanted[i] != sides[i]:
                breaking, last = breaking + 1, i
        if breaking == 0:
            return True
        if breaking < fewest:
            fewest, patience = breaking, PATIENCE
        elif patience > 0:
            patience -= 1
        if patience > 0:
            sides[:] = wanted
        else:
            sides[last] = wanted[last]
    return False


@kernel
def sweep(matrix, b, low, high, ratio, normal, sides, x):
    """SWEEPS passes of projected Gauss-Seidel, which find the sides of most rows where changing sides goes in circles.

    T. Jourdan, P. Alart and M. Jean, "A Gauss-Seidel like algorithm to solve frictional contact problems" (Computer
    Methods in Applied Mechanics and Engineering 155, 1998).
    """
    w = b.copy()
    for j in range(len(b)):
        w += x[j] * matrix[:, j]
    for _ in range(SWEEPS):
        for i in range(len(b)):
            lower = bound_of(AT_LOW, i, x, low, high, ratio, normal)
            upper = bound_of(AT_HIGH, i, x, low, high, ratio, normal)
            wanted = x[i] - w[i] / matrix[i, i]
            total = max(lower, min(upper, wanted))
            sides[i] = FREE
            if wanted <= lower and not (normal[i] >= 0 and upper == 0.0):
                sides[i] = AT_LOW
            elif wanted >= upper and not (normal[i] >= 0 and upper == 0.0):
                sides[i] = AT_HIGH
            w += (total - x[i]) * matrix[:, i]
            x[i] = total


@kernel
def error_of(matrix, b, low, high, ratio, normal, x):
    """How far x is from the answer: the largest of |x - (x - w held between low and high)|; 0 where x is it."""
    w = b.copy()
    for j in range(len(b)):
        w += x[j] * matrix[:, j]
    worst = 0.0
    for i in range(len(b)):
        lower = bound_of(AT_LOW, i, x, low, high, ratio, normal)
        upper = bound_of(AT_HIGH, i, x, low, high, ratio, normal)
        worst = max(worst, abs(x[i] - max(lower, min(upper, x[i] - w[i]))))
    return worst


@kernel
def solve(matrix, b, low, high, ratio, normal, x):
    """Writes the answer into x, from 0. Returns by what part of the largest number it may be wrong: see `error_of`."""
    count = len(b)
    x[:] = 0.0
    if count == 0 or np.abs(b).max() == 0.0:
        return 0.0
    sides = np.zeros(count, np.int64)
    small = TOLERANCE * np.abs(b).max()
    nearly = matrix.copy()
    for i in range(count):
        nearly[i, i] += EPSILON if matrix[i, i] > 0.0 else 1.0
        if normal[i] < 0 and low[i] == 0.0 and b[i] > small:
            sides[i] = AT_LOW
        elif normal[i] < 0 and high[i] == 0.0 and b[i] < -small:
            sides[i] = AT_HIGH
    best, least, swept, stands = x.copy(), np.inf, x.copy(), 0
    for _ in range(ROUNDS):
        before = x.copy()
        pulled = b - EPSILON * before
        found = pivot(nearly, pulled, low, high, ratio, normal, sides, x, TOLERANCE)
        for _ in range(TRIES):
            if found:
                break
            x[:] = swept
            sweep(nearly, pulled, low, high, ratio, normal, sides, x)
            swept[:] = x
            found = pivot(nearly, pulled, low, high, ratio, normal, sides, x, SLACK)
        if not found:
            x[:] = swept
        largest = max(np.abs(b).max(), np.abs(x).max())
        error = error_of(matrix, b, low, high, ratio, normal, x) / largest
        nothing = small / largest
        stands = stands + 1 if error > 0.9 * least else 0
        if error < least:
            best[:], least = x, error
        if least <= nothing or stands == 3:
            break
    x[:] = best
    return least
