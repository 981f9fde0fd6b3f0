"""What holds for every shape: bounds, containment, there and back through the tables."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine import SHAPE_KINDS, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from engine.shapes import SHAPES
from tests.engine.shapes.bounds import bounds_of
from tests.engine.worlds import POINTS, PRECISIONS
from tests.naive.convex import Rounded

pytestmark = pytest.mark.kernel

BOWL = ((-2.0, 1.0), (-1.0, 0.1), (0.5, 0.0), (2.0, 1.5))
EXAMPLES: dict[str, Shape] = {
    "box": Box(2, 0.6),
    "circle": Circle(0.7),
    "capsule": Capsule(1.5, 0.4),
    "polygon": Polygon(POINTS),
    "rounded polygon": Polygon(POINTS, radius=0.25),
    "segment": Segment((-1.0, 0.5), (0.7, -0.3)),
    "chain": Chain(BOWL),
    "closed chain": Chain(BOWL, closed=True),
}
every = pytest.mark.parametrize("name", EXAMPLES)
places = {"x": st.floats(-1e6, 1e6), "y": st.floats(-1e6, 1e6), "angle": st.floats(-10, 10)}


def pieces_of(shape: Shape) -> list[Rounded]:
    """The same figures, one for each piece, as the naive reference takes them."""
    if isinstance(shape, Box):
        w, h = 0.5 * shape.width, 0.5 * shape.height
        return [Rounded(((w, h), (-w, h), (-w, -h), (w, -h)))]
    if isinstance(shape, Circle):
        return [Rounded(((0.0, 0.0),), shape.radius)]
    if isinstance(shape, Capsule):
        return [Rounded(((-0.5 * shape.length, 0.0), (0.5 * shape.length, 0.0)), shape.radius)]
    if isinstance(shape, Polygon):
        return [Rounded(shape.points, shape.radius)]
    if isinstance(shape, Segment):
        return [Rounded((shape.a, shape.b))]
    points = (*shape.points, shape.points[0]) if shape.closed else shape.points
    return [Rounded((a, b)) for a, b in pairwise(points)]


def placed(piece: Rounded, x: float, y: float, angle: float) -> Rounded:
    return piece.turned_about_origin(angle).moved(np.array([x, y]))


@every
@settings(max_examples=40, deadline=None)
@given(**places, precision=st.sampled_from(PRECISIONS))
def test_bounds_contain_it_and_not_much_more(name: str, x: float, y: float, angle: float, precision: str) -> None:
    world = World(precision=precision, speculative_distance=0.0)
    body = world.create_body(EXAMPLES[name], position=(x, y), angle=angle, kind="static")
    turn = math.atan2(body.direction.y, body.direction.x)
    found = bounds_of(world)
    pieces = pieces_of(EXAMPLES[name])
    assert len(found) == len(pieces)
    for (left, bottom, right, top), piece in zip(found, pieces, strict=True):
        corners = placed(piece, x, y, turn).corners
        lower, upper = corners.min(axis=0) - piece.radius, corners.max(axis=0) + piece.radius
        assert left <= lower[0]
        assert bottom <= lower[1]
        assert right >= upper[0]
        assert top >= upper[1]
        slack = 2e-3 + 1e-4 * (abs(x) + abs(y) + 5)  # a ten thousandth of the size or the distance, and 2 mm
        assert right - left <= upper[0] - lower[0] + slack
        assert top - bottom <= upper[1] - lower[1] + slack


@every
def test_bounds_of_two_overlap_where_they_are_as_near_as_contacts_are_looked_for(name: str) -> None:
    world = World(speculative_distance=0.1, gravity=(0, 0))
    width, _ = EXAMPLES[name].extent
    world.create_body(EXAMPLES[name], kind="static")
    lower, upper = bounds_of(world)[:, 0].min(), bounds_of(world)[:, 2].max()
    assert upper - lower == pytest.approx(width + 0.1 + 2e-3, abs=1e-3)


@every
@pytest.mark.parametrize("precision", PRECISIONS)
def test_there_and_back_through_the_tables(name: str, precision: str) -> None:
    shape = EXAMPLES[name]
    world = World(precision=precision)
    body = world.create_body(shape, kind="static", position=(3, 4), angle=1.0)
    back = body.shape
    assert type(back) is type(shape)
    if isinstance(back, Segment):
        assert (back.a, back.b) == (pytest.approx(shape.a, abs=1e-15), pytest.approx(shape.b, abs=1e-15))
    elif isinstance(back, Chain):
        assert np.abs(np.array(back.points) - shape.points).max() < 1e-14
        assert back.closed == shape.closed
    else:
        assert back == shape
    # and what was made of that is the same again
    again = world.create_body(back, kind="static")
    assert len(again.shapes) == 1
    assert len(again.shapes[0].rows) == len(pieces_of(shape))


@every
def test_extent_and_sizes(name: str) -> None:
    shape = EXAMPLES[name]
    world = World(speculative_distance=0.0, precision="double")
    world.create_body(shape, kind="static")
    bounds = bounds_of(world)
    span = (bounds[:, 2].max() - bounds[:, 0].min(), bounds[:, 3].max() - bounds[:, 1].min())
    assert shape.extent == pytest.approx(span, abs=3e-3)
    rows = world.shape_records()
    first, second = np.broadcast_arrays(*type(shape).sizes(rows), rows["radius"])[:2]
    expected = {
        Box: lambda piece: (2.0, 0.6), Circle: lambda piece: (0.7, 0.0), Capsule: lambda piece: (1.5, 0.4),
        Polygon: lambda piece: (piece.radius, 0.0), Segment: lambda piece: (math.dist(*piece.points), 0.0),
        Chain: lambda piece: (math.dist(*piece.points), 0.0),
    }[type(shape)]  # fmt: skip
    for k, piece in enumerate(pieces_of(shape)):
        assert (first[k], second[k]) == pytest.approx(expected(piece), rel=1e-14)


@pytest.mark.parametrize("kind", SHAPES)
@given(width=st.floats(0.01, 50), height=st.floats(0.01, 50))
def test_filling_fills(kind: Any, width: float, height: float) -> None:
    # what the page draws a rectangle for
    shape = kind.filling(width, height)
    assert isinstance(shape, kind)
    if kind is Circle:
        assert shape.extent == (width, width)
    elif kind is Segment:
        assert shape.extent == (width, 0.0)
    elif kind is Capsule:
        flat = min(height, 0.9 * width)
        assert shape.extent == pytest.approx((width, flat), rel=1e-12)
    else:
        assert shape.extent == pytest.approx((width, height), rel=1e-9)


@every
def test_contains_what_the_reference_does(name: str) -> None:
    shape = EXAMPLES[name]
    world = World(precision="double")
    body = world.create_body(position=(3, -1), angle=0.8, kind="static")
    body.add_shape(shape, offset=(0.2, 0.1), angle=-0.3)
    covered = 0
    for point in np.random.default_rng(5).uniform((1.5, -2.5), (4.5, 0.5), (400, 2)):
        distances = []
        for piece in pieces_of(shape):
            there = placed(placed(piece, 0.2, 0.1, -0.3), 3, -1, 0.8)
            distances.append(signed_distance_of(there, point))
        if abs(min(distances)) < 1e-9:
            continue
        inside = min(distances) < 0
        covered += inside
        assert body.contains(point) == inside
    assert (covered > 20) == (shape.area > 0)


def signed_distance_of(piece: Rounded, point: np.ndarray) -> float:
    """Of a point from a rounded convex figure, < 0 inside [m]."""
    edges = piece.edges
    near = min(distance(point, a, b) for a, b in edges)
    if len(edges) > 2 and all(left_of(a, b, point) for a, b in edges):
        near = -near
    return near - piece.radius


def left_of(a: np.ndarray, b: np.ndarray, point: np.ndarray) -> bool:
    along, out = b - a, point - a
    return bool(along[0] * out[1] - along[1] * out[0] > 0)


def distance(point: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    along = (b - a) @ (b - a)
    t = min(max(float((point - a) @ (b - a) / along), 0.0), 1.0) if along > 0 else 0.0
    return float(np.linalg.norm(point - a - t * (b - a)))


@every
def test_is_immutable_and_comparable(name: str) -> None:
    shape = EXAMPLES[name]
    field = next(iter(shape.__dataclass_fields__))
    with pytest.raises(AttributeError):
        setattr(shape, field, 3)
    assert len({shape, *EXAMPLES.values()}) == len(EXAMPLES)
    assert (shape.name, shape.kind) == (SHAPE_KINDS[shape.kind], SHAPES.index(type(shape)))


@settings(max_examples=60, deadline=None)
@given(
    points=st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=3, max_size=8),
    closed=st.booleans(),
    offset=st.tuples(st.floats(-9, 9), st.floats(-9, 9)),
    angle=st.floats(-4, 4),
)
def test_any_chain_there_and_back(points: list, closed: bool, offset: tuple, angle: float) -> None:
    following = [*points[1:], points[0]] if closed else points[1:]
    assume(all(math.dist(a, b) > 1e-3 for a, b in zip(points, following, strict=False)))
    body = World().create_body(kind="static")
    handle = body.add_shape(Chain(points, closed), offset=offset, angle=angle)
    back = handle.shape
    assert isinstance(back, Chain)
    assert back.closed == closed
    c, s = math.cos(angle), math.sin(angle)
    moved = np.array(points) @ np.array([[c, s], [-s, c]]) + offset
    assert np.abs(np.array(back.points) - moved).max() < 1e-9


def test_an_open_chain_may_end_where_it_began() -> None:
    ring = ((0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 0.0))
    chain = World().create_body(Chain(ring), kind="static").shape
    assert isinstance(chain, Chain)
    assert not chain.closed
    assert np.allclose(chain.points, ring)
