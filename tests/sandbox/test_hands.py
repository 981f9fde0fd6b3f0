"""A hand pulls softly: quick to follow, bounded in force, stable for every mass and time step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Body, Box, Circle, World
from sandbox import commands as ask
from sandbox import hands
from sandbox.hands import Hand
from sandbox.scenes import Scene
from sandbox.simulation import Simulation
from tests.sandbox.watching import PRECISIONS

EMPTY = Scene("Test/Empty", lambda world: None, "", (0.0, 0.0, 10.0))
TIME_STEPS = (1 / 240, 1 / 60, 1 / 20)
MASSES = (1e-3, 1.0, 200.0, 1e6)


def held_box(
    mass: float, dt: float, anchor: tuple[float, float] = (0.3, 0.2), gravity: float = -10.0, precision: str = "single"
) -> tuple[Simulation, Body]:
    """A box alone in space, held by hand 1."""
    simulation = Simulation(EMPTY, dt, gravity=(0.0, gravity), precision=precision)
    box = simulation.world.create_body(Box(1, 1), position=(0, 0), mass=mass)
    simulation.apply(ask.Grab(1, *anchor))
    assert simulation.hands[1].serial == box.serial
    return simulation, box


def distance(simulation: Simulation, body: Body) -> float:
    """From the hand to the point it holds [m]."""
    hand = simulation.hands[1]
    x, y = hand.held_point(body)
    return math.hypot(x - hand.x, y - hand.y)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("dt", TIME_STEPS)
@pytest.mark.parametrize("mass", MASSES)
def test_brings_the_body_near_within_a_second(mass: float, dt: float, precision: str) -> None:
    simulation, box = held_box(mass, dt, (0.0, 0.0), precision=precision)
    simulation.apply(ask.MoveHand(1, 4.0, 3.0))
    for _ in range(round(1.0 / dt)):
        simulation.step()
    assert distance(simulation, box) < 0.07  # it sags: a step gives gravity after the pull, at 1/20 s 0.06 m
    # The pull comes once a step, gravity in each substep: at rest, the velocity goes up and down about zero in a step.
    assert math.hypot(*box.velocity) < 0.05 + 0.5 * 10.0 * dt


@pytest.mark.parametrize("dt", TIME_STEPS)
@pytest.mark.parametrize("mass", MASSES)
def test_held_off_its_centre_it_swings_near_the_hand(mass: float, dt: float) -> None:
    simulation, box = held_box(mass, dt)
    simulation.apply(ask.MoveHand(1, 4.0, 3.0))
    for _ in range(round(1.0 / dt)):
        simulation.step()
    for _ in range(round(5.0 / dt)):
        simulation.step()
        assert distance(simulation, box) < 0.25
        assert math.hypot(*box.velocity) < 6.0


@pytest.mark.parametrize("dt", TIME_STEPS)
def test_where_a_bodys_origin_is_makes_no_difference(dt: float) -> None:
    """Only its centre of mass does: held beside it, a body swings as one does that has its origin there."""
    runs = []
    for away in (0.0, 6.0):
        simulation = Simulation(EMPTY, dt, precision="double")
        body = simulation.world.create_body(Box(1, 1), position=(-away, 0.0), offset=(away, 0.0), mass=2.0)
        simulation.apply(ask.Grab(1, 0.3, 0.2))
        simulation.apply(ask.MoveHand(1, 4.0, 3.0))
        states = []
        for _ in range(round(2.0 / dt)):
            simulation.step()
            states.append((*body.center, *body.velocity, body.angular_velocity))
        runs.append(states)
    np.testing.assert_allclose(runs[0], runs[1], atol=1e-6)


@pytest.mark.parametrize("dt", TIME_STEPS)
def test_pulls_softly_not_at_once(dt: float) -> None:
    simulation, box = held_box(10.0, dt, gravity=0.0)
    simulation.apply(ask.MoveHand(1, 1.3, 0.2))
    simulation.step()
    assert 0.0 < box.position.x < 0.8


@pytest.mark.parametrize("dt", TIME_STEPS)
@pytest.mark.parametrize("mass", MASSES)
def test_force_is_bounded(mass: float, dt: float) -> None:
    """However far the hand is, and however it jerks: no step changes the velocity by more than the bound."""
    simulation, box = held_box(mass, dt, anchor=(0.0, 0.0), gravity=0.0)
    rng = np.random.default_rng(1)
    largest = 0.0
    for _ in range(60):
        simulation.apply(ask.MoveHand(1, *(float(x) for x in rng.uniform(-1e5, 1e5, 2))))
        before = box.velocity
        simulation.step()
        change = math.hypot(box.velocity.x - before.x, box.velocity.y - before.y)
        assert change <= hands.LARGEST_ACCELERATION * dt * 1.001
        largest = max(largest, change)
    assert largest > hands.LARGEST_ACCELERATION * dt * 0.99


@settings(max_examples=50)
@given(
    mass=st.floats(-3.0, 6.0).map(lambda power: 10.0**power),
    dt=st.floats(1 / 240, 1 / 20),
    size=st.sampled_from([(0.05, 0.05), (20.0, 0.05), (1.0, 1.0), (20.0, 20.0)]),
    corner=st.tuples(st.floats(-0.49, 0.49), st.floats(-0.49, 0.49)),
    path=st.lists(st.tuples(st.floats(-20, 20), st.floats(-20, 20)), min_size=1, max_size=6),
    spin=st.floats(-20.0, 20.0),
)
def test_never_blows_up(
    mass: float,
    dt: float,
    size: tuple[float, float],
    corner: tuple[float, float],
    path: list[tuple[float, float]],
    spin: float,
) -> None:
    """Held at a corner and waved about, a body calms down once the hand rests."""
    simulation = Simulation(EMPTY, dt, gravity=(0.0, 0.0))
    box = simulation.world.create_body(Box(*size), mass=mass, angular_velocity=spin)
    simulation.apply(ask.Grab(1, corner[0] * size[0], corner[1] * size[1]))
    fastest = 0.0
    for place in path:
        simulation.apply(ask.MoveHand(1, *place))
        for _ in range(8):
            simulation.step()
            fastest = max(fastest, math.hypot(*box.velocity))
    for _ in range(round(4.0 / dt)):
        simulation.step()
        fastest = max(fastest, math.hypot(*box.velocity))
    assert np.isfinite(simulation.world.positions).all()
    assert fastest < 1000.0 + 20.0 * max(size)
    assert distance(simulation, box) < 1.0 + 0.1 * max(size)  # flung about, it may still swing around the hand


@pytest.mark.parametrize("dt", TIME_STEPS)
@pytest.mark.parametrize("anchor", [(0.0, 0.0), (0.4, -0.3), (-0.5, 0.5)])
def test_is_an_implicit_spring(anchor: tuple[float, float], dt: float) -> None:
    """Catto's soft constraint: v + beta/h C + gamma P = 0 with the velocity that the impulse P leaves."""
    simulation = Simulation(EMPTY, dt, gravity=(0.0, 0.0), precision="double")
    box = simulation.world.create_body(Box(1, 1), mass=3.0, velocity=(0.7, -0.4), angular_velocity=1.5, angle=0.6)
    cosine, sine = box.direction
    point = (cosine * anchor[0] - sine * anchor[1], sine * anchor[0] + cosine * anchor[1])
    hand = Hand.on(box, point)
    hand.x, hand.y = hand.x + 0.11, hand.y - 0.07
    before = box.velocity
    hands.pull(hand, box, dt)
    impulse = [3.0 * (box.velocity.x - before.x), 3.0 * (box.velocity.y - before.y)]
    omega = 2 * math.pi * hands.FREQUENCY
    damper, spring = 2 * 3.0 * hands.DAMPING_RATIO * omega, 3.0 * omega**2
    gamma, rate = 1 / (dt * (damper + dt * spring)), spring / (damper + dt * spring)
    after = box.velocity_at(point)
    assert after.x + rate * -0.11 + gamma * impulse[0] == pytest.approx(0.0, abs=1e-12)
    assert after.y + rate * 0.07 + gamma * impulse[1] == pytest.approx(0.0, abs=1e-12)
    spun = box.inertia * (box.angular_velocity - 1.5)
    assert spun == pytest.approx(point[0] * impulse[1] - point[1] * impulse[0], abs=1e-12)


