"""Colours: who is solved side by side shares no body that moves, and keeps its colour while it touches."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Box, Circle, World
from engine.colouring import (
    COLOURS,
    HELD_FROM,
    NONE,
    OVERFLOW,
    Layout,
    any_change,
    any_change_among,
    colour_joints,
    count_colours,
    give_colours,
)
from engine.tables import arbiter_dtype, empty, joint_dtype, motion_dtype
from tests.engine.worlds import DT, busy, floor, gathering, run

plain_too = pytest.mark.kernel

BODIES = 12

pair = st.tuples(st.integers(0, BODIES - 1), st.integers(0, BODIES - 1)).filter(lambda pair: pair[0] != pair[1])
pairs_of_bodies = st.lists(pair, max_size=60)


class Contacts:
    """Arbiters between bodies, some of which move."""

    def __init__(self, pairs: list[tuple[int, int]], moving: list[bool]) -> None:
        self.rows = empty(len(pairs), arbiter_dtype("single"))
        self.rows["body1"], self.rows["body2"] = np.array(pairs, np.int32).reshape(-1, 2).T
        self.rows["colour"] = NONE
        self.motions = empty(len(moving), motion_dtype("single"))
        self.move(moving)

    def move(self, moving: list[bool]) -> None:
        self.motions["inverse_mass"] = moving

    def touch(self, touching: list[bool]) -> list[int]:
        """Lets just these touch, and gives the colours after."""
        self.rows["count"] = touching
        everyone = np.arange(len(self.rows))
        give_colours(self.rows, everyone, self.motions, np.full(len(self.motions), -1))
        assert not any_change(self.rows, len(self.rows), everyone)
        return self.colours

    @property
    def colours(self) -> list[int]:
        return self.rows["colour"].tolist()

    def order(self, k: int) -> list[int]:
        """In which order colours are looked at for one: with what does not move from HELD_FROM on."""
        row = self.rows[k]
        held = not self.motions["inverse_mass"][[row["body1"], row["body2"]]].all()
        return [(c + held * HELD_FROM) % COLOURS for c in range(COLOURS)]

    def rivals(self, k: int) -> set[int]:
        """Colours of the others at the bodies of one that move."""
        row = self.rows[k]
        shared = {body for body in (int(row["body1"]), int(row["body2"])) if self.motions["inverse_mass"][body] > 0}
        return {
            int(other["colour"])
            for j, other in enumerate(self.rows)
            if j != k and other["colour"] != NONE and shared & {int(other["body1"]), int(other["body2"])}
        }

    def check(self) -> None:
        for k, row in enumerate(self.rows):
            if row["count"] == 0:
                assert row["colour"] == NONE, "a colour is given back"
            else:
                assert 0 <= row["colour"] <= OVERFLOW
                assert row["colour"] == OVERFLOW or row["colour"] not in self.rivals(k), f"arbiter {k}"


@plain_too
@given(data=st.data(), pairs=pairs_of_bodies)
def test_no_two_of_one_colour_share_a_body_that_moves(data: st.DataObject, pairs: list[tuple[int, int]]) -> None:
    def some(count: int) -> list[bool]:
        return data.draw(st.lists(st.booleans(), min_size=count, max_size=count))

    contacts = Contacts(pairs, some(BODIES))
    before = [NONE] * len(pairs)
    for _ in range(4):
        after = contacts.touch(some(len(pairs)))
        contacts.check()
        for k, (old, new) in enumerate(zip(before, after, strict=True)):
            if old != NONE and new != NONE:
                assert old == new, "it is kept, whoever comes and goes"
            elif new not in (NONE, OVERFLOW):
                order = contacts.order(k)
                assert set(order[: order.index(new)]) <= contacts.rivals(k), "the first that is free"
        before = after


@plain_too
@given(data=st.data(), pairs=pairs_of_bodies)
def test_a_body_that_begins_to_move_has_its_colours_mended(data: st.DataObject, pairs: list[tuple[int, int]]) -> None:
    moving = data.draw(st.lists(st.booleans(), min_size=BODIES, max_size=BODIES))
    contacts = Contacts(pairs, moving)
    before = contacts.touch([True] * len(pairs))
    contacts.move([True] * BODIES)
    after = contacts.touch([True] * len(pairs))
    contacts.check()
    for k, (old, new) in enumerate(zip(before, after, strict=True)):
        earlier = {before[j] for j in range(k) if set(pairs[j]) & set(pairs[k])}
        if old not in earlier:
            assert new == old, "one that does not stand in another's way is left alone"


@plain_too
def test_colours_of_a_row() -> None:
    row = [(k, k + 1) for k in range(BODIES - 1)]
    contacts = Contacts(row, [False] + [True] * (BODIES - 1))
    assert contacts.touch([True] * len(row)) == [HELD_FROM] + [0, 1] * 5
    assert contacts.touch([True, False] * 5 + [True]) == [HELD_FROM, NONE] + [1, NONE] * 4 + [1]
    assert contacts.touch([False, True] * 5 + [False]) == [NONE, 0] * 5 + [NONE], "what was given back is free"


@plain_too
def test_a_floor_may_have_as_many_of_a_colour_as_it_likes() -> None:
    count = 3 * COLOURS
    contacts = Contacts([(0, 1 + k) for k in range(count)], [False] + [True] * count)
    assert contacts.touch([True] * count) == [HELD_FROM] * count


@plain_too
def test_more_contacts_than_colours_overflow() -> None:
    count = COLOURS + 9
    contacts = Contacts([(0, 1 + k) for k in range(count)], [True] * (count + 1))
    assert contacts.touch([True] * count) == list(range(COLOURS)) + [OVERFLOW] * 9
    touching = [k != 4 for k in range(count)]
    parted = contacts.touch(touching)
    assert parted == [NONE if k == 4 else min(k, OVERFLOW) for k in range(count)], "who overflowed stays there"
    assert contacts.touch([True] * count)[4] == 4


@plain_too
@pytest.mark.parametrize("wrong", [-7, OVERFLOW + 1, 1000])
def test_a_colour_that_there_cannot_be_is_given_anew(wrong: int) -> None:
    # such as a row from a file may hold
    contacts = Contacts([(0, 1), (1, 2)], [True] * 3)
    contacts.rows["colour"] = [wrong, 1]
    assert contacts.touch([True, True]) == [0, 1]


@plain_too
@given(states=st.lists(st.tuples(st.integers(0, 2), st.integers(NONE, OVERFLOW)), max_size=20))
def test_any_change(states: list[tuple[int, int]]) -> None:
    rows = empty(len(states), arbiter_dtype("single"))
    for k, (count, colour) in enumerate(states):
        rows["count"][k], rows["colour"][k] = count, colour
    for count in range(len(states) + 1):
        expected = any((touches > 0) != (colour >= 0) for touches, colour in states[:count])
        assert bool(any_change(rows, count, np.empty(0, np.int64))) == expected
        some = np.arange(count % 3, count)
        expected = any((touches > 0) != (colour >= 0) for touches, colour in states[count % 3 : count])
        assert bool(any_change_among(rows, count, some)) == expected


@plain_too
@given(data=st.data(), pairs=pairs_of_bodies)
def test_joints_are_coloured_in_their_order(data: st.DataObject, pairs: list[tuple[int, int]]) -> None:
    order = np.array(data.draw(st.permutations(range(len(pairs)))), np.int64)
    moving = data.draw(st.lists(st.booleans(), min_size=BODIES, max_size=BODIES))
    joints, colours = empty(len(pairs), joint_dtype("single")), np.full(len(pairs), 99, np.int32)
    joints["body1"], joints["body2"] = np.array(pairs, np.int64).reshape(-1, 2).T
    contacts = Contacts([pairs[row] for row in order], moving)
    colour_joints(joints, order, contacts.motions, np.full(BODIES, -1), colours)
    assert colours.tolist() == contacts.touch([True] * len(pairs))


# --- blocks ----------------------------------------------------------------------------------------------------------

colour_lists = st.lists(st.integers(NONE, OVERFLOW) | st.sampled_from([0, 0, 1, OVERFLOW]), max_size=150)


@plain_too
@pytest.mark.parametrize("width", [1, 8])
@given(colours=colour_lists, before=colour_lists)
def test_blocks_hold_everybody_once(width: int, colours: list[int], before: list[int]) -> None:
    layout, nothing = Layout(), -5
    layout.arrange(np.array(before, np.int32), width, nothing)  # nothing of it may be left
    layout.arrange(np.array(colours, np.int32), width, nothing)
    assert layout.sizes.tolist() == [colours.count(colour) for colour in range(COLOURS + 1)]
    assert layout.firsts[0] == 0
    assert layout.blocks == layout.firsts[COLOURS + 1]
    blocks = layout.slots.reshape(layout.blocks, width).tolist()
    found = []
    for colour in range(COLOURS + 1):
        mine = blocks[layout.firsts[colour] : layout.firsts[colour + 1]]
        at_once = 1 if colour == OVERFLOW else width  # what overflowed is solved one by one
        members = [k for k, other in enumerate(colours) if other == colour]
        assert len(mine) == -(-len(members) // at_once), "no block more than it takes"
        filled = [slot for block in mine for slot in block[:at_once]]
        assert filled == members + [nothing] * (len(filled) - len(members)), "in their order, then nobody"
        assert all(slot == nothing for block in mine for slot in block[at_once:])
        found += [slot for slot in filled if slot != nothing]
    assert sorted(found) == [k for k, colour in enumerate(colours) if colour >= 0]


@plain_too
def test_counting() -> None:
    sizes = np.full(COLOURS + 1, 7)
    count_colours(np.array([0, 3, NONE, OVERFLOW, 3], np.int32), sizes)
    assert sizes.tolist() == [1, 0, 0, 2] + [0] * (COLOURS - 4) + [1]


# --- worlds ----------------------------------------------------------------------------------------------------------


def arbiters(world: World) -> Any:
    table = world._state.arbiters
    return table.rows[: table.count]


def colours_of(world: World) -> dict[tuple[int, int], int]:
    """Colours of those that touch, by the serials of their shapes."""
    rows = arbiters(world)
    return {(int(row["serial1"]), int(row["serial2"])): int(row["colour"]) for row in rows if row["count"] > 0}


def check(world: World) -> None:
    """No two contacts of one colour share a body that moves; and the blocks are those of the colours."""
    state = world._state
    rows, masses = arbiters(world), state.bodies.tables["motions"]["inverse_mass"]
    users = defaultdict(set)
    for k, row in enumerate(rows):
        assert (row["count"] > 0) == (row["colour"] >= 0)
        if 0 <= row["colour"] < OVERFLOW:
            for body in (int(row["body1"]), int(row["body2"])):
                if masses[body] > 0:
                    users[body, int(row["colour"])].add(k)
    assert all(len(arbiters) == 1 for arbiters in users.values())
    slots = state.layout.slots
    assert sorted(slots[slots != state.arbiters.nothing].tolist()) == np.flatnonzero(rows["colour"] >= 0).tolist()
    assert state.arbiters.rows["colour"][state.arbiters.nothing] == NONE


@pytest.mark.parametrize("make", [busy, gathering])
def test_colours_of_a_world_that_changes(make) -> None:
    world = make("single", sleeping=False)
    seen: dict[tuple[int, int], int] = {}
    for step in range(90):
        if step == 30:
            world.bodies[3].destroy()
            for k in range(8):
                world.create_body(Circle(0.2), position=(-1 + 0.3 * k, 2.5), velocity=(0, -3))
        if step == 60:
            world.bodies[-4].destroy()
        world.step(DT)
        check(world)
        now = colours_of(world)
        assert all(now[key] == seen[key] for key in now.keys() & seen.keys()), "kept until they part"
        seen = now


def heap() -> World:
    """Boxes and circles that fall on each other."""
    world = World()
    floor(world)
    for k in range(24):
        shape = Box(0.5, 0.5) if k % 3 else Circle(0.3)
        world.create_body(shape, position=(0.55 * (k % 4) - 1 + 0.1 * (k // 4), 0.3 + 0.6 * (k // 4)))
    return world


def test_a_restored_snapshot_goes_on_with_its_colours() -> None:
    world = run(heap(), 60)
    snapshot, colours = world.snapshot(), colours_of(world)
    assert len(set(colours.values())) > 2
    after = [(run(world, 1).state_hash(), colours_of(world)) for _ in range(40)]
    world.restore(snapshot)
    assert colours_of(world) == colours
    assert [(run(world, 1).state_hash(), colours_of(world)) for _ in range(40)] == after
    other = World()
    other.restore(snapshot)
    assert [(run(other, 1).state_hash(), colours_of(other)) for _ in range(40)] == after


def one_by_one(world: World) -> World:
    """Lets a world solve one contact at a time."""
    world._state.lanes = 1
    world._state.stale = True
    return world


def raft() -> World:
    """Sixty small boxes on a large one that moves: more than it has colours."""
    world = World(sleeping=False)
    floor(world)
    world.create_body(Box(20, 1), position=(0, 0.499), velocity=(0.5, 0))
    for k in range(60):
        world.create_body(Box(0.25, 0.25), position=(-9 + 0.3 * k, 1.12), friction=0.8)
    return world


def test_more_contacts_than_colours_are_solved_all_the_same() -> None:
    world, single = raft(), one_by_one(raft())
    for step in range(60):
        run(world, 1)
        run(single, 1)
        assert world.state_hash() == single.state_hash(), f"step {step + 1}"
        check(world)
    sizes = world._state.layout.sizes
    assert sizes[OVERFLOW] == 61 - COLOURS, "sixty on it, and the floor below"
    assert all(size == 1 for size in sizes[:COLOURS])
    assert max(abs(body.position[1] - 1.125) for body in world.bodies[2:]) < 0.01, "nothing sinks, nothing jumps"
    assert max(abs(body.angle) for body in world.bodies) < 0.01
