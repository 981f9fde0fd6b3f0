"""A criterion reads a number off a world, when and against what it says."""

from __future__ import annotations

import math

import pytest

from engine import Box, StepError, World
from sandbox.scenes.criterion import Criterion, Reading, apply

DT = 1 / 60


def falling() -> World:
    world = World(gravity=(0, -10))
    world.create_body(Box(1, 1), position=(0, 0), velocity=(0, 3))
    return world


def height(world: World) -> float:
    return float(world.positions[0, 1])


def test_is_read_after_its_time_and_not_before() -> None:
    late = Criterion("it is at", height, "m", after=1.0, at_most=0.0)
    early = Criterion("it is at", height, "m", after=0.1, at_least=0.0)
    world = falling()
    first, second = apply([late, early], world, DT)
    assert world.step_count == 60
    assert first.value == height(world) < 0.0
    assert second.value == pytest.approx(0.3 - 0.05, abs=0.02)
    assert first.passed
    assert second.passed


def test_throughout_is_the_greatest_of_all_steps() -> None:
    (reading,) = apply([Criterion("it gets to", height, "m", 1.0, at_most=1.0, throughout=True)], falling(), DT)
    assert reading.value == pytest.approx(0.45, abs=0.02)


def test_limits_may_follow_from_the_world_at_its_beginning() -> None:
    criterion = Criterion("it falls", height, "m", 0.5, at_most=lambda world, dt: height(world) + dt)
    world = falling()
    assert criterion.limits(world, DT) == (-math.inf, DT)
    (reading,) = apply([criterion], world, DT)
    assert reading.at_most == DT


@pytest.mark.parametrize(
    ("value", "low", "high", "passed", "limit"),
    [
        (1.0, -math.inf, 2.0, True, 2.0),
        (3.0, -math.inf, 2.0, False, 2.0),
        (1.0, 1.0, 2.0, True, 2.0),
        (0.5, 1.0, 2.0, False, 1.0),
        (5.0, 1.0, math.inf, True, 1.0),
        (math.inf, -math.inf, 2.0, False, 2.0),
        (math.nan, 0.0, 2.0, False, 2.0),
    ],
)
def test_between_the_limits_is_passed(value: float, low: float, high: float, passed: bool, limit: float) -> None:
    reading = Reading(value, low, high)
    assert reading.passed is passed
    assert reading.limit == limit
    if math.isfinite(value):
        assert (reading.misses <= 0.0) is passed


def test_missing_is_counted_in_parts_of_the_limit() -> None:
    assert Reading(3.0, -math.inf, 2.0).misses == pytest.approx(0.5)
    assert Reading(0.4, 0.5, math.inf).misses == pytest.approx(0.2)
    assert Reading(2.0, -math.inf, 0.0).misses == pytest.approx(2.0)


def test_a_failed_step_is_infinitely_wrong() -> None:
    def fail(dt: float) -> None:
        raise StepError("lost")

    criterion = Criterion("it is at", height, "m", 1.0, at_most=5.0)
    (reading,) = apply([criterion], falling(), DT, fail)
    assert reading.value == math.inf
    assert not reading.passed


def test_what_was_read_before_a_failed_step_stays() -> None:
    world = falling()

    def fail_late(dt: float) -> None:
        if world.step_count == 30:
            raise StepError("lost")
        world.step(dt)

    early, late = Criterion("at", height, "m", 0.2, at_most=5.0), Criterion("at", height, "m", 1.0, at_most=5.0)
    readings = apply([early, late], world, DT, fail_late)
    assert [reading.passed for reading in readings] == [True, False]


@pytest.mark.parametrize(
    ("limits", "text"),
    [
        ({"at_most": 0.25}, "it is at ≤ 0.25 m, after 2 s"),
        ({"at_least": 3.0}, "it is at ≥ 3 m, after 2 s"),
        ({"at_least": 3.0, "at_most": 4.0}, "it is at 3 to 4 m, after 2 s"),
        ({"at_least": 3.0, "at_most": 3.0, "throughout": True}, "it is at 3 m, within 2 s"),
    ],
)
def test_claim_is_a_sentence(limits: dict, text: str) -> None:
    assert Criterion("it is at", height, "m", 2.0, **limits).claim(falling(), DT) == text