def test_heavy_and_light_follow_alike() -> None:
    paths = []
    for mass in (1e-3, 1e6):
        simulation, box = held_box(mass, 1 / 60, gravity=0.0, precision="double")
        simulation.apply(ask.MoveHand(1, 2.0, 1.0))
        path = []
        for _ in range(60):
            simulation.step()
            path.append((*box.position, box.angle))
        paths.append(path)
    assert np.allclose(paths[0], paths[1], atol=1e-9)


def test_holds_where_it_took_hold_on_a_turned_body() -> None:
    simulation = Simulation(EMPTY, gravity=(0.0, 0.0), precision="double")
    box = simulation.world.create_body(Box(2, 1), position=(3, 4), angle=0.7)
    point = (3.0 + 0.8 * math.cos(0.7), 4.0 + 0.8 * math.sin(0.7))
    hand = Hand.on(box, point)
    assert (hand.anchor_x, hand.anchor_y) == pytest.approx((0.8, 0.0))
    assert hand.held_point(box) == pytest.approx(point)
    box.angle = 0.7 + math.pi / 2
    assert hand.held_point(box) == pytest.approx((3.0 - 0.8 * math.sin(0.7), 4.0 + 0.8 * math.cos(0.7)))


def test_a_still_hand_on_a_still_body_does_nothing() -> None:
    simulation, box = held_box(10.0, 1 / 60, gravity=0.0, precision="double")
    for _ in range(10):
        simulation.step()
    assert box.position == (0.0, 0.0)
    assert box.velocity == pytest.approx((0.0, 0.0), abs=1e-15)


