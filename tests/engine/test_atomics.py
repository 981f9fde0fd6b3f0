"""Threads that count and wait together: nothing is lost, and whoever waits sees what the others did."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from engine.atomics import LINGERING, PATIENCE, count_up, linger, new_counters, read_now, rest, wait_for
from engine.jit import kernel
from tests.engine.side_by_side import at_once

plain_too = pytest.mark.kernel

THREADS = 4


@kernel
def count_many(counters, place, times, seen):
    """Notes which numbers it was given."""
    for _ in range(times):
        seen[count_up(counters, place)] += 1


@kernel
def wait_and_read(counters, place, number, data):
    wait_for(counters, place, number)
    return data[0]


@kernel
def ping(counters, mine, theirs, rounds, data, first):
    """Takes turns with another: each writes only when it is its turn, and reads what the other wrote."""
    wrong = 0
    for k in range(rounds):
        wait_for(counters, theirs, k + 1 - first)
        wrong += data[0] != 2 * k + 1 - first
        data[0] = 2 * k + 2 - first
        count_up(counters, mine)
    return wrong


@kernel
def pause_often(times):
    for looks in range(times):
        rest(looks)


@plain_too
def test_counting_returns_what_was_there() -> None:
    counters, seen = new_counters(3), np.zeros(10, np.int64)
    assert counters.dtype == np.int64
    count_many(counters, 1, 5, seen)
    assert counters.tolist() == [0, 5, 0]
    assert seen.tolist() == [1] * 5 + [0] * 5
    assert look(counters, 1) == 5


@kernel
def look(counters, place):
    return read_now(counters, place)


def test_nothing_is_lost_between_threads() -> None:
    times = 2_000_000  # enough for them to meet, also where the machine is busy
    counters, seen = new_counters(16), np.zeros(THREADS * times, np.int8)
    count_many(counters, 8, 0, seen)  # compiled before they start, so that they run side by side
    at_once(*[lambda: count_many(counters, 8, times, seen)] * THREADS)
    assert counters.tolist() == [0] * 8 + [THREADS * times] + [0] * 7
    assert np.all(seen == 1), "each number was given to one thread"


@plain_too
def test_waiting_for_what_has_come_returns_at_once() -> None:
    counters = new_counters(2)
    counters[1] = 3
    for number in (0, 2, 3):
        assert wait_and_read(counters, 1, number, np.ones(1)) == 1.0


@plain_too
def test_waiting_ends_when_the_number_is_reached_and_not_before() -> None:
    counters, data = new_counters(1), np.zeros(1)
    wait_and_read(counters, 0, 0, data)  # compiled
    ended = threading.Event()

    def waiter() -> float:
        found = wait_and_read(counters, 0, 2, data)
        ended.set()
        return found

    def counter() -> None:
        time.sleep(0.02)
        count_many(counters, 0, 1, np.zeros(2, np.int64))
        assert not ended.wait(0.05), "longer than anyone's patience, so it has also let others run"
        data[0] = 7.0
        count_many(counters, 0, 1, np.zeros(2, np.int64))

    assert at_once(waiter, counter)[0] == 7.0


def test_what_was_written_before_counting_is_seen_after_waiting() -> None:
    rounds = 3000
    counters, data = new_counters(16), np.zeros(1, np.int64)
    ping(counters, 0, 8, 0, data, 1)
    wrong = at_once(
        lambda: ping(counters, 0, 8, rounds, data, 1),
        lambda: ping(counters, 8, 0, rounds, data, 0),
    )
    assert wrong == [0, 0]
    assert data[0] == 2 * rounds


@plain_too
def test_resting_ends() -> None:
    pause_often(PATIENCE + 50)


@plain_too
def test_lingering_ends_by_itself_or_when_something_comes() -> None:
    counters = new_counters(2)
    assert PATIENCE < LINGERING
    linger(counters, 0)  # nothing comes
    counters[0] = 4
    linger(counters, 0)  # it has come already
    assert counters.tolist() == [4, 0]
