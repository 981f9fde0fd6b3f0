"""Arbiters: who meets whom, and which impulses go on from step to step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import SOLVERS, Box, Capsule, Circle, World
from engine.arbiters import follow_pairs, indices_by_collider
from engine.mixing import RULES
from engine.narrow_phase import COLLIDER_OF, COLLIDERS
from engine.narrow_phase.manifold import Places, write_manifold
from engine.narrow_phase.manifold_points import Manifold
from engine.simd import WIDTH
from engine.tables import SHAPE, arbiter_dtype, contact_dtype, empty, motion_dtype
from engine.vec2 import Vec2
from tests.engine.worlds import DT, busy, floor, gathering, run

pytestmark = pytest.mark.kernel

ROW_OF = (3, 9, 0, 5, 7, 1, 4, 2, 8, 6)  # of the shapes of serials 0 to 9
pair_sets = st.sets(st.tuples(st.integers(0, 5), st.integers(6, 9)), max_size=8)
features = st.lists(st.integers(1, 4), max_size=2, unique=True)


def a_table(keys: list[tuple[int, int]], mark: float) -> tuple[np.ndarray, np.ndarray]:
    """Arbiters of these serials with marks all over, and one row more than that."""
    arbiters = empty(len(keys) + 1, arbiter_dtype("double"))
    points = empty((len(keys) + 1, 2), contact_dtype("double"))
    for field in points.dtype.names or ():
        points[field] = mark + np.arange(2 * len(points)).reshape(-1, 2)
    for field in arbiters.dtype.names or ():
        arbiters[field] = mark + np.arange(len(arbiters))
    arbiters["serial1"][:-1], arbiters["serial2"][:-1] = np.array(keys, np.int64).reshape(-1, 2).T
    return arbiters, points


@settings(max_examples=200, deadline=None)
@given(before=pair_sets, after=pair_sets)
def test_arbiters_live_as_long_as_their_pairs(before: set, after: set) -> None:
    shapes = empty(10, SHAPE)
    shapes["serial"][list(ROW_OF)] = np.arange(10)
    shapes["body"] = owners = 20 + np.arange(10) % 7
    shapes["kind"] = np.arange(10) % 3
    shapes["friction"] = np.arange(10)
    possible = [key for key in sorted(before | after) if owners[ROW_OF[key[0]]] != owners[ROW_OF[key[1]]]]
    old_keys, keys = ([key for key in possible if key in some] for some in (before, after))
    old, old_points = a_table(old_keys, 1000.0)
    old["count"] = touching = np.arange(len(old)) % 3
    new, points = a_table(keys, 5.0)
    pairs = np.array([(ROW_OF[a], ROW_OF[b]) for a, b in sorted(after)], np.int64).reshape(-1, 2)
    kinds = np.full(len(new), -1, np.int32)
    serials = np.ascontiguousarray(shapes["serial"])
    rule = RULES.index("product")
    motions = empty(30, motion_dtype("single"))
    motions["still"] = 1.0
    for k, name in enumerate(("body1", "body2")):
        old[name][: len(old_keys)] = [owners[ROW_OF[key[k]]] for key in old_keys]
    total = follow_pairs(
        pairs, len(pairs), serials, shapes, COLLIDER_OF, rule, old, old_points, len(old_keys), new, points, kinds,
        motions,
    )  # fmt: skip
    gone = [place for place, key in enumerate(old_keys) if key not in after and touching[place] > 0]
    parted = {int(old[f"body{number}"][place]) for place in gone for number in (1, 2)}
    assert set(np.flatnonzero(motions["still"] == 0.0)) == parted, "what it lay on has gone: it has not been still"
    assert total == len(keys), "none for two shapes of one body"
    assert (kinds[:total] == new["collider"][:total]).all()
    for index, key in enumerate(keys):
        if key in before:
            place = old_keys.index(key)
            assert new[index].tobytes() == old[place].tobytes(), "it keeps all that it has"
            held = touching[place]
            assert points[index, :held].tobytes() == old_points[place, :held].tobytes()
        else:
            row1, row2 = ROW_OF[key[0]], ROW_OF[key[1]]
            assert (new["serial1"][index], new["serial2"][index]) == key
            assert (new["shape1"][index], new["shape2"][index]) == (row1, row2)
            assert (new["body1"][index], new["body2"][index]) == (owners[row1], owners[row2])
            assert new["friction"][index] == row1 * row2
            assert new["collider"][index] == COLLIDER_OF[row1 % 3, row2 % 3]
            assert new["count"][index] == new["recyclable"][index] == new["rolling_impulse"][index] == 0


def manifold_of(found: list[int]) -> Manifold:
    """Contacts with these features."""
    first, second = (*found, 0, 0)[:2]
    up = Vec2(0.0, 1.0)
    return Manifold(len(found), up, Vec2(0.5, 1.0), -0.1, first, Vec2(-0.5, 1.0), -0.2, second, 0.3)


@settings(max_examples=200, deadline=None)
@given(before=features, after=features, warm_starting=st.booleans())
def test_impulses_are_carried_by_feature(before: list[int], after: list[int], warm_starting: bool) -> None:
    arbiters, points = empty(3, arbiter_dtype("double")), empty((3, 2), contact_dtype("double"))
    points["normal_impulse"] = points["tangent_impulse"] = -99.0  # of an older step
    points["feature"] = 1
    arbiters["count"][1], arbiters["body2"][1], arbiters["rolling_impulse"][1] = len(before), 1, 7.0
    known = {}
    for i, feature in enumerate(before):
        points["feature"][1, i] = feature
        points["normal_impulse"][1, i], points["tangent_impulse"][1, i] = known[feature] = (100.0 + i, -200.0 - i)
    center = Vec2(0.0, 0.0)
    places = Places(center, center, center, Vec2(0.0, 2.0))
    write_manifold(1, arbiters, points, places, manifold_of(after), empty(2, motion_dtype("double")), warm_starting)
    assert arbiters["count"][1] == len(after)
    goes_on = warm_starting and before and after
    assert arbiters["rolling_impulse"][1] == (7.0 if goes_on else 0.0)
    assert arbiters["recyclable"][1] == 1
    assert arbiters["clearance"][1] == 0.3
    for i, feature in enumerate(after):
        impulses = known.get(feature, (0.0, 0.0)) if warm_starting else (0.0, 0.0)
        assert (points["normal_impulse"][1, i], points["tangent_impulse"][1, i]) == impulses
        assert points["feature"][1, i] == feature
        assert (points["r1_x"][1, i], points["r1_y"][1, i]) == (0.5 - i, 1.0)
        assert (points["r2_x"][1, i], points["r2_y"][1, i]) == (0.5 - i, -1.0)
        assert points["separation"][1, i] == (-0.1, -0.2)[i]
    assert (points["normal_impulse"][[0, 2]] == -99.0).all(), "no other arbiter is touched"


def test_every_collider_gets_its_own() -> None:
    state = run(gathering(), 20)._state
    kinds = np.ascontiguousarray(state.arbiters.rows["collider"][: state.arbiters.count])
    nothing = state.arbiters.nothing
    found = indices_by_collider(kinds, nothing, len(COLLIDERS))
    assert all(len(rows) % WIDTH == 0 for rows, _ in found)
    assert all((rows[number:] == nothing).all() and len(rows) - number < WIDTH for rows, number in found)
    own = [rows[:number] for rows, number in found]
    assert sorted(np.concatenate(own).tolist()) == list(range(state.arbiters.count))
    assert all((kinds[rows] == kind).all() and (np.diff(rows) > 0).all() for kind, rows in enumerate(own))
    assert sum(len(rows) > 0 for rows in own) > 4
    assert [rows.tolist() for rows, _ in found] == [rows.tolist() for rows, _ in state.indices]


@pytest.mark.parametrize("solver", SOLVERS)
def test_arbiters_stand_in_the_order_of_creation(solver: str) -> None:
    world = run(busy(solver=solver), 90)
    keys = [(arbiter.body1.serial, arbiter.body2.serial) for arbiter in world.arbiters]
    assert keys == sorted(keys)
    assert all(first < second for first, second in keys)
    assert len(keys) >= 3


@pytest.mark.parametrize("solver", SOLVERS)
def test_order_of_creation_holds_where_rows_are_used_again(solver: str) -> None:
    world = World(solver=solver)
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


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_contact_that_parts_forgets_its_impulse(solver: str) -> None:
    world = World(precision="double", solver=solver)
    floor(world)
    box = world.create_body(Box(1, 1), position=(0, 0.495))
    run(world, 30)
    assert world.contact_records()["normal_impulse"].all()
    box.position, box.velocity = (0, 3), (0, 0)
    world.step(DT)
    assert len(world.arbiters) == 0
    box.position, box.velocity, box.angle, box.angular_velocity = (0, 0.495), (0, 0), 0, 0
    world.set(gravity=(0, 0), position_correction=False)
    world.step(DT)
    assert len(world.contact_records()) == 2
    assert not world.contact_records()["normal_impulse"].any()


def test_many_pairs_at_once() -> None:
    # more than any first capacity, and all of them touch
    world = World(gravity=(0, 0))
    for k in range(30):
        world.create_body(Circle(1), position=(0.01 * k, 0.02 * k))
    world.step(DT)
    assert len(world.arbiters) == 30 * 29 // 2
    assert len(world.contact_records()) == 435


def test_two_shapes_of_one_body_are_two_arbiters() -> None:
    world = World(gravity=(0, 0))
    floor(world)
    body = world.create_body(Box(0.5, 1), position=(-1, 0.49))
    body.add_shape(Capsule(0.5, 0.1), offset=(2, -0.4))
    world.step(DT)
    assert [(a.body1.serial, a.body2.serial, len(a.contacts)) for a in world.arbiters] == [(0, 1, 2)] * 2
    body.shapes[0].destroy()
    assert [len(arbiter.contacts) for arbiter in world.arbiters] == [2], "gone at once"
    world.step(DT)
    assert len(world.arbiters) == 1