def test_pulling_at_a_corner_turns_the_body() -> None:
    simulation, box = held_box(10.0, 1 / 60, anchor=(0.5, 0.0), gravity=0.0)
    simulation.apply(ask.MoveHand(1, 0.5, 1.0))
    simulation.step()
    assert box.angular_velocity > 0.1


# --- what there is to hold --------------------------------------------------------------------------------------------


def scene_with_everything(world: World) -> None:
    world.create_body(Box(20, 2), position=(0, -1), kind="static")
    world.create_body(Box(1, 1), position=(0, 0.5))
    world.create_body(Circle(0.5), position=(3, 0.5))
    world.create_body(Box(1, 1), position=(0.5, 0.5))  # over the first


@pytest.mark.parametrize(
    ("point", "serial"),
    [((0.9, 0.5), 3), ((-0.4, 0.5), 1), ((0.25, 0.5), 3), ((3.0, 0.9), 2), ((3.45, 0.95), None), ((0.0, -1.0), None),
     ((9.0, 9.0), None), ((-1e5, 1e5), None)],
)  # fmt: skip
def test_takes_the_dynamic_body_on_top_under_the_point_if_any(point: tuple[float, float], serial: int | None) -> None:
    simulation = Simulation(Scene("Test/Everything", scene_with_everything, "", (0.0, 0.0, 10.0)))
    simulation.apply(ask.Grab(1, *point))
    held = simulation.hands.get(1)
    assert (held.serial if held else None) == serial


def test_a_hand_on_a_destroyed_body_lets_go() -> None:
    simulation, box = held_box(10.0, 1 / 60)
    other = simulation.world.create_body(Box(1, 1), position=(5, 0))
    simulation.apply(ask.Grab(2, 5.0, 0.0))
    box.destroy()
    simulation.step()
    assert list(simulation.hands) == [2]
    simulation.world.create_body(Box(1, 1), position=(0, 0))  # may come to the same place in memory
    simulation.apply(ask.MoveHand(1, 3.0, 3.0))
    before = simulation.world.bodies[-1].velocity.x
    simulation.step()
    assert simulation.world.bodies[-1].velocity.x == before
    assert simulation.hands[2].serial == other.serial


def test_a_new_body_in_the_destroyed_ones_place_is_not_held() -> None:
    simulation, box = held_box(10.0, 1 / 60, gravity=0.0)
    simulation.apply(ask.MoveHand(1, 3.0, 0.0))
    box.destroy()
    new = simulation.world.create_body(Box(1, 1), position=(0, 0))
    simulation.step()
    assert new.velocity == (0.0, 0.0)
    assert simulation.hands == {}


def test_two_hands_on_one_body_stretch_no_further_than_both() -> None:
    simulation, box = held_box(10.0, 1 / 60, anchor=(-0.4, 0.0), gravity=0.0)
    simulation.apply(ask.Grab(2, 0.4, 0.0))
    simulation.apply(ask.MoveHand(1, -3.0, 0.0))
    simulation.apply(ask.MoveHand(2, 3.0, 0.0))
    for _ in range(120):
        simulation.step()
    assert abs(box.position.x) < 0.05
    assert math.hypot(*box.velocity) < 0.05
