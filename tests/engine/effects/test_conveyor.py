"""Conveyor: surfaces that run by themselves, clockwise round their shapes."""

from __future__ import annotations

import math

import pytest

from engine import Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from tests.engine.worlds import DT, PRECISIONS, floor, run

G = 10.0


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("first", ["floor", "box"])
@pytest.mark.parametrize("speed", [2.0, -1.5])
def test_a_belt_carries_a_box_to_its_speed(speed: float, first: str, precision: str) -> None:
    # it slips while it is pulled along with mu g, and then rides; whoever was created first
    world = World(precision=precision)
    if first == "floor":
        floor(world, friction=0.4, tangent_speed=speed)
    box = world.create_body(Box(1, 0.2), position=(0, 0.1), friction=0.4)
    if first == "box":
        floor(world, friction=0.4, tangent_speed=speed)
    slips = abs(speed) / (0.4 * G)
    steps = int(0.8 * slips / DT)
    run(world, steps)
    assert box.velocity.x == pytest.approx(math.copysign(0.4 * G * steps * DT, speed), rel=1e-2)
    run(world, 60)
    assert box.velocity.x == pytest.approx(speed, rel=1e-4)
    start = box.position.x
    run(world, 60)
    assert box.position.x - start == pytest.approx(speed, rel=1e-3)
    assert box.angle == pytest.approx(0.0, abs=1e-4)


def test_a_box_whose_surface_runs_drives_like_a_tank() -> None:
    world = World(precision="double")
    floor(world)
    box = world.create_body(Box(2, 0.5), position=(0, 0.25), friction=1.0, tangent_speed=1.5)
    run(world, 90)
    assert box.velocity.x == pytest.approx(1.5, rel=1e-4)


GROUNDS: dict[str, Shape] = {
    "box": Box(100, 1),
    "polygon": Polygon(((-50, -0.5), (50, -0.5), (50, 0.5), (-50, 0.5))),
    "capsule": Capsule(100, 0.5),
    "segment to the left": Segment((50, 0.5), (-50, 0.5)),
    "segment to the right": Segment((-50, 0.5), (50, 0.5)),
    "chain": Chain(((-50, 0.5), (0, 0.5), (50, 0.5))),
}


@pytest.mark.parametrize("ground", GROUNDS.values(), ids=GROUNDS)
@pytest.mark.parametrize("rider", [Box(0.6, 0.4), Circle(0.2), Capsule(0.4, 0.2)], ids=["box", "circle", "capsule"])
def test_every_shape_is_a_belt(ground: Shape, rider: Shape) -> None:
    world = World(precision="double")
    world.create_body(ground, kind="static", friction=1, tangent_speed=1.0)
    body = world.create_body(rider, position=(0.1, 0.7), friction=1)
    run(world, 60)
    if isinstance(rider, Circle):  # rolls: friction gives v and, the other way, w: v + w R = 1, v = w R / 2
        assert body.velocity.x == pytest.approx(1 / 3, rel=0.02)
        assert body.angular_velocity == pytest.approx(2 / 3 / 0.2, rel=0.02)
    else:
        assert body.velocity.x == pytest.approx(1.0, rel=1e-3)


def test_two_belts_add_up_and_gears_turn() -> None:
    # both run clockwise: where they touch, they run against each other
    world = World(precision="double", gravity=(0, -10))
    floor(world, tangent_speed=1.0, friction=1)
    box = world.create_body(Box(1, 0.5), position=(0, 0.25), tangent_speed=0.5, friction=1)
    run(world, 90)
    assert box.velocity.x == pytest.approx(1.5, rel=1e-4)


def test_without_friction_a_belt_moves_nothing() -> None:
    world = World(precision="double")
    floor(world, tangent_speed=3.0, friction=0)
    box = world.create_body(Box(1, 0.5), position=(0, 0.25), friction=0.5)
    run(world, 60)
    assert box.velocity.x == 0.0


def test_a_belt_goes_uphill() -> None:
    angle = 0.3
    world = World(precision="double", gravity=(-G * math.sin(angle), -G * math.cos(angle)))
    floor(world, tangent_speed=1.0, friction=0.8)
    box = world.create_body(Box(1, 0.2), position=(0, 0.1), friction=0.8)
    run(world, 120)
    assert box.velocity.x == pytest.approx(1.0, rel=1e-3)
    world.bodies[0].shapes[0].tangent_speed = 0.0
    run(world, 60)
    assert box.velocity.x == pytest.approx(0.0, abs=1e-3), "it can be stopped"
