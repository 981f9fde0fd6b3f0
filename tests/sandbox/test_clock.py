"""Real time, with a time of our own."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.clock import MOST_AT_ONCE, PATIENCE, Clock

DT = 1 / 60


class FakeTime:
    """A clock, its time, and what was stepped."""

    def __init__(self, speed: float = 1.0) -> None:
        self.now = 1000.0
        self.clock = Clock(DT, self.now)
        self.clock.speed = speed
        self.steps = 0

    def turn(self, cost: float = 0.0) -> int:
        """Steps that are due, each of so much time."""
        due = self.clock.due(self.now)
        for _ in range(due):
            self.now += cost
            self.clock.count(self.now)
        self.steps += due
        return due

    def run(self, seconds: float, cost: float = 0.0) -> None:
        end = self.now + seconds
        while self.now < end:
            self.turn(cost)
            self.now += max(self.clock.wait(self.now), 1e-5)


@pytest.mark.parametrize("speed", [0.1, 0.5, 1.0, 2.0, 4.0])
def test_keeps_real_time(speed: float) -> None:
    time = FakeTime(speed)
    time.run(5.0)
    assert time.steps == pytest.approx(5.0 * 60 * speed, abs=1.01)
    assert time.clock.rate(time.now) == pytest.approx(60 * speed, rel=0.04, abs=1.01)
    assert not time.clock.behind(time.now)


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_the_rate_is_the_one_kept(speed: float) -> None:
    time = FakeTime(speed)
    time.run(3.0)
    for _ in range(50):
        time.run(0.37 / 60)
        assert time.clock.rate(time.now) == pytest.approx(60 * speed, rel=1e-3)


def test_the_rate_falls_while_a_step_is_overdue() -> None:
    time = FakeTime()
    time.run(3.0)
    time.now += 2.0
    assert time.clock.rate(time.now) < 30.0


def test_waits_until_the_next_step_is_due_and_no_longer() -> None:
    time = FakeTime()
    assert time.turn() == 0
    assert time.clock.wait(time.now) == pytest.approx(DT)
    time.now += 0.01
    assert time.turn() == 0
    assert time.clock.wait(time.now) == pytest.approx(DT - 0.01)
    time.now += time.clock.wait(time.now) + 1e-9
    assert time.turn() == 1
    time.now += 10.0
    assert time.clock.wait(time.now) == 0.0


@pytest.mark.parametrize("speed", [0.1, 4.0])
def test_waits_as_long_as_the_speed_asks(speed: float) -> None:
    assert FakeTime(speed).clock.wait(1000.0) == pytest.approx(DT / speed)


@given(st.lists(st.floats(0.0, 3.9 * DT), max_size=50))
def test_irregular_turns_lose_nothing(pauses: list[float]) -> None:
    """While no turn is longer than what may be caught up at once."""
    time = FakeTime()
    for pause in pauses:
        time.now += pause
        time.turn()
    assert time.steps == pytest.approx(sum(pauses) / DT, abs=1.001)


def test_catches_up_a_little_and_drops_the_rest() -> None:
    time = FakeTime()
    time.now += 3.5 * DT
    assert time.turn() == 3
    time.now += 10.0
    assert time.turn() == MOST_AT_ONCE
    assert time.turn() == 0, "what cannot be caught up is dropped"
    time.run(2.0)
    assert time.clock.rate(time.now) == pytest.approx(60, abs=1)


@pytest.mark.parametrize("cost", [0.02, 0.1, 1.0])
def test_says_when_it_cannot_keep_up(cost: float) -> None:
    time = FakeTime()
    time.run(0.9 * PATIENCE - 4 * cost, cost)
    assert not time.clock.behind(time.now), "too early to tell"
    time.run(6.0, cost)
    assert time.clock.behind(time.now)
    assert time.clock.rate(time.now) == pytest.approx(1 / cost, rel=0.1, abs=1)
    time.run(3.0, 0.001)
    assert not time.clock.behind(time.now), "it can again"


def test_slow_motion_is_not_behind() -> None:
    time = FakeTime(0.1)
    time.run(5.0, cost=0.1)
    assert not time.clock.behind(time.now)


def test_forgets_a_pause() -> None:
    time = FakeTime()
    time.run(3.0)
    time.now += 3600.0
    time.clock.restart(time.now)
    assert time.turn() == 0
    assert not time.clock.behind(time.now)
    assert time.clock.rate(time.now) == 0.0
    time.run(0.5)
    assert time.clock.rate(time.now) == pytest.approx(60, rel=0.1), "known before a whole second has gone by"


def test_forgets_what_was_owed_before_a_pause() -> None:
    time = FakeTime()
    time.now += 0.9 * DT
    assert time.turn() == 0
    time.clock.restart(time.now)
    time.now += 0.2 * DT
    assert time.turn() == 0


def test_reads_the_wall_clock_by_itself() -> None:
    clock = Clock(1e9)
    assert clock.due() == 0
    assert 0.0 < clock.wait() <= 1e9
    clock.count()
    assert clock.rate() == 0.0  # of one step nobody knows
    clock.count()
    assert clock.rate() > 0.0
    clock.restart()
    assert clock.rate() == 0.0
    assert not clock.behind()
