"""Time of impact: against closed forms, and against a slow reference for every pair of shapes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Box, Capsule, Circle, Polygon, Segment, Shape, World
from engine.continuous.impact import FOREVER, NEVER, Task, first_root, impact_time
from engine.continuous.outlines import Sweep, load_outline, reach_of, turn_outline
from engine.vec2 import Vec2
from tests.engine.worlds import POINTS
from tests.naive.convex import Rounded, signed_distance

NEAR = 1e-9  # [m]


class Moving(NamedTuple):
    """A shape on its way: from a position and an angle, by so much in a step, until it stops."""

    shape: Shape
    position: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    way: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    until: float = 1.0


def impact(first: Moving, second: Moving, depth: float = 0.0, end: float = 1.0) -> float:
    """When the two are `depth` apart, by the engine's kernel."""
    world = World(gravity=(0, 0))
    for one in (first, second):
        world.create_body(one.shape, position=one.position, angle=one.angle)
    state = world._state
    shapes, hulls, bodies = (state.__dict__[n].tables[n] for n in ("shapes", "hulls", "bodies"))
    scratch = np.empty((3, 8, 5))
    loaded: list[Any] = []
    for k, one in enumerate((first, second)):
        body = bodies[k]
        center = Vec2(float(body["center_x"]), float(body["center_y"]))
        sweep = Sweep(center, Vec2(*map(float, one.way)), float(one.angle), float(one.turn), float(one.until))
        count = int(load_outline(shapes[k], hulls, body, scratch[2], scratch[k]))
        turn_outline(scratch[k], count, sweep, 0.0)
        loaded += [scratch[k], count, sweep]
    reaches = [float(reach_of(loaded[0], loaded[1])), float(reach_of(loaded[3], loaded[4]))]
    radii = float(shapes[0]["radius"] + shapes[1]["radius"])
    task = Task(radii, float(depth), 0.0, Vec2(0.0, 0.0), NEAR, Vec2(0.0, 0.0), *reaches)
    return float(impact_time(task, *loaded, float(end)))


WALL = Moving(Box(0.001, 50.0), (5.0, 0.0))


@pytest.mark.kernel
def test_first_root() -> None:
    assert first_root(3.0, -2.0, 0.0) == 1.5
    assert first_root(3.0, 0.0, 0.0) == first_root(3.0, 1.0, 0.0) == FOREVER
    for gap, speed, bend in ((0.5, -3.0, 8.0), (0.5, 2.0, 8.0), (1e-9, -1000.0, 3.0), (1e-9, 1000.0, 3.0)):
        t = first_root(gap, speed, bend)
        assert t > 0
        assert gap + speed * t - 0.5 * bend * t * t == pytest.approx(0.0, abs=1e-12 * (1 + abs(speed * t)))


@pytest.mark.parametrize("angle", [0.0, 0.7, -1.2])
def test_circle_and_wall(angle: float) -> None:
    way = (20.0, 20.0 * math.tan(angle))
    ball = Moving(Circle(0.1), (0.0, 0.0), way=way, turn=40.0)
    assert impact(ball, WALL) == pytest.approx((5.0 - 0.0005 - 0.1) / 20.0, abs=1e-12)
    assert impact(WALL, ball) == pytest.approx((5.0 - 0.0005 - 0.1) / 20.0, abs=1e-12)
    assert impact(ball, WALL, end=0.2) == NEVER
    assert impact(ball._replace(until=0.2), WALL) == NEVER, "it stops before"
    assert impact(ball._replace(way=(-20.0, 0.0)), WALL) == NEVER
    assert impact(ball, WALL, depth=-0.01) == pytest.approx((5.0 - 0.0005 - 0.09) / 20.0, abs=1e-12)


def test_two_circles_that_both_move() -> None:
    a = Moving(Circle(0.3), (0.0, 0.0), way=(7.0, 1.0))
    b = Moving(Circle(0.2), (4.0, 3.0), way=(-2.0, -4.5))
    d, v = np.array([4.0, 3.0]), np.array([-9.0, -5.5])
    p, q, r = v @ v, 2 * d @ v, d @ d - 0.25
    exact = (-q - math.sqrt(q * q - 4 * p * r)) / (2 * p)
    assert impact(a, b) == pytest.approx(exact, abs=1e-10)
    assert impact(a._replace(way=(7.0, 9.0)), b) == NEVER


