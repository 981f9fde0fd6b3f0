"""Nothing fast goes through static geometry, whatever its speed, thinness or spin."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from engine import Body, Box, Capsule, Chain, Circle, Segment, World
from tests.engine.continuous.rooms import HALF, ROOMS, THROWN, core_points, outside, throw
from tests.engine.worlds import DT, PRECISIONS, floor, run

SUNK = 0.02
"""How far a corner may be in a wall [m]: 5 mm is what stops it, and half as much more in each step until contacts push
it out; they are soft."""


def furthest(body: Body, steps: int) -> float:
    """How far it is out of its room in any of the steps [m]."""
    worst = -math.inf
    for _ in range(steps):
        body.world.step(DT)
        worst = max(worst, outside(body))
    return worst


@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("name", THROWN)
def test_nothing_gets_out_of_a_room(room: str, name: str) -> None:
    rng = np.random.default_rng([*room.encode(), *name.encode()])
    for speed, restitution in ((10.0, 0.5), (100.0, 0.0), (400.0, 1.0), (1000.0, 0.5)):
        world = World()
        ROOMS[room](world)
        turn = rng.uniform(0, 2 * math.pi)
        body = throw(
            world, name, position=rng.uniform(-2, 2, 2), angle=rng.uniform(0, 6), restitution=restitution,
            velocity=(speed * math.cos(turn), speed * math.sin(turn)), angular_velocity=rng.uniform(-60, 60),
        )  # fmt: skip
        assert furthest(body, 40) < SUNK, f"{speed} m/s"


def test_a_ball_never_gets_out_of_a_closed_room() -> None:
    for room, radius in (("thin boxes", 0.05), ("many segments", 0.005)):
        world = World(gravity=(0, 0))
        ROOMS[room](world)
        body = world.create_body(Circle(radius), velocity=(600, 800), restitution=1.0, friction=0.0)
        assert furthest(body, 600) < 0.0, "not even its centre touches the wall"
        assert math.hypot(*body.velocity) == pytest.approx(1000.0, rel=1e-3)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_without_it_they_do_get_out(precision: str) -> None:
    # what the tests above are worth
    for name in THROWN:
        world = World(precision=precision, continuous=False)
        ROOMS["thin boxes"](world)
        body = throw(world, name, velocity=(800, 600), angular_velocity=30.0)
        assert furthest(body, 5) > 1.0, name


@pytest.mark.parametrize("spin", [20.0, -60.0])
def test_a_spinning_rod_on_a_floor_does_not_sink_through(spin: float) -> None:
    for shape in (Box(2, 0.004), Capsule(2, 0.002), Box(0.5, 0.02)):
        for ground in (Box(100, 0.01), Segment((-50, 0), (50, 0)), Chain(((-50, 0), (0, 0), (50, 0)))):
            world = World()
            world.create_body(ground, kind="static", position=(0, -0.005 if isinstance(ground, Box) else 0))
            rod = world.create_body(shape, position=(0, 1.2), angular_velocity=spin, velocity=(0, -30), friction=0.4)
            for _ in range(120):
                world.step(DT)
                assert core_points(rod)[:, 1].min() > -SUNK


def test_a_bullet_through_the_gap_between_two_walls_and_one_that_does_not_fit() -> None:
    for radius, passes in ((0.049, True), (0.052, False)):
        world = World(gravity=(0, 0))
        for y in (-1.05, 1.05):
            world.create_body(Box(0.01, 2), position=(3, y), kind="static")
        ball = world.create_body(Circle(radius), velocity=(700, 0), friction=0.0)
        run(world, 3)
        assert (ball.position.x > 20) == passes
        if passes:
            assert tuple(ball.velocity) == (700.0, 0.0)


@pytest.mark.parametrize("gap", [0.002, 0.005, 0.015])
def test_contacts_ahead_do_not_turn_away_what_misses(gap: float) -> None:
    for spot in np.linspace(-0.03, 0.3, 7):
        world = World(gravity=(0, 0))
        world.create_body(Box(1, 1), position=(0.5, -0.5), kind="static")
        ball = world.create_body(Circle(0.1), position=(-spot, 0.1 + gap), velocity=(500, 0), friction=0.0)
        run(world, 2)
        assert tuple(ball.velocity) == (500.0, 0.0)


def test_a_chain_stops_from_its_front_and_lets_through_from_behind() -> None:
    for speed, passes in ((-300.0, False), (300.0, True)):
        world = World(gravity=(0, 0))
        world.create_body(Chain(((-9, 0), (-0.5, 0), (9, 0))), kind="static")
        for shape in (Circle(0.1), Box(0.2, 0.2), Capsule(0.3, 0.01)):
            ball = world.create_body(shape, position=(0, -math.copysign(2.0, speed)), velocity=(0, speed))
            run(world, 4)
            assert (math.copysign(1.0, ball.position.y) == math.copysign(1.0, speed)) == passes
            ball.destroy()


def test_it_stops_where_it_touches_and_keeps_its_velocity() -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_body(Box(0.001, 9), position=(5, 0), kind="static")
    ball = world.create_body(Circle(0.1), velocity=(1000, 120), angular_velocity=3.0)
    world.step(DT)
    assert ball.position.x == pytest.approx(5 - 0.0005 - 0.1, abs=1e-9)
    assert ball.position.y == pytest.approx(0.12 * ball.position.x, abs=1e-9)
    assert ball.angle == pytest.approx(3e-3 * ball.position.x, abs=1e-9)
    assert tuple(ball.velocity) == (1000.0, 120.0)


@pytest.mark.parametrize("speed", [50.0, 1000.0])
def test_a_bounce_keeps_the_speed(speed: float) -> None:
    world = World(gravity=(0, 0), precision="double")
    for x in (-7, 7):
        world.create_body(Segment((x, -9), (x, 9)), kind="static")
    ball = world.create_body(Circle(0.1), velocity=(speed, 0), restitution=1.0)
    for _ in range(100):
        world.step(DT)
        assert abs(ball.velocity.x) == pytest.approx(speed, rel=1e-6)
    assert abs(ball.position.x) < 7


def test_what_meets_nothing_keeps_its_speed() -> None:
    world = World(gravity=(0, 0))
    floor(world)
    ball = world.create_body(Circle(0.1), position=(0, 5), velocity=(1000, 0))
    run(world, 60)
    assert tuple(ball.velocity) == (1000.0, 0.0)
    assert ball.position.x == pytest.approx(1000.0, rel=1e-6)


@pytest.mark.parametrize("ground", ["box", "boxes", "segments", "chain"])
def test_what_slides_fast_goes_on_sliding(ground: str) -> None:
    world = World(restitution_threshold=1.0)
    marks = np.linspace(-10, 1000, 102)
    if ground == "box":
        world.create_body(Box(2100, 2), position=(0, -1), kind="static", friction=0.0)
    elif ground == "boxes":
        for x in marks:
            world.create_body(Box(10, 2), position=(x, -1), kind="static", friction=0.0)
    elif ground == "segments":
        body = world.create_body(kind="static")
        for a, b in itertools.pairwise(marks):
            body.add_shape(Segment((a, 0), (b, 0)), friction=0.0)
    else:
        world.create_body(Chain(tuple((x, 0.0) for x in marks)), kind="static", friction=0.0)
    shapes = (Box(1, 0.5), Circle(0.25), Capsule(0.5, 0.25))
    bodies = [world.create_body(s, position=(4 * k, 0.25), friction=0.0) for k, s in enumerate(shapes)]
    run(world, 30)
    starts = [body.position.x for body in bodies]
    speed = 300.0 if ground == "segments" else 900.0  # the ends of segments are felt: that is what chains are for
    for body in bodies:
        body.velocity = (speed, 0)
    run(world, 60)
    for body, start in zip(bodies, starts, strict=True):
        assert body.velocity.x == pytest.approx(speed, rel=1e-4 if ground == "segments" else 1e-6)
        assert body.position.x - start == pytest.approx(speed, rel=1e-4), "no part of its way is lost"
        assert abs(body.position.y - 0.25) < 0.01


def test_filters_and_joints_that_let_pass_are_respected() -> None:
    world = World(gravity=(0, 0))
    wall = world.create_body(Box(0.1, 9), position=(3, 0), kind="static", category=2)
    masked = world.create_body(Circle(0.1), position=(0, 0), velocity=(900, 0), mask=1)
    grouped = world.create_body(Circle(0.1), position=(0, 1), velocity=(900, 0), group=-1)
    wall.shapes[0].group = -1
    joined = world.create_body(Circle(0.1), position=(0, 2), velocity=(900, 0))
    held = world.create_body(Circle(0.1), position=(0, 3), velocity=(900, 0))
    world.create_joint_revolute(wall, joined, anchor=(0, 2), softness=1e9, collide_connected=False)
    world.step(DT)
    assert min(masked.position.x, grouped.position.x, joined.position.x) > 10
    assert held.position.x < 3


def test_a_kinematic_body_stops_it_and_carries_it_on() -> None:
    world = World(gravity=(0, 0))
    plate = world.create_body(Box(0.02, 9), position=(5, 0), kind="kinematic", velocity=(-30, 0))
    ball = world.create_body(Circle(0.05), velocity=(600, 0), restitution=1.0)
    world.step(DT)
    assert ball.position.x == pytest.approx(plate.position.x - 0.06, abs=1e-4)
    run(world, 2)
    assert ball.velocity.x == pytest.approx(-660.0, rel=1e-4)
    assert ball.position.x < plate.position.x


def test_only_soft_step_and_only_where_it_is_asked_for() -> None:
    for settings in ({"solver": "sequential_impulses"}, {"continuous": False}):
        world = World(gravity=(0, 0), **settings)
        world.create_body(Box(0.1, 9), position=(HALF, 0), kind="static")
        ball = world.create_body(Circle(0.1), velocity=(1000, 0))
        assert "continuous collision" not in {effect.name for effect in world.effects if effect.called_for}
        world.step(DT)
        assert ball.position.x > 10
