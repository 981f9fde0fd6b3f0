"""The circle: mass, bounds, containment."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Circle, World
from tests.engine.shapes.bounds import bounds_of
from tests.engine.worlds import PRECISIONS

pytestmark = pytest.mark.kernel


def test_area_and_inertia() -> None:
    circle = Circle(2)
    assert circle.area == math.pi * 4
    assert circle.inertia(3.0) == 0.5 * 3.0 * 4
    x, y = np.meshgrid((np.arange(400) + 0.5) / 100 - 2, (np.arange(400) + 0.5) / 100 - 2)
    squared = (x * x + y * y)[x * x + y * y <= 4]
    assert circle.inertia(1.0) == pytest.approx(float(squared.mean()), rel=1e-3)


def test_there_and_back_through_the_tables() -> None:
    assert World().create_body(Circle(0.7)).shape == Circle(0.7)


def test_what_the_outside_is_told() -> None:
    world = World()
    world.create_body(Circle(0.7))
    radii, nothing = Circle.sizes(world.shape_records())
    assert (radii.tolist(), nothing) == ([0.7], 0.0)
    assert Circle(0.7).extent == (1.4, 1.4)
    assert Circle.filling(1.4, 99) == Circle(0.7)


def test_contains() -> None:
    body = World().create_body(Circle(1), position=(5, 5), angle=1.0)
    assert body.contains((5.7, 5.7))
    assert not body.contains((5.71, 5.71))


@settings(max_examples=100, deadline=None)
@given(
    radius=st.floats(1e-3, 1e6), x=st.floats(-1e6, 1e6), y=st.floats(-1e6, 1e6), precision=st.sampled_from(PRECISIONS)
)
def test_bounds_contain_the_circle(radius, x, y, precision) -> None:
    world = World(precision=precision, speculative_distance=0)
    world.create_body(Circle(radius), position=(x, y), kind="static")
    left, bottom, right, top = bounds_of(world)[0]
    assert left <= x - radius
    assert bottom <= y - radius
    assert right >= x + radius
    assert top >= y + radius
    slack = 2e-3 + 1e-4 * (abs(x) + abs(y) + radius)
    assert right - left <= 2 * radius + slack
    assert top - bottom <= 2 * radius + slack
