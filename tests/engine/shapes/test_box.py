"""The box: mass, bounds, containment."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine import Box, World
from tests.engine.shapes.bounds import bounds_of
from tests.engine.worlds import PRECISIONS
from tests.naive.boxes import PlacedBox, overlaps

pytestmark = pytest.mark.kernel


def test_area_and_inertia() -> None:
    box = Box(2, 3)
    assert box.area == 6.0
    assert box.inertia(12.0) == 12.0 * (4 + 9) / 12.0
    # against the integral of r^2 over the area, by the midpoint rule
    x, y = np.meshgrid((np.arange(200) + 0.5) / 100 - 1, (np.arange(200) + 0.5) * 0.015 - 1.5)
    assert box.inertia(1.0) == pytest.approx(float(np.mean(x * x + y * y)), rel=1e-4)


def test_is_immutable_and_comparable() -> None:
    assert Box(1, 2) == Box(1.0, 2.0) != Box(2, 1)
    with pytest.raises(AttributeError):
        Box(1, 2).width = 3  # type: ignore[misc]


def test_there_and_back_through_the_tables() -> None:
    box = Box(0.3, 7.1)
    assert World().create_body(box).shape == box
    assert World().create_body(Box(1, 1), offset=(3, 4), shape_angle=2.0).shape == Box(1, 1)


def test_what_the_outside_is_told() -> None:
    box = Box(0.3, 7.1)
    world = World()
    world.create_body(box)
    assert [column.tolist() for column in Box.sizes(world.shape_records())] == [[0.3], [7.1]]
    assert box.extent == (0.3, 7.1)
    assert Box.filling(0.3, 7.1) == box


def test_contains() -> None:
    body = World(precision="double").create_body(Box(2, 1), position=(10, 0), angle=math.pi / 2)
    assert body.contains((10.49, 0.99))
    assert not body.contains((10.99, 0.49))
    assert not body.contains((9.4, 0))


size = st.floats(1e-3, 1e5)
far = st.floats(-1e6, 1e6)


@settings(max_examples=150, deadline=None)
@given(width=size, height=size, x=far, y=far, angle=st.floats(-10, 10), precision=st.sampled_from(PRECISIONS))
def test_bounds_contain_the_corners(width, height, x, y, angle, precision) -> None:
    world = World(precision=precision, speculative_distance=0)
    body = world.create_body(Box(width, height), position=(x, y), angle=angle, kind="static")
    corners = PlacedBox(x, y, math.atan2(body.direction.y, body.direction.x), width, height).corners
    left, bottom, right, top = bounds_of(world)[0]
    assert left <= corners[:, 0].min()
    assert bottom <= corners[:, 1].min()
    assert right >= corners[:, 0].max()
    assert top >= corners[:, 1].max()
    # and not by much: a ten thousandth of the size or the distance, and 2 mm
    slack = 2e-3 + 1e-4 * (abs(x) + abs(y) + width + height)
    assert right - left <= np.ptp(corners[:, 0]) + slack
    assert top - bottom <= np.ptp(corners[:, 1]) + slack


@settings(max_examples=150, deadline=None)
@given(
    x=st.sampled_from([0.0, 1.0, -1e3, 1e6]),
    y=st.sampled_from([0.0, 0.1, 1e6]),
    dx=st.floats(-2, 2),
    dy=st.floats(-2, 2),
    angle=st.floats(-2, 2),
    precision=st.sampled_from(PRECISIONS),
)
def test_touching_boxes_are_never_parted(x, y, dx, dy, angle, precision) -> None:
    depths = overlaps(PlacedBox(x, y, 0.0, 1.0, 2.0), PlacedBox(x + dx, y + dy, angle, 1.5, 0.5))
    assume(depths.min() >= 0)
    world = World(precision=precision)
    world.create_body(Box(1, 2), position=(x, y))
    world.create_body(Box(1.5, 0.5), position=(x + dx, y + dy), angle=angle)
    (left1, bottom1, right1, top1), (left2, bottom2, right2, top2) = bounds_of(world)
    assert left1 <= right2
    assert left2 <= right1
    assert bottom1 <= top2
    assert bottom2 <= top1
