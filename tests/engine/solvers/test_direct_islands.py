"""direct solves each island by itself: many things in one world go bit for bit as one of them alone."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from engine import Body, Box, Circle, Joint, TooLarge, World
from engine.solvers.direct import MOST_ROWS, islands
from tests.engine.worlds import DT, floor

COPIES = 4
Thing = list[Body | Joint]
Place = Callable[[World, Body, dict], Thing]


def stack(world: World, ground: Body, own: dict) -> Thing:
    """Put down askew, so that it rocks and friction acts."""
    return [
        world.create_body(Box(1, 1), position=(0.03 * k, 0.52 + 1.01 * k), angle=0.02, friction=0.5, **own)
        for k in range(3)
    ]


def pendulum(world: World, ground: Body, own: dict) -> Thing:
    """Of two links, so that positions take several rounds of Newton's method."""
    arm = world.create_body(Box(1, 0.1), position=(0.5, 3), **own)
    bob = world.create_body(Circle(0.2), position=(1.5, 3), **own)
    upper = world.create_joint_revolute(ground, arm, anchor=(0, 3), collide_connected=False)
    lower = world.create_joint_revolute(arm, bob, anchor=(1, 3), collide_connected=False)
    return [arm, bob, upper, lower]


def ball(world: World, ground: Body, own: dict) -> Thing:
    """It bounces to and fro under a ceiling, every few steps."""
    world.create_body(Box(100, 1), position=(0, 1.3), kind="static", **own)
    return [world.create_body(Circle(0.3), position=(0, 0.45), velocity=(1, -5), restitution=1, **own)]


def sprung(world: World, ground: Body, own: dict) -> Thing:
    """Two boxes linked by a spring alone, which positions do not hold: overlapping the floor, both are projected."""
    boxes = [world.create_body(Box(0.5, 0.5), position=(x, 0.23), friction=0.5, **own) for x in (-0.6, 0.6)]
    ends = {"anchor1": (-0.6, 0.23), "anchor2": (0.6, 0.23)}
    return [*boxes, world.create_joint_distance(*boxes, **ends, hertz=3, damping_ratio=0.1, length=1)]


PLACES = {place.__name__: place for place in (stack, pendulum, ball, sprung)}


def filled(places: list[Place], precision: str) -> tuple[World, list[Thing]]:
    """All in the same place, on one floor; what is of one of them does not meet what is of another."""
    world = World(solver="direct", precision=precision)
    ground = floor(world, 0.5)
    own = [{"category": 2 << k, "mask": 1 | 2 << k} for k in range(len(places))]
    return world, [place(world, ground, one) for place, one in zip(places, own, strict=True)]


def state_of(thing: Thing) -> list[tuple]:
    return [
        (*one.force, one.torque)
        if isinstance(one, Joint)
        else (*one.position, one.angle, *one.velocity, one.angular_velocity)
        for one in thing
    ]


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("name", PLACES)
def test_copies_go_bit_for_bit_as_one_by_itself(name: str, precision: str) -> None:
    one, (alone,) = filled([PLACES[name]], precision)
    world, copies = filled([PLACES[name]] * COPIES, precision)
    for _ in range(40):
        one.step(DT)
        world.step(DT)
        for copy in copies:
            assert state_of(copy) == state_of(alone)


def test_different_things_do_not_disturb_each_other() -> None:
    # they bounce, and are projected, at different times
    world, things = filled([*PLACES.values()], "double")
    others = [filled([place], "double") for place in PLACES.values()]
    for _ in range(40):
        world.step(DT)
        for copy, (other, (alone,)) in zip(things, others, strict=True):
            other.step(DT)
            assert state_of(copy) == state_of(alone)


@pytest.mark.kernel
def test_an_island_is_marked_by_any_of_its_rows() -> None:
    two = islands.Islands(np.array([0, 2, 1, 3]), np.array([0, 2, 4]))
    for k, expected in enumerate(([True, False], [False, True], [True, False], [False, True])):
        assert islands.with_any(two, np.arange(4) == k).tolist() == expected
    assert not islands.with_any(two, np.zeros(4, bool)).any()


# --- the bound --------------------------------------------------------------------------------------------------------


def chain(world: World, count: int, y: float) -> list[Body]:
    """So many discs, each on a rod to the next: a row each but for the last."""
    discs = [world.create_body(Circle(0.1), position=(0.5 * k, y), density=1) for k in range(count)]
    for before, after in itertools.pairwise(discs):
        world.create_joint_distance(before, after, anchor1=before.position, anchor2=after.position)
    return discs


def test_the_bound_is_that_of_the_largest_island() -> None:
    world = World(solver="direct", precision="double", gravity=(0, 0))
    for k in range(4):
        ends = chain(world, MOST_ROWS // 2 + 1, 2.0 * k)
    world.step(DT)  # four of half the size
    upper = chain(world, MOST_ROWS // 2, 8.0)
    joint = (*ends[:1], *upper[:1])
    world.create_joint_distance(*joint, anchor1=ends[0].position, anchor2=upper[0].position)
    world.step(DT)  # one of just the size
    world.create_joint_distance(*joint, anchor1=ends[0].position, anchor2=upper[0].position, hertz=1)
    before = world.positions.copy(), world.velocities.copy(), world.step_count
    with pytest.raises(
        TooLarge, match=rf"^step 3, .* {MOST_ROWS} rows in an island .* the largest has {MOST_ROWS + 1}:"
    ):
        world.step(DT)
    assert np.array_equal(world.positions, before[0])
    assert np.array_equal(world.velocities, before[1])
    assert world.step_count == before[2]


@pytest.mark.parametrize("kind", ["static", "kinematic"])
def test_what_no_impulse_moves_links_nothing(kind: str) -> None:
    world = World(solver="direct", precision="double")
    ground = world.create_body(Box(200, 1), position=(0, -0.5), kind=kind)
    for k in range(MOST_ROWS // 4 + 1):  # four rows each: all together too many
        box = world.create_body(Box(0.5, 0.5), position=(-40 + 0.6 * k, 0.25))
        if k % 2:
            world.create_joint_revolute(ground, box, anchor=tuple(box.position))
    world.step(DT)
    assert np.abs(world.velocities).max() < 1e-12


def test_what_shifts_but_does_not_turn_links() -> None:
    world = World(solver="direct", precision="double", gravity=(0, 0))
    for k in range(MOST_ROWS + 1):
        world.create_body(Circle(0.5), position=(k, 0), fixed_rotation=bool(k % 2))
    with pytest.raises(TooLarge, match=f"the largest has {2 * MOST_ROWS}"):
        world.step(DT)
