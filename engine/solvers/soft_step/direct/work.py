"""What a step does to the islands that are solved at once: the stages of the program."""

from __future__ import annotations

import math

import numpy as np

from engine.jit import kernel
from engine.solvers.soft_step.direct import rows as rigid
from engine.solvers.soft_step.direct import system
from engine.solvers.soft_step.schedule import (
    BIASED_ROWS,
    FORGET_ROWS,
    PREPARE_ROWS,
    REFRESH_ROWS,
    RELAX_ROWS_LAST,
    STORE_ROWS,
    WARM_ROWS,
)  # fmt: skip

STIFFNESS = 8.0 * math.pi
"""w h, w being the frequency of a joint that is solved at once and h a substep: sixteen times that of one that is
visited. Larger: a taut line of planks, which is held by the smallest sag, shakes; smaller: chains stretch."""

DAMPING_RATIO = 40.0
"""Far beyond critical, so that what a taut line is thrown into dies out. Smaller: a bridge of 160 planks shakes by 20
mm; larger: errors of what swings fast go away slowly."""

CORRECTION = STIFFNESS / (2.0 * DAMPING_RATIO + STIFFNESS)
"""Part of a joint's error that a substep removes; see engine/softness.py, as for the next."""

GIVE = 1.0 / (STIFFNESS * (2.0 * DAMPING_RATIO + STIFFNESS))
"""How far a row gives way, as a part of its own diagonal: with it a loop that holds the same thing twice, such as a
ring of welds, can be solved."""


@kernel
def solve_islands(
    verb, first, last, chains, joints, turns, slides, bodies, motions, movers, step
):  # fmt: skip
    """One verb of the islands from `first` to before `last`. chains: the tables of Chains."""
    islands, order, couplings, columns, places, updates = chains[:6]
    rows, errors, jacobians, diagonals, blocks, factors, wanted, accumulated, given = chains[6:]
    for k in range(first, last):
        island = islands[k]
        begin, end = island.first, island.last
        if verb == PREPARE_ROWS:
            rigid.prepare(
                begin, end, order, joints, turns, slides, bodies, motions, rows, errors, jacobians
            )  # fmt: skip
            clear(begin, end, given)
            rigid.carry(begin, end, rows, accumulated, joints, turns, slides, step)
            assemble(island, couplings, columns, updates, rows, jacobians, diagonals, blocks, factors)
        elif verb == REFRESH_ROWS:
            rigid.refresh(begin, end, slides, rows, movers, errors, jacobians)
            assemble(island, couplings, columns, updates, rows, jacobians, diagonals, blocks, factors)
        elif verb == STORE_ROWS:
            rigid.store(begin, end, rows, given, accumulated, joints, turns, slides, step)
        elif verb == FORGET_ROWS:
            clear(begin, end, accumulated)
        elif verb == WARM_ROWS:
            system.push(begin, end, rows, jacobians, accumulated, movers)
        else:
            rate = 0.0
            if verb == BIASED_ROWS:
                rate = CORRECTION * np.float64(step.inverse_h) if step.position_correction != 0 else 0.0
            kept = 1.0 if verb == RELAX_ROWS_LAST else 0.0
            system.write_wanted(begin, end, rows, errors, jacobians, movers, rate, wanted)
            if verb == BIASED_ROWS:
                system.yield_to(begin, end, rows, jacobians, accumulated, GIVE, wanted)
            system.substitute(begin, end, columns, places, diagonals, factors, wanted)
            system.push(begin, end, rows, jacobians, wanted, movers)
            system.add_up(begin, end, wanted, accumulated, given, kept)


@kernel
def clear(first, last, values):
    """Nothing yet."""
    for k in range(first, last):
        for i in range(rigid.ROWS):
            values[k, i] = 0.0


@kernel
def assemble(island, couplings, columns, updates, rows, jacobians, diagonals, blocks, factors):
    """The system where the bodies are, and its factors."""
    for n in range(columns[island.first].first, columns[island.last].first):
        for i in range(rigid.ROWS):
            for j in range(rigid.ROWS):
                blocks[n, i, j] = 0.0
    system.write_diagonals(island.first, island.last, rows, jacobians, diagonals, GIVE)
    system.write_couplings(island.first_coupling, island.last_coupling, couplings, rows, jacobians, blocks)
    system.factor(island.first, island.last, columns, updates, diagonals, blocks, factors)
