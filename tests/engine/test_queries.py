"""What is where, against asking each body by itself."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from engine import Box, Capsule, Circle, Polygon, Segment, World
from tests.engine.worlds import gathering

coordinate = st.floats(-4, 4)


@given(st.lists(st.tuples(coordinate, coordinate, st.floats(-3, 3), st.booleans(), st.booleans()), max_size=8))
def test_body_at_is_the_last_one_that_contains_the_point(bodies: list[tuple[float, float, float, bool, bool]]) -> None:
    world = World()
    for number, (x, y, angle, is_box, is_static) in enumerate(bodies):
        shape = Box(2, 1) if is_box else Circle(0.8)
        body = world.create_body(shape, position=(x, y), angle=angle, kind="static" if is_static else "dynamic")
        if number == 2:
            body.destroy()
    for point in np.random.default_rng(1).uniform(-4, 4, (20, 2)):
        for kind in ("dynamic", "static"):
            covering = [body for body in world.bodies if body.kind == kind and body.contains(point)]
            assert world.body_at(point, kind) == (covering[-1] if covering else None)


def test_any_of_its_shapes_is_the_body() -> None:
    world = World(precision="double")
    body = world.create_body(Box(2, 0.5), position=(5, 5), angle=0.5)
    body.add_shape(Capsule(1, 0.3), offset=(0, 1), angle=math.pi / 2)
    body.add_shape(Polygon(((0, 0), (1, 0), (0, 1)), radius=0.1), offset=(-1, -1))
    wall = world.create_body(Segment((4, 5), (6, 5)), kind="static")
    c, s = math.cos(0.5), math.sin(0.5)
    for local, inside in (
        ((0.9, 0.2), True), ((0, 1.7), True), ((0.35, 1), False), ((-0.8, -0.8), True), ((-1.05, -0.5), True),
        ((-1.2, -0.5), False), ((0.5, -0.5), False),
    ):  # fmt: skip
        point = (5 + c * local[0] - s * local[1], 5 + s * local[0] + c * local[1])
        assert world.body_at(point) == (body if inside else None), local
    assert world.body_at((5, 5), "static") is None
    assert not wall.contains((5, 5)), "a line covers no point"


def test_far_away_points_are_no_trouble() -> None:
    world = gathering()
    with np.errstate(all="raise"):
        assert world.body_at((1e300, -1e300)) is None


def test_edges_belong_to_the_body() -> None:
    world = World(precision="double")
    box = world.create_body(Box(2, 1))
    ball = world.create_body(Circle(1), position=(10, 0))
    assert world.body_at((1, 0.5)) == box
    assert world.body_at((1 + 1e-12, 0.5)) is None
    assert world.body_at((11, 0)) == ball
    assert world.body_at((11 + 1e-12, 0)) is None
