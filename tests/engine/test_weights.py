"""What bodies weigh, against counting small squares; and that mass, centre and motion follow their shapes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Body, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from tests.engine.worlds import POINTS, PRECISIONS, regular, talk
from tests.naive.laminas import Inside, Plate, integrate, joined, near_polygon, turned

pytestmark = pytest.mark.kernel

SHAPES: dict[str, Shape] = {
    "box": Box(2, 0.5),
    "circle": Circle(0.9),
    "capsule": Capsule(1.2, 0.4),
    "short capsule": Capsule(0.01, 0.8),
    "triangle": Polygon(((0, 0), (1.5, 0.2), (0.3, 1.1))),
    "polygon": Polygon(POINTS),
    "clockwise polygon": Polygon(POINTS[::-1]),
    "rounded polygon": Polygon(POINTS, radius=0.3),
    "rounded octagon": Polygon(regular(8, 0.7), radius=0.5),
}


def figure(shape: Shape) -> Inside:
    """The same plane figure, as the naive counting takes it."""
    if isinstance(shape, Circle):
        return lambda x, y: x * x + y * y <= shape.radius * shape.radius
    if isinstance(shape, Box):
        return lambda x, y: (abs(x) <= 0.5 * shape.width) & (abs(y) <= 0.5 * shape.height)
    if isinstance(shape, Capsule):
        half = 0.5 * shape.length
        return near_polygon(np.array([(-half, 0.0), (half, 0.0)]), shape.radius)
    assert isinstance(shape, Polygon)
    return near_polygon(np.array(shape.points), shape.radius)


def plate_of(shape: Shape, offset: tuple[float, float] = (0.0, 0.0), angle: float = 0.0) -> Plate:
    return integrate(turned(figure(shape), *offset, angle), 3.0)


@pytest.mark.parametrize("name", SHAPES)
def test_area_centre_and_inertia(name: str) -> None:
    shape, expected = SHAPES[name], plate_of(SHAPES[name])
    plate = shape.lamina()
    assert plate.area == pytest.approx(shape.area, rel=1e-12)
    assert shape.area == pytest.approx(expected.area, rel=2e-3)
    assert (plate.x, plate.y) == pytest.approx((expected.x, expected.y), abs=2e-3)
    assert shape.inertia(5.0) == pytest.approx(5.0 * expected.moment / expected.area, rel=3e-3)


@settings(max_examples=100, deadline=None)
@given(
    corners=st.integers(3, 8), size=st.floats(1e-3, 1e3), rounding=st.floats(0, 3),
    x=st.floats(-10, 10), y=st.floats(-10, 10), seed=st.integers(0, 99),
)  # fmt: skip
def test_a_polygon_weighs_the_same_wherever_it_stands(corners, size, rounding, x, y, seed) -> None:
    # far from its own origin, turned, listed from another corner: one figure
    turns = np.sort(np.random.default_rng(seed).uniform(0.1, 1.0, corners).cumsum())
    turns = 2 * math.pi * turns / turns[-1]
    points = size * np.column_stack([np.cos(turns), np.sin(turns)])
    here = Polygon(tuple(map(tuple, points)), radius=size * rounding)
    away = np.roll(points, 2, axis=0) + np.array([size * x, size * y])
    there = Polygon(tuple(map(tuple, away)), radius=size * rounding)
    a, b = here.lamina(), there.lamina()
    assert b.area == pytest.approx(a.area, rel=1e-9)
    assert (b.x - size * x, b.y - size * y) == pytest.approx((a.x, a.y), abs=1e-9 * size)
    assert b.moment == pytest.approx(a.moment, rel=1e-7)
    corner = float(np.hypot(*points.T).max())
    assert a.area <= math.pi * (corner + size * rounding) ** 2 * (1 + 1e-9)


def test_a_rounded_polygon_is_steiners_parallel_figure() -> None:
    # area + perimeter r + pi r^2, whatever the polygon
    polygon = Polygon(POINTS)
    perimeter = sum(math.dist(a, b) for a, b in zip(POINTS, POINTS[1:] + POINTS[:1], strict=True))
    for radius in (1e-3, 0.3, 5.0):
        expected = polygon.area + perimeter * radius + math.pi * radius**2
        assert Polygon(POINTS, radius).area == pytest.approx(expected, rel=1e-12)


def test_lines_weigh_nothing() -> None:
    for line in (Segment((0, 0), (1, 2)), Chain(((0, 0), (1, 0), (2, 1)))):
        assert (line.area, line.inertia(0.0), line.lamina().area) == (0, 0, 0)


# --- compounds --------------------------------------------------------------------------------------------------------

PARTS: list[tuple[Shape, tuple[float, float], float, float]] = [  # shape, offset, angle, density
    (Box(0.8, 0.3), (0.4, -0.1), 0.3, 2.0),
    (Circle(0.35), (-0.6, 0.5), 0.0, 0.5),
    (Polygon(POINTS, 0.1), (0.2, 0.9), -1.2, 1.5),
    (Capsule(0.7, 0.2), (-0.5, -0.8), 2.0, 3.0),
]


def compound(world: World, **arguments: Any) -> Body:
    body = world.create_body(**arguments)
    for shape, offset, angle, density in PARTS:
        body.add_shape(shape, offset=offset, angle=angle, density=density)
    return body


def expected_of(parts: list) -> Plate:
    """Mass, centre and inertia: areas scaled with the density."""
    weighed = []
    for shape, offset, angle, density in parts:
        plate = plate_of(shape, offset, angle)
        weighed.append(Plate(plate.area * density, plate.x, plate.y, plate.moment * density))
    return joined(weighed)


def assert_weighs(body: Body, parts: list) -> None:
    expected = expected_of(parts)
    c, s = math.cos(body.angle), math.sin(body.angle)
    center = (body.position.x + c * expected.x - s * expected.y, body.position.y + s * expected.x + c * expected.y)
    assert body.mass == pytest.approx(expected.area, rel=2e-3)
    assert body.inertia == pytest.approx(expected.moment, rel=3e-3)
    assert tuple(body.center) == pytest.approx(center, abs=2e-3)
    assert body.inverse_mass == pytest.approx(1 / body.mass, rel=1e-6)
    assert body.inverse_inertia == pytest.approx(1 / body.inertia, rel=1e-6)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_compound(precision: str) -> None:
    body = compound(World(precision=precision), position=(3, -2), angle=0.7)
    assert_weighs(body, PARTS)
    assert [handle.mass for handle in body.shapes] == [
        pytest.approx(shape.area * density, rel=1e-12) for shape, _, _, density in PARTS
    ]
    for shape in body.shapes[1:3]:
        shape.destroy()
    assert_weighs(body, [PARTS[0], PARTS[3]])
    body.shapes[0].destroy()
    assert_weighs(body, [PARTS[3]])
    body.angle = 2.0
    assert_weighs(body, [PARTS[3]])


def test_the_order_and_the_way_of_adding_do_not_matter() -> None:
    world = World(precision="double")
    one = compound(world)
    first, *others = PARTS[::-1]
    shape, offset, angle, density = first
    other = world.create_body(shape, offset=offset, shape_angle=angle, density=density)
    for shape, offset, angle, density in others:
        other.add_shape(shape, offset=offset, angle=angle, mass=density * shape.area)
    assert other.mass == pytest.approx(one.mass, rel=1e-14)
    assert other.inertia == pytest.approx(one.inertia, rel=1e-13)
    assert tuple(other.center) == pytest.approx(tuple(one.center), abs=1e-14)


def test_a_shape_with_an_offset_turns_with_its_angle() -> None:
    # offset and angle say where the shape's own frame stands; the body's origin stays where it was put
    body = World(precision="double").create_body(Polygon(POINTS), position=(5, 5), offset=(1, 2), shape_angle=0.5)
    plate = Polygon(POINTS).lamina()
    c, s = math.cos(0.5), math.sin(0.5)
    center = (5 + 1 + c * plate.x - s * plate.y, 5 + 2 + s * plate.x + c * plate.y)
    assert tuple(body.center) == pytest.approx(center, rel=1e-14)
    assert tuple(body.position) == (5, 5)


def test_every_material_point_keeps_its_velocity_when_the_centre_moves() -> None:
    world = World(precision="double", gravity=(0, 0))
    body = world.create_body(Box(1, 1), position=(1, 1), velocity=(2, -1), angular_velocity=3)
    points = [(1.3, 0.8), (-4, 7)]
    before = [tuple(body.velocity_at(point)) for point in points]
    handle = body.add_shape(Circle(0.6), offset=(1.5, 0.2), density=4)
    assert tuple(body.center) != (1, 1)
    assert [tuple(body.velocity_at(point)) for point in points] == [pytest.approx(v, rel=1e-13) for v in before]
    handle.destroy()
    assert tuple(body.center) == pytest.approx((1, 1), abs=1e-15)
    assert [tuple(body.velocity_at(point)) for point in points] == [pytest.approx(v, rel=1e-13) for v in before]


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulses"])
def test_a_thrown_compound_turns_about_its_centre(solver: str) -> None:
    world = World(precision="double", gravity=(0, 0), solver=solver)
    body = compound(world, angle=0.4, velocity=(1, 2), angular_velocity=5)
    v, start, arm = body.velocity, body.center, body.position - body.center
    for step in range(1, 61):
        world.step(1 / 60)
        t, turn = step / 60, 5 * step / 60
        assert tuple(body.center) == pytest.approx((start.x + v.x * t, start.y + v.y * t), abs=1e-12)
        c, s = math.cos(turn), math.sin(turn)
        origin = (body.center.x + c * arm.x - s * arm.y, body.center.y + s * arm.x + c * arm.y)
        assert tuple(body.position) == pytest.approx(origin, abs=1e-12)


def test_a_static_and_a_kinematic_body_do_not_weigh() -> None:
    for kind in ("static", "kinematic"):
        body = compound(World(), kind=kind)
        assert (body.mass, body.inertia, body.inverse_mass, body.inverse_inertia) == (math.inf, math.inf, 0, 0)
        body.shapes[0].destroy()
        assert (body.mass, body.inverse_mass) == (math.inf, 0)


def test_fixed_rotation_has_no_inverse_inertia() -> None:
    world = World(precision="double")
    with pytest.raises(ValueError, match=r"^angular_velocity = .*2.*: must be zero where the rotation is fixed"):
        compound(world, fixed_rotation=True, angular_velocity=2)
    body = compound(world, fixed_rotation=True)
    assert body.inverse_inertia == 0
    assert body.inertia == pytest.approx(expected_of(PARTS).moment, rel=3e-3), "what it would have"
    body.fixed_rotation = False
    assert body.inverse_inertia == pytest.approx(1 / body.inertia)
    body.angular_velocity = 4
    body.fixed_rotation = True
    assert (body.angular_velocity, body.inverse_inertia) == (0, 0)
    body.apply_impulse((1, 2), (9, 9))
    assert body.angular_velocity == 0


@pytest.mark.parametrize("make", [World, talk])
def test_a_dynamic_body_of_lines_takes_no_impulse(make: type[World]) -> None:
    # nothing to divide by: it meets boxes as a wall would, and nothing becomes infinite
    world = make(precision="double", gravity=(0, 0))
    line = world.create_body(Segment((-3, 0), (3, 0)))
    assert (line.mass, line.inertia, line.inverse_mass, line.inverse_inertia) == (0, 0, 0, 0)
    box = world.create_body(Box(1, 1), position=(0, 0.51), velocity=(0, -2))
    other = world.create_body(Segment((0, -3), (0, 3)), position=(1, 0))
    wall = world.create_body(Box(1, 1), position=(0, -0.4), kind="static")
    for _ in range(30):
        world.step(1 / 60)
    assert np.isfinite(world.positions).all()
    assert tuple(line.position) == (0, 0)
    assert tuple(other.position) == (1, 0)
    assert box.position.y > 0.45
    assert wall.alive
