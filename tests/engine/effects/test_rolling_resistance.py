"""Rolling resistance: a moment of at most c R N against turning."""

from __future__ import annotations

import math

import pytest

from engine import Box, Capsule, Circle, World
from tests.engine.worlds import DT, PRECISIONS, floor, run

G = 10.0


def tilted(angle: float, precision: str = "double") -> World:
    world = World(gravity=(G * math.sin(angle), -G * math.cos(angle)), precision=precision)
    floor(world, friction=1.0)
    return world


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("radius", [0.25, 1.0])
@pytest.mark.parametrize("c", [0.05, 0.1, 0.3])
def test_a_disc_slows_down_with_two_thirds_of_c_g(c: float, radius: float, precision: str) -> None:
    # m dv/dt = -f, m R^2/2 dw/dt = f R - c R m g, v = w R
    world = tilted(0.0, precision)
    ball = world.create_body(
        Circle(radius), position=(0, radius), velocity=(4, 0), angular_velocity=-4 / radius, friction=1,
        rolling_resistance=c,
    )  # fmt: skip
    run(world, 60)
    assert 4 - ball.velocity.x == pytest.approx(2 / 3 * c * G, rel=0.02, abs=0.01)
    stop = 4 / (2 / 3 * c * G)
    run(world, math.ceil(stop * 60) + 5)
    assert ball.velocity.x == pytest.approx(0.0, abs=1e-4)
    assert ball.angular_velocity == pytest.approx(0.0, abs=1e-3)
    assert ball.position.x == pytest.approx(4 * stop / 2, rel=0.03)


@pytest.mark.parametrize("c", [0.1, 0.3])
def test_a_disc_on_a_slope_stays_or_rolls(c: float) -> None:
    # it stays while tan(angle) < c, and else rolls down with 2/3 g (sin - c cos)
    for factor in (0.9, 1.2):
        angle = math.atan(factor * c)
        world = tilted(angle)
        ball = world.create_body(Circle(0.5), position=(0, 0.5), friction=1, rolling_resistance=c)
        run(world, 60)
        expected = max(2 / 3 * G * (math.sin(angle) - c * math.cos(angle)), 0.0)
        assert ball.velocity.x == pytest.approx(expected, rel=0.02, abs=2e-3)


def test_of_two_shapes_the_one_that_resists_more_counts() -> None:
    speeds = []
    for ball_has, floor_has in ((0.2, 0.0), (0.2, 0.1), (0.0, 0.2)):
        world = World(precision="double")
        plate = world.create_body(Circle(50), position=(0, -50), kind="static", friction=1)
        plate.shapes[0].rolling_resistance = floor_has * 0.5 / 50
        ball = world.create_body(Circle(0.5), position=(0, 0.5), friction=1, rolling_resistance=ball_has)
        ball.angular_velocity = -4
        run(world, 20)
        speeds.append(ball.angular_velocity)
    # the floor's is a part of its own radius: as large a moment
    assert speeds[0] == pytest.approx(speeds[1], rel=1e-9)
    assert speeds[2] == pytest.approx(speeds[0], rel=0.05)


def test_a_capsule_rolls_out_and_a_box_does_not_care() -> None:
    world = tilted(0.0)
    free = world.create_body(
        Capsule(0.01, 0.3), position=(0, 0.3), velocity=(2, 0), angular_velocity=-2 / 0.3, friction=1
    )
    held = world.create_body(
        Capsule(0.01, 0.3), position=(9, 0.3), velocity=(2, 0), angular_velocity=-2 / 0.3, friction=1,
        rolling_resistance=0.3,
    )  # fmt: skip
    box = world.create_body(Box(1, 1), position=(-9, 0.5), velocity=(2, 0), friction=0, rolling_resistance=5.0)
    run(world, 60)
    assert free.velocity.x > 1.5
    assert held.velocity.x < 0.9
    assert box.velocity.x == 2.0, "it has no radius"


def test_without_load_nothing_resists() -> None:
    world = World(precision="double", gravity=(0, 0))
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.5), angular_velocity=3, rolling_resistance=1.0)
    run(world, 60)
    assert ball.angular_velocity == 3.0


def test_it_does_not_turn_a_ball_the_other_way() -> None:
    world = World(precision="double")
    floor(world, friction=0.0)
    ball = world.create_body(Circle(0.5), position=(0, 0.5), angular_velocity=-5, rolling_resistance=0.4, friction=0)
    spins = []
    for _ in range(120):
        world.step(DT)
        spins.append(ball.angular_velocity)
    # without friction only the moment acts: c R m g / (m R^2 / 2)
    assert spins[9] == pytest.approx(-5 + 10 * DT * 2 * 0.4 * G / 0.5, rel=0.03)
    assert max(spins) < 1e-9
    assert spins[-1] == pytest.approx(0.0, abs=1e-9)
