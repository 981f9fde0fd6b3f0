"""What is where, against asking each body by itself."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from engine import Box, Circle, World

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


def test_edges_belong_to_the_body() -> None:
    world = World(precision="double")
    box = world.create_body(Box(2, 1))
    ball = world.create_body(Circle(1), position=(10, 0))
    assert world.body_at((1, 0.5)) == box
    assert world.body_at((1 + 1e-12, 0.5)) is None
    assert world.body_at((11, 0)) == ball
    assert world.body_at((11 + 1e-12, 0)) is None
