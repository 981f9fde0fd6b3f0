"""Solving for impulses: each island by itself, its rows scaled as pivoting.py wants them."""

from __future__ import annotations

import numpy as np

from engine.jit import kernel
from engine.solvers.direct.islands import gather
from engine.solvers.direct.pivoting import solve as solve_exactly
from engine.solvers.direct.rows import assemble


@kernel
def solve_islands(system, islands, wanted, motions, b, x):
    """Writes the impulses x (n,) of those islands that `wanted` (k,) bool says; the others' stay as they are.

    Returns by what part they may be wrong.
    """
    places = np.empty(len(b), np.int64)
    error = 0.0
    for island in range(len(wanted)):
        if wanted[island]:
            chosen = islands.rows[islands.firsts[island] : islands.firsts[island + 1]]
            part, count = gather(system, chosen, places), len(chosen)
            found = np.zeros(count)
            error = max(error, scaled(assemble(part, count, motions), b[chosen], part, count, found))
            for k in range(count):
                x[chosen[k]] = found[k]
    return error


@kernel
def scaled(matrix, b, system, count, x):
    """Solves for impulses: rows are scaled so that the diagonal is 1. Returns by what part it may be wrong."""
    scale = np.zeros(count)
    low, high, ratio = system.low[:count].copy(), system.high[:count].copy(), system.ratio[:count].copy()
    for i in range(count):
        if matrix[i, i] > 0.0:
            scale[i] = 1.0 / np.sqrt(matrix[i, i])
    for i in range(count):
        unit = scale[i] if scale[i] > 0.0 else 1.0
        low[i], high[i] = low[i] / unit, high[i] / unit
        if system.normal[i] >= 0:
            ratio[i] = ratio[i] * scale[system.normal[i]] / unit
        for j in range(count):
            matrix[i, j] = matrix[i, j] * scale[i] * scale[j]
        if scale[i] > 0.0:
            matrix[i, i] = 1.0
        b[i] = b[i] * scale[i]
    error = solve_exactly(matrix, b, low, high, ratio, system.normal[:count], x)
    for i in range(count):
        x[i] = x[i] * scale[i]
    return error
