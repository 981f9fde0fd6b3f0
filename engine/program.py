"""A program: the stages of a solve in order, each cut into parts that any thread may take.

Every thread goes through all stages. In each it takes parts that nobody has taken until there are none, and then waits
until all of them are done. No part is meant for a certain thread, so the work is done by as many as really come: one
that arrives late finds everything finished, and nobody ever waits for one that is not there. Parts of one stage touch
different bodies; so who does which, and when, changes no bit of the result.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.atomics import count_up, wait_for
from engine.jit import kernel

STAGE = np.dtype(
    [
        ("kind", np.int32),  # what to do, see the solver's own list
        ("first", np.int32),  # blocks of rows: from this one
        ("last", np.int32),  # to before this one
        ("parts", np.int32),
    ]
)

TAKEN, DONE, COUNTERS = 0, 1, 8  # counters of a stage: its parts taken and done, in a cache line of its own
PARTS_A_THREAD = 2  # so that one who has less to do, or comes late, can take over from another
SMALLEST_PART = 12  # blocks, a microsecond's work: smaller parts cost more to take than to do


class Part(NamedTuple):
    """Blocks of rows, from one to before another."""

    first: int
    last: int


@kernel
def add_stage(program, count, kind, first, last, threads):
    """Writes stage number `count`; returns the next number. A stage without blocks is left out."""
    if last <= first:
        return count
    stage = program[count]
    stage.kind = kind
    stage.first = first
    stage.last = last
    most = (last - first + SMALLEST_PART - 1) // SMALLEST_PART
    stage.parts = min(most, PARTS_A_THREAD * threads) if threads > 1 else 1
    return count + 1


@kernel
def add_whole_stage(program, count, kind, first, last):
    """The same for work that must not be shared."""
    stage = program[count]
    stage.kind = kind
    stage.first = first
    stage.last = last
    stage.parts = 1
    return count + 1


@kernel
def clear_counters(counters, stages):
    """Nothing is taken yet."""
    for k in range(stages):
        counters[k * COUNTERS + TAKEN] = 0
        counters[k * COUNTERS + DONE] = 0


@kernel
def part_of(stage, number):
    """The blocks of one part."""
    first = np.int64(stage.first)
    blocks = stage.last - first
    return Part(first + blocks * number // stage.parts, first + blocks * (number + 1) // stage.parts)


@kernel
def take(counters, k):
    """The number of a part of stage k that is now this thread's. Beyond the last: there is none left."""
    return count_up(counters, k * COUNTERS + TAKEN)


@kernel
def done(counters, k):
    """This thread has done a part of stage k."""
    count_up(counters, k * COUNTERS + DONE)


@kernel
def wait(counters, k, stage):
    """Until all parts of stage k are done."""
    wait_for(counters, k * COUNTERS + DONE, stage.parts)
