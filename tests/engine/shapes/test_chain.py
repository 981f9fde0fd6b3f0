"""The chain: its pieces know their neighbours, and it holds from one side only, without bumps at its joints."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from tests.engine.worlds import DT, regular, run

LINE = tuple((0.5 * k, 0.0) for k in range(-20, 41))
RIDERS: dict[str, Shape] = {
    "box": Box(0.6, 0.6),
    "circle": Circle(0.3),
    "lying capsule": Capsule(0.6, 0.3),
    "polygon": Polygon(regular(4, 0.3)),
    "rounded polygon": Polygon(regular(4, 0.2), radius=0.1),
}
HEIGHT = 0.3

either = pytest.mark.parametrize("solver", SOLVERS)


def world_points(row: np.void, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points of a piece's own frame in that of the body."""
    c, s = row["local_cosine"], row["local_sine"]
    return [(row["local_x"] + c * x - s * y, row["local_y"] + s * x + c * y) for x, y in points]


@pytest.mark.parametrize("closed", [False, True])
def test_pieces_know_their_neighbours(closed: bool) -> None:
    points = [(0.0, 0.0), (2.0, 0.5), (3.0, 2.0), (1.0, 4.0)]
    world = World()
    world.create_body(kind="static").add_shape(Chain(points, closed), offset=(5, 6))
    rows = world.shape_records()
    count = len(points) if closed else len(points) - 1
    assert len(rows) == count
    assert (rows["part_of"] == rows["serial"][0]).all()
    assert not rows["mass"].any()
    for k, row in enumerate(rows):
        half = row["half_x"]
        found = world_points(
            row, [(row["ghost1_x"], row["ghost1_y"]), (-half, 0), (half, 0), (row["ghost2_x"], row["ghost2_y"])]
        )
        places = [(k + step) % 4 if closed else min(max(k + step, 0), 3) for step in (-1, 0, 1, 2)]
        expected = [(points[place][0] + 5, points[place][1] + 6) for place in places]
        assert np.abs(np.array(found) - expected).max() < 1e-14


@either
@pytest.mark.parametrize("name", RIDERS)
def test_nothing_that_slides_over_it_feels_its_joints(name: str, solver: str) -> None:
    # without friction it goes on for ever at its speed, at rest on the line; a row of segments trips it up
    def slide(ground: list[Shape]) -> tuple[float, float]:
        world = World(precision="double", solver=solver)
        floor = world.create_body(kind="static")
        for shape in ground:
            floor.add_shape(shape, friction=0)
        angle = math.pi / 4 if "polygon" in name else 0.0
        body = world.create_body(RIDERS[name], position=(-8, resting), angle=angle, velocity=(5, 0), friction=0)
        slowest, highest = 5.0, 0.0
        for _ in range(180):
            world.step(DT)
            slowest = min(slowest, body.velocity.x)
            highest = max(highest, abs(body.velocity.y), abs(body.angular_velocity))
        return slowest, highest

    flat = {"polygon": 0.3 * math.sqrt(0.5), "rounded polygon": 0.2 * math.sqrt(0.5) + 0.1}
    resting = flat.get(name, HEIGHT) - (0.009 if solver == "sequential_impulses" else 0.0)
    slowest, highest = slide([Chain(LINE)])
    assert slowest > 5 - 1e-9
    assert highest < 0.02


@either
def test_it_holds_from_its_left_only(solver: str) -> None:
    # a floor from left to right holds from above; from below everything passes
    for points, passes in ((LINE, False), (LINE[::-1], True)):
        world = World(solver=solver)
        world.create_body(Chain(points), kind="static")
        falling = [world.create_body(shape, position=(2 * k, 1)) for k, shape in enumerate(RIDERS.values())]
        rising = world.create_body(Circle(0.3), position=(-2, -2), velocity=(0, 9), gravity_scale=0)
        run(world, 90)
        assert [body.position.y < 0 for body in falling] == [passes] * len(falling)
        assert (rising.position.y > 5) != passes


@either
@pytest.mark.parametrize("clockwise", [False, True])
def test_closed_it_holds_in_or_out(clockwise: bool, solver: str) -> None:
    ring = regular(24, 3.0)[:: -1 if clockwise else 1]
    world = World(solver=solver, gravity=(0, 0))
    world.create_body(Chain(ring, closed=True), kind="static")
    inner, outer = [], []
    for k in range(3):
        out = (math.cos(k), math.sin(k))
        inner.append(world.create_body(Circle(0.2), velocity=(3 * out[0], 3 * out[1])))
        place = (5 * out[0], 5 * out[1])
        outer.append(world.create_body(Circle(0.2), position=place, velocity=(-3 * out[0], -3 * out[1])))
    run(world, 150)
    # what comes from the other side gets through
    for body in inner + outer:
        assert (math.hypot(*body.position) > 2.9) == clockwise


def test_all_pieces_go_at_once() -> None:
    world = World()
    ground = world.create_body(kind="static")
    chain, other = ground.add_shape(Chain(LINE)), ground.add_shape(Segment((0, -1), (1, -1)))
    assert ground.shapes == [chain, other]
    chain.friction = 0.7
    assert (world.shape_records()["friction"][: len(LINE) - 1] == 0.7).all()
    chain.destroy()
    assert ground.shapes == [other]
    assert len(world.shape_records()) == 1
    assert not chain.alive
