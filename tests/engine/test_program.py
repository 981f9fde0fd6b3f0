"""Programs: parts that cover every block once, taken once, by as many threads as come."""

from __future__ import annotations

import time
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.atomics import new_counters
from engine.jit import kernel
from engine.program import (
    COUNTERS,
    DONE,
    PARTS_A_THREAD,
    SMALLEST_PART,
    STAGE,
    TAKEN,
    add_stage,
    add_whole_stage,
    clear_counters,
    done,
    part_of,
    take,
    wait,
)
from engine.tables import empty
from tests.engine.side_by_side import at_once

plain_too = pytest.mark.kernel

first_blocks = st.integers(0, 1000)
block_counts = st.integers(0, 3 * SMALLEST_PART) | st.integers(0, 5000)
thread_counts = st.integers(1, 64)


def parts(stage: np.ndarray) -> list[tuple[int, int]]:
    return [tuple(part_of(stage, np.int64(number))) for number in range(int(stage["parts"]))]


@plain_too
@given(first=first_blocks, count=block_counts, threads=thread_counts)
def test_parts_cover_every_block_once(first: int, count: int, threads: int) -> None:
    program = empty(3, STAGE)
    stages = add_stage(program, 1, 5, first, first + count, threads)
    assert stages == (2 if count else 1), "a stage without blocks is left out"
    assert program["parts"][0] == program["parts"][2] == 0
    if not count:
        assert program["parts"][1] == program["kind"][1] == 0
        return
    stage = program[1]
    assert (stage["kind"], stage["first"], stage["last"]) == (5, first, first + count)
    found = parts(stage)
    blocks = [block for begin, end in found for block in range(begin, end)]
    assert blocks == list(range(first, first + count))
    assert 1 <= len(found) <= PARTS_A_THREAD * threads
    sizes = [end - begin for begin, end in found]
    assert max(sizes) - min(sizes) <= 1
    if threads == 1:
        assert len(found) == 1
    elif len(found) > 1:
        assert min(sizes) >= SMALLEST_PART // 2, "no part so small that taking it costs more than doing it"


@plain_too
@given(first=first_blocks, count=block_counts)
def test_a_whole_stage_has_one_part(first: int, count: int) -> None:
    program = empty(1, STAGE)
    assert add_whole_stage(program, 0, 3, first, first + count) == 1
    assert program["kind"][0] == 3
    assert parts(program[0]) == [(first, first + count)]


@plain_too
def test_large_numbers_of_blocks_do_not_overflow() -> None:
    program = empty(1, STAGE)
    add_stage(program, 0, 0, 2**30, 2**31 - 1, 64)
    found = parts(program[0])
    assert found[0][0] == 2**30
    assert found[-1][1] == 2**31 - 1
    assert all(a[1] == b[0] for a, b in pairwise(found))


@plain_too
def test_counters() -> None:
    counters = new_counters(3 * COUNTERS)
    counters[:] = 9
    clear_counters(counters, 2)
    untouched = counters[2 * COUNTERS :].tolist()
    assert untouched == [9] * COUNTERS, "the third stage's are not ours"
    assert [take_part(counters, 1) for _ in range(3)] == [0, 1, 2]
    finish_part(counters, 1)
    assert counters[COUNTERS + TAKEN] == 3
    assert counters[COUNTERS + DONE] == 1
    assert counters[TAKEN] == counters[DONE] == 0


@kernel
def take_part(counters, k):
    return take(counters, k)


@kernel
def finish_part(counters, k):
    done(counters, k)


# --- threads ---------------------------------------------------------------------------------------------------------
# A world of numbers in which each stage adds the stage's number to the sum of its neighbours of the stage before: who
# does not wait, or does a block twice, or leaves one out, ends with other numbers.


@kernel
def join(program, stages, counters, values, visits):
    for k in range(stages):
        stage = program[k]
        number = take(counters, k)
        while number < stage.parts:
            part = part_of(stage, number)
            for block in range(part.first, part.last):
                left, right = values[k, block - 1], values[k, (block + 1) % values.shape[1]]
                values[k + 1, block] = (left * 3 + right + stage.kind) % 1_000_003
                visits[k, block] += 1
            done(counters, k)
            number = take(counters, k)
        wait(counters, k, stage)


class Work:
    """A program of stages, its counters, and the numbers that it works on."""

    def __init__(self, stages: int, blocks: int, threads: int) -> None:
        self.program = empty(stages, STAGE)
        self.stages = stages
        for k in range(stages):
            if k % 5 == 4:
                add_whole_stage(self.program, k, k, 0, blocks)
            else:
                add_stage(self.program, k, k, 0, blocks, threads)
        self.counters = new_counters(stages * COUNTERS)
        self.values = np.zeros((stages + 1, blocks), np.int64)
        self.values[0] = np.arange(blocks)
        self.visits = np.zeros((stages, blocks), np.int64)

    def join(self, delay: float = 0.0) -> None:
        time.sleep(delay)
        join(self.program, self.stages, self.counters, self.values, self.visits)

    def check(self) -> None:
        values = np.arange(self.values.shape[1])
        for k in range(self.stages):
            values = (np.roll(values, 1) * 3 + np.roll(values, -1) + k) % 1_000_003
            assert np.array_equal(self.values[k + 1], values), f"stage {k}"
        assert np.all(self.visits == 1), "every block of every stage once"
        assert np.array_equal(self.counters[DONE::COUNTERS], self.program["parts"])


def together(work: Work, delays: list[float]) -> None:
    at_once(*[partial(work.join, delay) for delay in delays])


@plain_too
def test_one_thread_alone_does_the_work_of_many() -> None:
    work = Work(8, 150, threads=4)
    assert work.program["parts"].max() == 8
    work.join()
    work.check()


@plain_too
def test_whoever_comes_when_all_is_done_finds_nothing_to_do() -> None:
    work = Work(6, 100, threads=3)
    work.join()
    at_once(work.join)
    work.check()


@pytest.mark.parametrize("threads", [2, 3, 5])
@settings(max_examples=8)
@given(stages=st.integers(1, 60), blocks=st.integers(1, 400))
def test_real_threads_do_every_block_once(threads: int, stages: int, blocks: int) -> None:
    work = Work(stages, blocks, threads)
    together(work, [0.0] * threads)
    work.check()


def test_fewer_and_more_threads_than_the_program_was_written_for() -> None:
    Work(1, 1, 1).join()  # compiled
    for written_for, come in ((8, 2), (2, 6), (1, 3)):
        work = Work(200, 300, written_for)
        together(work, [0.0] * come)
        work.check()


def test_one_that_comes_late_helps_with_what_is_left_or_goes() -> None:
    Work(1, 1, 1).join()  # compiled
    for delay in (0.0005, 0.002, 0.05):
        work = Work(2000, 400, threads=3)
        together(work, [0.0, delay, 2 * delay])
        work.check()
