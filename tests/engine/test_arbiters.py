"""Arbiters: who meets whom, and which impulses go on from step to step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Box, Circle, World
from engine.arbiters import match_arbiters
from engine.tables import arbiter_dtype, contact_dtype, empty, step_dtype
from tests.engine.worlds import DT, busy, floor, run

pytestmark = pytest.mark.kernel

pair = st.tuples(st.integers(0, 5), st.integers(6, 9))
contacts = st.lists(st.integers(1, 4), max_size=2, unique=True)
tables = st.dictionaries(pair, contacts, max_size=8)


def fill(content: dict, first_impulse: float) -> tuple[np.ndarray, np.ndarray, int]:
    """Tables of arbiters in ascending order: {(serial1, serial2): features}."""
    arbiters = empty(len(content) + 1, arbiter_dtype("double"))
    points = empty((len(content) + 1, 2), contact_dtype("double"))
    points["normal_impulse"] = points["tangent_impulse"] = -99.0  # of an older step
    for index, (key, features) in enumerate(sorted(content.items())):
        arbiters["serial1"][index], arbiters["serial2"][index] = key
        arbiters["count"][index] = len(features)
        for i, feature in enumerate(features):
            points["feature"][index, i] = feature
            points["x"][index, i] = 100 * index + i
            if first_impulse:
                points["normal_impulse"][index, i] = first_impulse + 10 * index + i
                points["tangent_impulse"][index, i] = -first_impulse - 10 * index - i
    return arbiters, points, len(content)


@settings(max_examples=200, deadline=None)
@given(before=tables, after=tables, warm_starting=st.booleans())
def test_impulses_are_carried_by_pair_and_feature(before: dict, after: dict, warm_starting: bool) -> None:
    before = {key: features for key, features in before.items() if features}
    old, old_points, old_count = fill(before, 1000.0)
    new, points, total = fill(after, 0.0)
    known = {
        (old["serial1"][index], old["serial2"][index], old_points["feature"][index, i]): (
            old_points["normal_impulse"][index, i],
            old_points["tangent_impulse"][index, i],
        )
        for index in range(old_count)
        for i in range(old["count"][index])
    }
    steps = empty(1, step_dtype("double"))
    steps["warm_starting"] = warm_starting
    kept = match_arbiters(old, old_points, old_count, new, points, total, steps)
    expected = sorted((key, features) for key, features in after.items() if features)
    assert kept == len(expected)
    for index, (key, features) in enumerate(expected):
        assert (new["serial1"][index], new["serial2"][index], new["count"][index]) == (*key, len(features))
        for i, feature in enumerate(features):
            assert points["feature"][index, i] == feature
            impulses = known.get((*key, feature), (0.0, 0.0)) if warm_starting else (0.0, 0.0)
            assert (points["normal_impulse"][index, i], points["tangent_impulse"][index, i]) == impulses
            assert points["x"][index, i] % 100 == i, "a contact moves with all of its row"


def test_arbiters_stand_in_the_order_of_creation() -> None:
    world = busy()
    run(world, 90)
    keys = [(arbiter.body1.serial, arbiter.body2.serial) for arbiter in world.arbiters]
    assert keys == sorted(keys)
    assert all(first < second for first, second in keys)
    assert len(keys) >= 3


def test_order_of_creation_holds_where_rows_are_used_again() -> None:
    world = World()
    bodies = [world.create_body(Box(1, 1), position=(0.5 * k, 0.1 * k)) for k in range(6)]
    bodies[1].destroy()
    bodies[4].destroy()
    for k in range(3):
        world.create_body(Circle(0.5), position=(0.3 * k, 0.7))
    run(world, 3)
    keys = [(arbiter.body1.serial, arbiter.body2.serial) for arbiter in world.arbiters]
    assert keys == sorted(keys)
    assert max(max(key) for key in keys) == 8
    for arbiter in world.arbiters:  # and the normal leaves the body made first
        (x1, y1), (x2, y2) = arbiter.body1.position, arbiter.body2.position
        normal = arbiter.contacts[0].normal
        assert normal.x * (x2 - x1) + normal.y * (y2 - y1) > 0


def test_a_contact_that_parts_forgets_its_impulse() -> None:
    world = World(precision="double")
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 0.495))
    run(world, 30)
    assert world.contact_records()["normal_impulse"].all()
    box.position, box.velocity = (0, 3), (0, 0)
    world.step(DT)
    assert len(world.arbiters) == 0
    box.position, box.velocity = (0, 0.495), (0, 0)
    world.gravity = (0, 0)
    world.step(DT)
    assert not world.contact_records()["normal_impulse"].any()


def test_many_pairs_at_once() -> None:
    # more than any first capacity, and all of them touch
    world = World(gravity=(0, 0))
    for k in range(30):
        world.create_body(Circle(1), position=(0.01 * k, 0.02 * k))
    world.step(DT)
    assert len(world.arbiters) == 30 * 29 // 2
    assert len(world.contact_records()) == 435
