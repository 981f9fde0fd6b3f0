"""The substeps as a program: which stages a step has, in which order. What each does stands in work.py."""

from __future__ import annotations

from engine.colouring import COLOURS, OVERFLOW
from engine.jit import kernel
from engine.program import add_stage, add_whole_stage

BEGIN, DRIVE, PREPARE, PREPARE_JOINTS = range(4)
VELOCITIES, POSITIONS = range(4, 6)
WARM, FORGET, BIASED, RELAX, RELAX_LAST, BOUNCE, STORE = range(6, 13)
WARM_JOINTS, FORGET_JOINTS, BIASED_JOINTS, RELAX_JOINTS, RELAX_JOINTS_LAST, STORE_JOINTS = range(13, 19)


def most_stages(substeps: int, iterations: int) -> int:
    """How many stages a program may have."""
    passes = 2 * (COLOURS + 1) * (2 * iterations + 1)  # of contacts and of joints
    return 8 + COLOURS + 1 + substeps * (2 + passes)


@kernel
def add_colours(program, count, kind, firsts, threads):
    """One stage a colour; first the overflow, one after another."""
    if firsts[OVERFLOW + 1] > firsts[OVERFLOW]:
        count = add_whole_stage(program, count, kind, firsts[OVERFLOW], firsts[OVERFLOW + 1])
    for colour in range(COLOURS):
        count = add_stage(program, count, kind, firsts[colour], firsts[colour + 1], threads)
    return count


@kernel
def add_pass(program, count, joint_kind, joints, kind, contacts, threads):
    """One pass over all joints, then over all contacts: these have the last word."""
    count = add_colours(program, count, joint_kind, joints, threads)
    return add_colours(program, count, kind, contacts, threads)


@kernel
def write_program(program, bodies, dynamic, moving, contacts, joints, bounces, threads, steps):
    """Writes the stages of a whole step and returns how many there are.

    bodies, dynamic, moving: how many blocks of eight of each; contacts, joints: the first block of each colour.
    """
    step = steps[0]
    begin = contacts[0]  # 0. Added to what a stage is, lest numba compile everything anew for each literal number
    contact_blocks, joint_blocks = contacts[COLOURS + 1], joints[COLOURS + 1]
    n = begin
    n = add_stage(program, n, begin + BEGIN, begin, bodies, threads)
    n = add_stage(program, n, begin + DRIVE, begin, dynamic, threads)
    n = add_stage(program, n, begin + PREPARE, begin, contact_blocks, threads)
    n = add_stage(program, n, begin + PREPARE_JOINTS, begin, joint_blocks, threads)
    for _ in range(step.substeps):
        n = add_stage(program, n, begin + VELOCITIES, begin, dynamic, threads)
        if step.warm_starting != 0:
            n = add_pass(program, n, begin + WARM_JOINTS, joints, begin + WARM, contacts, threads)
        else:
            n = add_stage(program, n, begin + FORGET_JOINTS, begin, joint_blocks, threads)
            n = add_stage(program, n, begin + FORGET, begin, contact_blocks, threads)
        for _ in range(step.iterations):
            n = add_pass(program, n, begin + BIASED_JOINTS, joints, begin + BIASED, contacts, threads)
        n = add_stage(program, n, begin + POSITIONS, begin, moving, threads)
        for _ in range(step.iterations - 1):
            n = add_pass(program, n, begin + RELAX_JOINTS, joints, begin + RELAX, contacts, threads)
        n = add_pass(program, n, begin + RELAX_JOINTS_LAST, joints, begin + RELAX_LAST, contacts, threads)
    if bounces:
        n = add_colours(program, n, begin + BOUNCE, contacts, threads)
    n = add_stage(program, n, begin + STORE, begin, contact_blocks, threads)
    return add_stage(program, n, begin + STORE_JOINTS, begin, joint_blocks, threads)
