"""Events: exact for a ball that falls, equal to a difference of sets for all else, and told once whatever happens."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import HIT_EVENT, SOLVERS, Box, Circle, Events, Snapshot, World
from tests.engine.worlds import DT, PRECISIONS, busy, floor, gathering
from tests.naive.touching import pairs, poses, touching

BOTH = [(solver, precision) for solver in SOLVERS for precision in PRECISIONS]
STEPS = 90


def equal(first: Events, second: Events) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))


def glued(parts: list[Events]) -> Events:
    return Events(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def told(world: World, steps: int, dt: float = DT) -> list[Events]:
    found = []
    for _ in range(steps):
        world.step(dt)
        found.append(world.events)
    return found


def toys(count: int = 40, **settings: Any) -> World:
    """Boxes and discs that rain on a floor: much begins and ends."""
    world = World(tell_events=True, **settings)
    floor(world)
    rng = np.random.default_rng(5)
    for k in range(count):
        shape = Box(0.5, 0.4) if k % 2 else Circle(0.25)
        place = (rng.uniform(-2, 2) * count / 40, 0.5 + 24 * k / count)
        world.create_body(shape, position=place, angle=rng.uniform(0, 3), velocity=(rng.uniform(-1, 1), -3))
    return world


# --- exact ------------------------------------------------------------------------------------------------------------


@pytest.mark.kernel
@pytest.mark.parametrize(("solver", "precision"), BOTH)
@pytest.mark.parametrize("ground_first", [True, False])
def test_a_ball_hits_once_with_the_speed_of_its_fall(solver: str, precision: str, ground_first: bool) -> None:
    drop, radius, x, gravity = 0.1, 0.25, 0.375, 10.0
    world = World(tell_events=True, solver=solver, precision=precision, gravity=(0, -gravity))
    ground = floor(world) if ground_first else None
    ball = world.create_body(Circle(radius), position=(x, radius + drop), friction=0)
    ground = ground or floor(world)
    dt = 1 / 512  # a power of two: speeds and ways are exact even in single precision, but for positions
    heights, hits = [], []
    for _ in range(96):
        heights.append(ball.position.y - radius)
        world.step(dt)
        hits += list(world.events.hit)
    assert len(hits) == 1
    (hit,) = hits
    step = int(hit["step"])
    if solver != "avbd":  # whose penalty reaches a little further than its bound
        assert hit["speed"] == gravity * dt * (step - 1), "as the step began"
    early = 1 if solver in ("soft_step", "sequential_impulses") else 2  # the others brake in the step before they touch
    early = 10 if solver == "avbd" else early
    assert abs(hit["speed"] - math.sqrt(2 * gravity * drop)) <= early * gravity * dt
    height = heights[step - 1]
    assert abs(height) < 4.1 * dt, "one step's way"
    first, second = (ground, ball) if ground_first else (ball, ground)
    assert (hit["body1"], hit["body2"]) == (first.serial, second.serial)
    assert (hit["shape1"], hit["shape2"]) == (first.shapes[0].serial, second.shapes[0].serial)
    assert (hit["nx"], hit["ny"]) == (0.0, 1.0 if ground_first else -1.0)
    assert (hit["x"], hit["y"]) == pytest.approx((x, 0.5 * height), abs=1e-7 if precision == "single" else 1e-12)


@pytest.mark.parametrize(("solver", "precision"), BOTH)
@pytest.mark.parametrize("turned", [0.0, 0.5 * math.pi, 2.0])
@pytest.mark.parametrize("post_first", [True, False])
def test_spin_counts_towards_the_speed(solver: str, precision: str, turned: float, post_first: bool) -> None:
    # the end of a turning bar meets a post: w r + v, along the normal, whichever way the whole is turned
    def rotated(x: float, y: float) -> tuple[float, float]:
        return math.cos(turned) * x - math.sin(turned) * y, math.sin(turned) * x + math.cos(turned) * y

    world = World(tell_events=True, solver=solver, precision=precision, gravity=(0, 0))

    def add_post() -> None:
        world.create_body(Circle(0.1), position=rotated(1.4, -0.155), kind="static")

    if post_first:
        add_post()
    world.create_body(
        Box(3, 0.1), position=(0, 0), angle=turned, angular_velocity=-4, velocity=rotated(0, -0.5), friction=0
    )
    if not post_first:
        add_post()
    (hit,) = np.concatenate([events.hit for events in told(world, 3, 1 / 512)])
    side = 1 if post_first else -1
    assert (side * hit["nx"], side * hit["ny"]) == pytest.approx(rotated(0, 1), abs=0.05)
    assert (hit["x"], hit["y"]) == pytest.approx(rotated(1.4, -0.055), abs=0.03)
    assert hit["speed"] == pytest.approx(4 * 1.4 + 0.5, rel=0.02)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_contact_seen_ahead_is_no_touch(precision: str) -> None:
    world = World(tell_events=True, precision=precision, gravity=(0, 0))
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.515))
    world.step(DT)
    assert len(world.contact_records()) == 1
    assert not any(map(len, world.events)), "15 mm apart"
    ball.velocity = (0, -1.5)
    world.step(DT)
    assert pairs(world.events.begin) == [(0, 1)]
    assert world.events.hit["speed"] == 1.5
    ball.velocity = (0, 0.25)
    assert [pairs(events.end) for events in told(world, 3)] == [[], [], [(0, 1)]], "0, 4.2, 8.3 mm apart"


@pytest.mark.parametrize(("speed", "hits"), [(2.0, 0), (1.999, 1)])
def test_the_speed_that_makes_a_hit(speed: float, hits: int) -> None:
    world = World(tell_events=True, gravity=(0, 0), hit_speed=speed)
    floor(world)
    world.create_body(Circle(0.5), position=(0, 0.51), velocity=(0, -2))
    assert sum(len(events.hit) for events in told(world, 5)) == hits


def test_every_bounce_is_a_hit() -> None:
    world = World(tell_events=True, hit_speed=1.5)
    floor(world)
    world.create_body(Circle(0.25), position=(0, 2), restitution=0.5)
    found = glued(told(world, 240))
    speeds = found.hit["speed"]
    assert len(speeds) >= 2
    assert speeds[1:] / speeds[:-1] == pytest.approx(np.full(len(speeds) - 1, 0.5), abs=0.06)
    assert len(found.begin) >= len(speeds)


# --- against a difference of sets -------------------------------------------------------------------------------------

ACTIONS = st.lists(
    st.tuples(st.sampled_from(["step", "create", "destroy", "snapshot", "shove"]), st.integers(0, 1000)),
    min_size=5,
    max_size=25,
)


@settings(max_examples=25)
@given(actions=ACTIONS, case=st.sampled_from(BOTH))
def test_what_begins_ends_and_moves_is_the_difference(actions: list[tuple[str, int]], case: tuple[str, str]) -> None:
    world = toys(8, solver=case[0], precision=case[1])
    known: set[tuple[int, int]] = set()
    open_pairs: set[tuple[int, int]] = set()
    for action, number in actions:
        bodies = world.bodies
        if action == "create":
            world.create_body(Circle(0.3), position=(number % 5 - 2, 0.2 + number % 7 / 4), velocity=(0, -number / 300))
        elif action == "destroy":
            bodies[number % len(bodies)].destroy()  # the floor, too
        elif action == "shove":
            bodies[number % len(bodies)].position = (number % 5 - 2, number % 3)
        elif action == "snapshot":
            other = World(precision=case[1])
            other.restore(Snapshot.from_bytes(world.snapshot().to_bytes()))
            world = other
        for _ in range(6):
            if not world.body_count:
                return
            before = poses(world)
            world.step(DT)
            now, events = touching(world, known), world.events
            assert pairs(events.begin) == sorted(now - known)
            assert pairs(events.end) == sorted(known - now)
            assert not open_pairs & set(pairs(events.begin)), "begun twice"
            assert open_pairs >= set(pairs(events.end)), "ended without a beginning"
            open_pairs = open_pairs - set(pairs(events.end)) | set(pairs(events.begin))
            known = now
            assert set(pairs(events.hit)) <= set(pairs(events.begin))
            after = poses(world)
            moved = [(serial, *pose) for serial, pose in after.items() if pose != before[serial]]
            assert events.moved[["body", "x", "y", "angle"]].tolist() == moved
            for rows in events:
                assert (rows["step"] == world.step_count).all()


# --- of many steps, of copies, after a restore ------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_run_tells_what_its_steps_would(solver: str, threads: int) -> None:
    one, many, plain = toys(solver=solver), toys(solver=solver, threads=threads), toys(solver=solver)
    plain.tell_events = False
    expected = told(one, STEPS)
    many.run(STEPS - 7, DT)
    first = many.events
    many.run(7, DT)
    assert equal(first, glued(expected[:-7]))
    assert equal(many.events, glued(expected[-7:]))
    assert len(first.begin) > 30
    assert len(first.end) > 5
    assert len(first.hit) > 10
    assert (np.diff(first.begin["step"]) >= 0).all()
    plain.run(STEPS, DT)
    assert one.state_hash() == many.state_hash() == plain.state_hash(), "telling changes nothing"


def test_two_threads_tell_the_same() -> None:
    def make(threads: int) -> World:
        return toys(400, threads=threads)

    one, two = make(1), make(2)
    one.run(20, DT)
    two.run(20, DT)
    assert len(one.events.begin) > 10
    assert equal(one.events, two.events)


@pytest.mark.parametrize(("solver", "precision"), BOTH)
def test_a_restored_world_goes_on_telling_the_same(solver: str, precision: str) -> None:
    world = toys(solver=solver, precision=precision)
    world.run(60, DT)
    touched = next(a for a in world.arbiters if "static" not in (a.body1.kind, a.body2.kind))
    gone = touched.body2.serial
    touched.body2.destroy()  # of which the step after must tell
    taken = World(precision=precision)
    taken.restore(Snapshot.from_bytes(world.snapshot().to_bytes()))
    assert not any(map(len, taken.events)), "of the steps since"
    expected = told(world, 30)
    assert equal(glued(expected), glued(told(taken, 30)))
    assert any(gone in pair for pair in pairs(expected[0].end))
    earlier = world.events
    world.restore(taken.snapshot())
    assert len(earlier.moved), "copies stay"
    assert not any(map(len, world.events))


def test_switched_on_later_it_tells_what_changes_from_then_on() -> None:
    world = toys()
    world.run(STEPS, DT)
    plain = toys()
    plain.tell_events = False
    plain.run(STEPS, DT)
    plain.tell_events = True
    assert not any(map(len, plain.events))
    new, old = told(plain, 30), told(world, 30)
    # at rest within PARTING_DISTANCE a pair may be known to the one alone: it may end there, or begin here
    ends, begins = (glued(new).end, glued(old).end), (glued(new).begin, glued(old).begin)
    assert set(pairs(ends[0])) <= set(pairs(ends[1])) | set(pairs(begins[0]))
    assert set(pairs(begins[1])) <= set(pairs(begins[0]))
    plain.tell_events = False
    plain.step(DT)
    assert plain._state.happened.touching is None


def test_without_the_setting_it_is_refused() -> None:
    world = busy()
    world.step(DT)
    with pytest.raises(ValueError, match=r"^tell_events = False: must be True before the step whose events are to be "):
        _ = world.events
    assert "touching" not in world.snapshot().tables
    assert not any(status.called_for for status in world.effects if status.name == "events")
    world.tell_events = True
    assert [status.because for status in world.effects if status.name == "events"] == ["the setting tell_events"]
    assert not any(map(len, world.events))


def test_they_are_copies_that_nobody_can_change() -> None:
    world = toys()
    world.run(30, DT)
    events = world.events
    kept = [np.array(rows) for rows in events]
    for rows in events:
        assert not rows.flags.writeable
    world.run(30, DT)
    assert all(np.array_equal(rows, copy) for rows, copy in zip(events, kept, strict=True))
    world.run(0, DT)
    world.step(0.0)
    assert len(world.events.moved), "no time, nothing changed"


def test_pieces_of_chains_and_compounds_are_told_apart() -> None:
    world = gathering(tell_events=True)
    found = glued(told(world, STEPS))
    owners = dict(zip(world.shape_records()["serial"].tolist(), world.shape_records()["body"].tolist(), strict=True))
    serials = world.body_records()["serial"]
    for number in "12":
        assert all(serials[owners[int(row[f"shape{number}"])]] == row[f"body{number}"] for row in found.begin)
    assert len({tuple(row)[1:3] for row in found.begin}) > len({tuple(row)[3:5] for row in found.begin})


# --- what other parts of the engine note ------------------------------------------------------------------------------


def test_what_is_noted_is_told_with_the_step() -> None:
    world = toys(3)
    world.step(DT)
    note = world._state.happened
    note.note_fell_asleep([1, 2])
    note.note_woke(np.array([3]))
    note.note_woke(np.array([1]))
    note.note_broken(4, 0, 2, 12.5, 0.25)
    note.note_broken(7, 1, 2, 3.0, 0.0)
    assert not any(map(len, (world.events.fell_asleep, world.events.woke, world.events.broken)))
    world.step(DT)
    assert world.events.fell_asleep.tolist() == [(2, 1), (2, 2)]
    assert world.events.woke.tolist() == [(2, 1), (2, 3)], "in the order of creation"
    assert world.events.broken.tolist() == [(2, 4, 0, 2, 12.5, 0.25), (2, 7, 1, 2, 3.0, 0.0)]
    world.step(DT)
    assert not any(map(len, world.events[4:]))
    note.note_woke([1])
    world.restore(world.snapshot())
    world.step(DT)
    assert not len(world.events.woke), "of the steps since the restore alone"
    plain = busy()
    plain.step(DT)
    plain._state.happened.note_woke([1])
    plain.tell_events = True
    plain.step(DT)
    assert not len(plain.events.woke), "nobody had asked"


def test_empty_arrays_have_their_fields() -> None:
    assert World(tell_events=True).events.hit.dtype == HIT_EVENT
