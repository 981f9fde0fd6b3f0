"""Eight contacts at once or one at a time: the same bits, after every step."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from engine import EFFECTS, Box, Capsule, Circle, World
from engine.simd import WIDTH
from tests.engine import tiny_worlds
from tests.engine.worlds import DT, busy, floor, gathering, tables_of

STEPS = 40


def pyramid(world: World) -> None:
    """More contacts of a colour than eight, and not a multiple of it."""
    floor(world)
    for row in range(6):
        for k in range(6 - row):
            world.create_body(Box(0.5, 0.5), position=(0.6 * k + 0.3 * row, 0.3 + 0.55 * row))


def marbles(world: World) -> None:
    """Circles in a trough: one contact each, so that the second is nobody's."""
    floor(world)
    for side in (-1, 1):
        world.create_body(Box(6, 0.5), position=(2.4 * side, 1.0), angle=0.6 * side, kind="static")
    for k in range(30):
        world.create_body(Circle(0.15 + 0.01 * (k % 4)), position=(0.35 * (k % 7) - 1, 1.2 + 0.4 * (k // 7)))


def chained(world: World) -> None:
    """A chain of joints, some soft, with a motor at its end that turns a paddle among balls."""
    floor(world)
    pin = world.create_body(Box(0.2, 0.2), position=(0, 4), kind="static")
    bodies = [pin]
    for k in range(11):
        bodies.append(world.create_body(Capsule(0.3, 0.08), position=(0.2 + 0.4 * k, 4), angle=0.05 * k))
    for k, (a, b) in enumerate(pairwise(bodies)):
        world.create_joint_revolute(a, b, anchor=(0.4 * k, 4), softness=0.05 * (k % 3 == 1))
    hub = world.create_body(Circle(0.2), position=(-2, 0.8), kind="static")
    paddle = world.create_body(Box(1.6, 0.2), position=(-2, 0.8), mass=3)
    world.create_joint_revolute(hub, paddle, anchor=(-2, 0.8), motor_speed=4.0, max_motor_torque=60.0)
    for k in range(6):
        world.create_body(Circle(0.15), position=(-2.6 + 0.25 * k, 1.3))


def bouncing(world: World) -> None:
    """Restitution, rolling resistance and a belt, on many at once."""
    floor(world, tangent_speed=0.8, restitution=0.1)
    for k in range(12):
        world.create_body(
            Circle(0.2), position=(0.45 * k, 0.3 + 0.05 * k), velocity=(1, -3), restitution=0.1 * (k % 9),
            rolling_resistance=0.05 * (k % 4),
        )  # fmt: skip
    for k in range(5):
        world.create_body(Box(0.4, 0.3), position=(0.6 * k, 1.6), restitution=0.5, tangent_speed=-0.3 * k)


def damped(world: World) -> None:
    """Eleven bodies: eight and three that share their lanes with nobody."""
    floor(world)
    for k in range(11):
        world.create_body(
            Box(0.4, 0.4), position=(0.5 * k, 0.5 + 0.1 * k), angular_velocity=k, velocity=(0.2 * k, 0),
            linear_damping=0.3 * k, angular_damping=0.1 * k, gravity_scale=1 - 0.1 * k,
        )  # fmt: skip
    world.bodies[3].apply_force((30, 20), (0.9, 0.9))


def pressed(world: World, rise: float = 0.1, spin: float = 0.05) -> None:
    """A kinematic plate and bodies that do not turn: many push one that nothing moves."""
    floor(world)
    plate = world.create_body(Box(8, 0.3), position=(2, 0.2), kind="kinematic", velocity=(0.5, rise))
    plate.angular_velocity = spin
    for k in range(12):
        world.create_body(Circle(0.15), position=(0.4 * k - 0.2, 0.5 + 0.01 * k), velocity=(0.3 * (-1) ** k, -1))
        world.create_body(Box(0.3, 0.3), position=(0.4 * k, 0.9), angle=0.1 * k, fixed_rotation=True)


WORLDS: dict[str, Callable[[World], None]] = {
    build.__name__: build for build in (pyramid, marbles, chained, bouncing, damped, pressed)
}
WORLDS |= {name: tiny_worlds.WORLDS[name] for name in ("boxes", "circles", "joined", "compounds", "driven", "lively")}
SETTINGS: dict[str, dict[str, Any]] = {
    "pyramid": {"iterations": 2},
    "marbles": {"warm_starting": False},
    "chained": {"iterations": 3, "substeps": 2},
    "joined": {"warm_starting": False},
    "bouncing": {"position_correction": False, "restitution_threshold": 0.1},
}
CASES = {name: (build, {}) for name, build in WORLDS.items()} | {
    f"{name}, {', '.join(map(str, change))}": (WORLDS[name], change) for name, change in SETTINGS.items()
}


def solve_one_at_a_time(world: World) -> World:
    world._state.lanes = 1
    world._state.stale = True
    return world


def force(world: World) -> World:
    """Runs the code of every effect: compiled once for each precision and width, not once a world."""
    world._state.forced = frozenset(effect.name for effect in EFFECTS)
    world._state.stale = True
    return world


def compare(make: Callable[[], World], steps: int = STEPS) -> World:
    eight, one = make(), solve_one_at_a_time(make())
    assert eight._state.lanes == WIDTH
    for step in range(steps):
        eight.step(DT)
        one.step(DT)
        a, b = tables_of(eight), tables_of(one)
        assert [name for name in a if a[name] != b[name]] == [], f"tables that differ after step {step + 1}"
        assert eight.state_hash() == one.state_hash()
    assert one._state.scratch["constraints"]["nx"].ndim == 1, "it really was one at a time"
    assert eight._state.scratch["constraints"]["nx"].shape[1:] == (WIDTH,)
    assert all(math.isfinite(value) for value in eight.positions.ravel())
    return eight


@pytest.mark.parametrize("title", CASES)
def test_eight_at_once_give_the_bits_of_one_at_a_time(title: str) -> None:
    build, settings = CASES[title]

    def make() -> World:
        world = World(**settings)
        build(world)
        return force(world)

    world = compare(make)
    assert len(world.contact_records()) > 0 or len(world.joint_records()) > 0


# Many write the row of what no impulse moves, all the same numbers; v - 0 * push keeps v but for the sign of a zero.
def test_a_velocity_of_minus_zero_stays_the_same_whoever_writes_it_last() -> None:
    def make() -> World:
        world = World()
        pressed(world, rise=-0.0, spin=-0.0)
        return force(world)

    compare(make, steps=3)


@pytest.mark.parametrize("make", [busy, gathering])
def test_in_double_precision_too(make: Callable[[str], World]) -> None:
    compare(lambda: make("double"))


@pytest.mark.parametrize("name", ["pyramid", "marbles", "circles"])
def test_without_the_code_of_effects_that_nothing_calls_for(name: str) -> None:
    def make() -> World:
        world = World()
        WORLDS[name](world)
        return world

    compare(make)


def test_a_world_may_change_its_width_between_steps() -> None:
    world, other = World(), World()
    for each in (world, other):
        pyramid(each)
    for step in range(12):
        other._state.lanes = 1 if step % 3 else WIDTH
        other._state.stale = True
        world.step(DT)
        other.step(DT)
        assert world.state_hash() == other.state_hash(), f"step {step + 1}"
