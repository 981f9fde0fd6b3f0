"""The substeps as a program: which stages a step has, in which order. What each does stands in work.py."""

from __future__ import annotations

from engine.colouring import COLOURS, OVERFLOW
from engine.jit import kernel
from engine.program import PARTS_A_THREAD, add_stage, add_whole_stage

BEGIN, DRIVE, PREPARE, VELOCITIES, POSITIONS = range(5)
WARM, FORGET, BIASED, RELAX, RELAX_LAST, BOUNCE, STORE = range(5, 12)

TURNS, SLIDES, LINES, POINTS, CHAINS = range(5)
"""Rows of joints, in the order in which a pass goes over them: what may give way first, what holds last. Chains are
islands of joints that are solved at once."""

JOINTS = 16
VERBS = 8
PREPARE_ROWS, REFRESH_ROWS, WARM_ROWS, FORGET_ROWS, BIASED_ROWS, RELAX_ROWS, RELAX_ROWS_LAST, STORE_ROWS = range(VERBS)
"""A stage of joints is JOINTS + VERBS * rows + verb."""


def most_stages(substeps: int, iterations: int, colours: int) -> int:
    """How many stages a program may have; colours: stages of a pass over all joints and contacts."""
    return 8 + 10 + colours + substeps * (2 + 10 + (colours + 1) * (2 * iterations + 1))


@kernel
def add_colours(program, count, kind, firsts, threads):
    """One stage a colour; first the overflow, one after another."""
    if firsts[OVERFLOW + 1] > firsts[OVERFLOW]:
        count = add_whole_stage(program, count, kind, firsts[OVERFLOW], firsts[OVERFLOW + 1])
    for colour in range(COLOURS):
        count = add_stage(program, count, kind, firsts[colour], firsts[colour + 1], threads)
    return count


@kernel
def add_chains(program, count, verb, chains, threads):
    """One stage for all islands that are solved at once: they share no body."""
    if chains == 0:
        return count
    stage = program[count]
    count = add_whole_stage(program, count, JOINTS + VERBS * CHAINS + verb, 0, chains)
    stage.parts = min(chains, PARTS_A_THREAD * threads) if threads > 1 else 1
    return count


@kernel
def add_all_rows(program, count, verb, joints, chains, threads):
    """One stage for each kind of rows, of joints of all colours: what touches no body."""
    for rows in range(len(joints)):
        count = add_stage(program, count, JOINTS + VERBS * rows + verb, 0, joints[rows, COLOURS + 1], threads)
    return add_chains(program, count, verb, chains, threads)


@kernel
def add_pass(program, count, verb, joints, chains, kind, contacts, threads):
    """One pass over all joints, then over all contacts: these have the last word."""
    for rows in range(len(joints)):
        count = add_colours(program, count, JOINTS + VERBS * rows + verb, joints[rows], threads)
    count = add_chains(program, count, verb, chains, threads)
    return add_colours(program, count, kind, contacts, threads)


@kernel
def write_program(program, bodies, dynamic, moving, contacts, joints, chains, bounces, threads, steps):
    """Writes the stages of a whole step and returns how many there are.

    bodies, dynamic, moving: how many blocks of eight of each; contacts: the first block of each colour; joints: the
    same, for each kind of rows; chains: how many islands are solved at once.
    """
    step = steps[0]
    begin = contacts[0]  # 0. Added to what a stage is, lest numba compile everything anew for each literal number
    blocks = contacts[COLOURS + 1]
    n = begin
    n = add_stage(program, n, begin + BEGIN, begin, bodies, threads)
    n = add_stage(program, n, begin + DRIVE, begin, dynamic, threads)
    n = add_stage(program, n, begin + PREPARE, begin, blocks, threads)
    n = add_all_rows(program, n, begin + PREPARE_ROWS, joints, chains, threads)
    for _ in range(step.substeps):
        n = add_stage(program, n, begin + VELOCITIES, begin, dynamic, threads)
        if step.warm_starting != 0:
            n = add_pass(program, n, begin + WARM_ROWS, joints, chains, begin + WARM, contacts, threads)
        else:
            n = add_all_rows(program, n, begin + FORGET_ROWS, joints, chains, threads)
            n = add_stage(program, n, begin + FORGET, begin, blocks, threads)
        for _ in range(step.iterations):
            n = add_pass(program, n, begin + BIASED_ROWS, joints, chains, begin + BIASED, contacts, threads)
        n = add_stage(program, n, begin + POSITIONS, begin, moving, threads)
        n = add_all_rows(program, n, begin + REFRESH_ROWS, joints[:POINTS], chains, threads)  # points turn in each pass
        for _ in range(step.iterations - 1):
            n = add_pass(program, n, begin + RELAX_ROWS, joints, chains, begin + RELAX, contacts, threads)
        n = add_pass(program, n, begin + RELAX_ROWS_LAST, joints, chains, begin + RELAX_LAST, contacts, threads)
    if bounces:
        n = add_colours(program, n, begin + BOUNCE, contacts, threads)
    n = add_stage(program, n, begin + STORE, begin, blocks, threads)
    return add_all_rows(program, n, begin + STORE_ROWS, joints, chains, threads)