@pytest.mark.parametrize("turn", [1.0, -1.0, 7.0, 60.0, 900.0])
def test_the_corner_of_a_box_that_spins_meets_a_wall(turn: float) -> None:
    box = Moving(Box(0.6, 0.2), (0.0, 0.0), 0.3, (9.0, -4.0), turn)

    def gap(t: float) -> float:
        angle = 0.3 + turn * t
        return 5.0 - 0.0005 - 9.0 * t - 0.3 * abs(math.cos(angle)) - 0.1 * abs(math.sin(angle))

    t = next(t for t in np.linspace(0, 1, 200_001) if gap(t) < 0)
    low, high = t - 5e-6, t
    for _ in range(60):
        low, high = (0.5 * (low + high), high) if gap(0.5 * (low + high)) > 0 else (low, 0.5 * (low + high))
    found = impact(box, WALL)
    assert found <= low + 1e-12, "never too late"
    assert found == pytest.approx(low, abs=1e-8 if abs(turn) < 100 else 1e-3)


def test_what_slides_along_a_floor_meets_nothing() -> None:
    floor = Moving(Box(1000.0, 2.0), (0.0, -1.0))
    box = Moving(Box(1.0, 1.0), (0.0, 0.5), way=(16.0, 0.0))
    assert impact(box, floor, depth=-1e-3) == NEVER
    ahead = Moving(Box(10.0, 2.0), (9.0, -1.0001))
    assert impact(box, ahead, depth=-1e-3) == NEVER
    assert impact(box._replace(position=(0.0, 0.4998)), ahead, depth=-1e-3) == NEVER, "deeper than the next floor"
    assert impact(box._replace(position=(0.0, 0.497)), ahead, depth=-1e-3) < 0.3, "but not much"


SHAPES: dict[str, tuple[Shape, Rounded]] = {
    "box": (Box(0.8, 0.3), Rounded(((0.4, -0.15), (0.4, 0.15), (-0.4, 0.15), (-0.4, -0.15)))),
    "circle": (Circle(0.2), Rounded(((0.0, 0.0),), 0.2)),
    "capsule": (Capsule(0.9, 0.05), Rounded(((-0.45, 0.0), (0.45, 0.0)), 0.05)),
    "polygon": (Polygon(POINTS), Rounded(POINTS)),
    "rounded polygon": (Polygon(POINTS, radius=0.07), Rounded(POINTS, 0.07)),
    "segment": (Segment((-0.7, 0.0), (0.7, 0.0)), Rounded(((-0.7, 0.0), (0.7, 0.0)))),
}
ways = st.tuples(st.floats(-6, 6), st.floats(-6, 6))
angles, turns = st.floats(-4, 4), st.floats(-9, 9)


def at_time(outline: Rounded, moving: Moving, center: np.ndarray, time: float) -> Rounded:
    """Where a shape is: its centre of mass goes straight on, its frame turns about that."""
    time = min(time, moving.until)
    local = center - np.array(moving.position)  # of the centre, in the world, as the step begins
    turned = moving.turn * time
    c, s = math.cos(turned), math.sin(turned)
    origin = center + np.array(moving.way) * time - np.array([c * local[0] - s * local[1], s * local[0] + c * local[1]])
    return replace(outline, x=float(origin[0]), y=float(origin[1]), angle=moving.angle + turned)


def center_of(moving: Moving) -> np.ndarray:
    return np.array(World().create_body(moving.shape, position=moving.position, angle=moving.angle).center)


@settings(max_examples=60, deadline=None)
@given(
    names=st.tuples(st.sampled_from(sorted(SHAPES)), st.sampled_from(sorted(SHAPES))),
    place=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    motion=st.tuples(angles, ways, turns, st.floats(0.1, 1)),
    other=st.tuples(angles, ways, turns, st.floats(0.1, 1)),
    depth=st.sampled_from([0.0, -0.004]),
)
def test_no_pair_meets_before_and_each_meets_then(
    names: tuple[str, str], place: tuple[float, float], motion: Any, other: Any, depth: float
) -> None:
    (shape1, outline1), (shape2, outline2) = SHAPES[names[0]], SHAPES[names[1]]
    first, second = Moving(shape1, (0.0, 0.0), *motion), Moving(shape2, place, *other)
    center1, center2 = center_of(first), center_of(second)

    def apart(t: float) -> float:
        return signed_distance(at_time(outline1, first, center1, t), at_time(outline2, second, center2, t))

    if apart(0.0) <= 0.01:
        return
    time = impact(first, second, depth)
    last = 1.0 if time == NEVER else time
    assert min(apart(last * k / 40) for k in range(41)) > depth - 1e-7, "never too late"
    if time != NEVER:
        assert apart(time) == pytest.approx(depth, abs=1e-4), "nor too early"
