"""Buoyancy: Archimedes' law for every shape, floating, and drag that only ever slows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Body, Box, Capsule, Circle, Polygon, Segment, Shape, World
from tests.engine.effects.naive_overlap import Point, overlap
from tests.engine.worlds import DT, POINTS, PRECISIONS, run

pytestmark = pytest.mark.kernel

LOW, HIGH = (-1.0, -2.0), (1.5, 0.25)  # a tank
DENSITY = 3.0


def floated(
    shape: Shape, position: Point, angle: float, low: Point = LOW, high: Point = HIGH
) -> tuple[float, float, float]:
    """(area, centroid) of what is submerged, from lift and torque in a step; with gravity along y, then along x."""
    found = []
    for gravity in ((0.0, -10.0), (-10.0, 0.0)):
        world = World(gravity=gravity, precision="double", solver="sequential_impulses")
        world.create_fluid(low, high, density=DENSITY)
        body = world.create_body(shape, position=position, angle=angle, gravity_scale=0.0)
        world.step(DT)
        lift = body.velocity * (body.mass / DT)
        found.append((lift, body.angular_velocity * body.inertia / DT, body))
    (up, turn_up, body), (side, turn_side, _) = found
    area = up.y / (DENSITY * 10.0)
    assert side.x == pytest.approx(up.y)
    assert (up.x, side.y) == (0.0, 0.0)
    if area == 0.0:
        assert (turn_up, turn_side) == (0.0, 0.0)
        return 0.0, 0.0, 0.0
    return area, float(body.center.x - DT * body.velocity.x + turn_up / up.y), center_y(body) - turn_side / side.x


def center_y(body: Body) -> float:
    """Where its centre was before the step."""
    return float(body.center.y - DT * body.velocity.y)


def placed(points: tuple[Point, ...], position: Point, angle: float) -> list[Point]:
    c, s = math.cos(angle), math.sin(angle)
    return [(position[0] + c * x - s * y, position[1] + s * x + c * y) for x, y in points]


places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))
angles = st.floats(-4, 4)


@given(position=places, angle=angles, width=st.floats(0.05, 6), height=st.floats(0.05, 6))
def test_lift_of_a_box_is_that_of_naive_clipping(position: Point, angle: float, width: float, height: float) -> None:
    corners = ((-width / 2, -height / 2), (width / 2, -height / 2), (width / 2, height / 2), (-width / 2, height / 2))
    check(Box(width, height), corners, position, angle)


@given(position=places, angle=angles)
def test_lift_of_a_polygon_is_that_of_naive_clipping(position: Point, angle: float) -> None:
    check(Polygon(POINTS), POINTS[::-1] if Polygon(POINTS).points != POINTS else POINTS, position, angle)


def check(shape: Shape, corners: tuple[Point, ...], position: Point, angle: float) -> None:
    area, x, y = floated(shape, position, angle)
    expected, centroid = overlap(placed(corners, position, angle), LOW, HIGH)
    assert area == pytest.approx(expected, rel=1e-9, abs=1e-12)
    if expected > 1e-6 * shape.area:  # of a sliver the centroid is lost in rounding, not the lift
        assert (x, y) == pytest.approx(centroid, abs=1e-7)


def segment_of_disc(radius: float, depth: float) -> tuple[float, float]:
    """(area, distance of its centroid from the centre) of what is below a line `depth` below the top of a disc."""
    below = 2.0 * radius - depth  # height of the part under water
    half = math.acos((radius - below) / radius)
    area = radius**2 * (half - math.sin(half) * math.cos(half))
    return area, (2.0 / 3.0) * (radius * math.sin(half)) ** 3 / area


@pytest.mark.parametrize("depth", [0.1, 0.4, 0.7, 1.0, 1.3, 1.6, 1.9])
def test_a_disc_is_a_polygon_of_its_area(depth: float) -> None:
    radius = 1.0
    area, x, y = floated(Circle(radius), (0.3, 0.0), 0.2, (-9, -9), (9, radius - depth))
    expected, below = segment_of_disc(radius, depth)
    assert area == pytest.approx(expected, abs=1.5e-3 * math.pi)
    assert x == pytest.approx(0.3, abs=1e-12), "as the water sees it, it is the same from both sides"
    assert y == pytest.approx(-below, abs=0.02)


ROUND = [Circle(0.7), Capsule(1.2, 0.3), Polygon(POINTS, radius=0.2), Polygon(((0, 0), (2, 0), (0, 0.1)), radius=0.4)]


@pytest.mark.parametrize("shape", [*ROUND, Box(2, 1), Polygon(POINTS)], ids=str)
def test_all_under_every_shape_has_its_own_area(shape: Shape) -> None:
    area, x, y = floated(shape, (0.4, 0.3), 0.6, (-9, -9), (9, 9))
    assert area == pytest.approx(shape.area, rel=1e-13)
    center = World(precision="double").create_body(shape, position=(0.4, 0.3), angle=0.6).center
    assert (x, y) == pytest.approx(tuple(center), abs=1e-12)


@given(position=places, angle=angles, which=st.sampled_from(ROUND))
def test_a_rounded_shape_is_between_its_outlines(position: Point, angle: float, which: Shape) -> None:
    """Clipped at a corner of the tank: within 0.4 % of the rounding of the exact area, found by counting points."""
    area, _, _ = floated(which, position, angle)
    assert area == pytest.approx(counted(which, position, angle), abs=0.01 * which.area + 1e-3)


def counted(shape: Shape, position: Point, angle: float, across: int = 400) -> float:
    """Area in the tank, by asking the world about points of a grid."""
    cell = np.array([(HIGH[i] - LOW[i]) / across for i in (0, 1)])
    x = LOW[0] + cell[0] * (np.arange(across) + 0.5)
    y = LOW[1] + cell[1] * (np.arange(across) + 0.5)
    gx, gy = np.meshgrid(x, y)
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = gx - position[0], gy - position[1]
    local_x, local_y = c * dx + s * dy, c * dy - s * dx
    world = World()
    world.create_body(shape)
    rows, hulls = world.shape_records()[:1], world.hull_records()
    inside = [shape.contains(local_x[k], local_y[k], np.repeat(rows, across), hulls) for k in range(across)]
    return float(np.sum(inside)) * float(cell[0] * cell[1])


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_a_box_floats_as_deep_as_its_density_says(ratio: float, precision: str) -> None:
    world = World(precision=precision)
    world.create_fluid((-10, -10), (10, 2), density=4.0, linear_drag=2.0, angular_drag=2.0)
    box = world.create_body(Box(3, 1), position=(1, 3), density=4.0 * ratio, angle=0.1)
    run(world, 1800)
    assert box.position.y == pytest.approx(2.0 + 0.5 - ratio, abs=1e-9 if precision == "double" else 1e-5)
    assert box.angle == pytest.approx(0.0, abs=1e-9 if precision == "double" else 1e-4)


def test_what_is_denser_sinks_and_what_is_as_dense_hovers() -> None:
    world = World(precision="double")
    world.create_fluid((-100, -100), (100, 100), density=2.0)
    stone = world.create_body(Circle(0.5), density=6.0)
    fish = world.create_body(Capsule(1, 0.2), position=(5, 0), density=2.0)
    run(world, 60)
    assert stone.velocity.y == pytest.approx(-10.0 * (1 - 2 / 6), rel=1e-12)
    assert tuple(fish.velocity) == pytest.approx((0, 0), abs=1e-12)


@pytest.mark.parametrize("substeps", [1, 4, 16])
def test_a_box_bobs_for_ever(substeps: int) -> None:
    """Without drag it neither gains nor loses: w^2 = g / depth, so its turning points stay where they are."""
    world = World(precision="double", substeps=substeps)
    world.create_fluid((-10, -10), (10, 0), density=2.0)
    box = world.create_body(Box(1, 1), position=(0, 0.2), density=1.0)
    heights = [box.position.y]
    for _ in range(6000):
        world.step(DT)
        heights.append(box.position.y)
    # symplectic Euler swings about the true energy by w h / 2 of it; the crests are a step apart at most
    assert np.max(heights[-300:]) == pytest.approx(np.max(heights[:300]), abs=1e-3)
    assert np.min(heights[-300:]) == pytest.approx(np.min(heights[:300]), abs=1e-3)
    crossings = np.flatnonzero((np.array(heights[:-1]) < 0) & (np.array(heights[1:]) >= 0))
    period = DT * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert period == pytest.approx(2 * math.pi / math.sqrt(10.0 / 0.5), rel=1e-3)


def test_a_spinning_ball_that_floats_is_not_turned() -> None:
    world = World(precision="double")
    world.create_fluid((-10, -10), (10, 0), density=2.0)
    ball = world.create_body(Circle(0.5), density=1.0, angular_velocity=3.0)
    run(world, 120)
    assert ball.angular_velocity == pytest.approx(3.0, abs=1e-12)
    assert ball.position.x == 0.0


@pytest.mark.parametrize("rate", [0.3, 5.0, 1e9])
def test_drag_of_what_is_all_under_is_that_of_damping(rate: float) -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_fluid((-100, -100), (100, 100), density=2.0, linear_drag=rate, angular_drag=0.5 * rate)
    body = world.create_body(Capsule(1, 0.3), density=2.0, velocity=(3, -1), angular_velocity=2)
    for k in range(1, 40):
        world.step(DT)
        left = 1.0 / (1.0 + DT * rate) ** k
        assert tuple(body.velocity) == pytest.approx((3 * left, -left), rel=1e-9, abs=1e-12)
        # the implicit step is exact for what is held for the whole of it, whatever the substeps
        assert body.angular_velocity == pytest.approx(2.0 / (1.0 + DT * 0.5 * rate) ** k, rel=1e-9, abs=1e-12)


@given(
    rate=st.floats(0, 1e8), turning=st.floats(0, 1e8), vx=st.floats(-9, 9), vy=st.floats(-9, 9), w=st.floats(-9, 9)
)  # fmt: skip
def test_drag_takes_energy_and_never_gives_it(rate: float, turning: float, vx: float, vy: float, w: float) -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_fluid((-0.5, -9), (9, 0.3), density=2.0, linear_drag=rate, angular_drag=turning)
    body = world.create_body(Box(2, 0.4), velocity=(vx, vy), angular_velocity=w)
    body.add_shape(Circle(0.4), offset=(1, 0.5), density=3.0)
    before = world.diagnostics().kinetic_energy
    world.step(DT)
    assert world.diagnostics().kinetic_energy <= before * (1 + 1e-12) + 1e-12


def test_a_body_that_cannot_turn_is_held_back_all_the_same() -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_fluid((0, -9), (9, 9), density=2.0, linear_drag=1.0)
    body = world.create_body(Box(2, 1), density=2.0, velocity=(0, 4), fixed_rotation=True)
    world.step(DT)
    assert body.velocity.y == pytest.approx(4.0 / (1.0 + DT * 0.5), rel=1e-12), "half of it is under"
    assert body.angular_velocity == 0.0


def test_only_what_has_an_area_and_moves_is_lifted() -> None:
    world = World()
    world.create_fluid((-10, -10), (10, 10), density=2.0, linear_drag=3.0)
    line = world.create_body(Segment((0, 0), (1, 0)), kind="kinematic", velocity=(1, 0))
    wall = world.create_body(Box(1, 1), position=(4, 0), kind="static")
    frame = world.create_body(Box(1, 1), position=(-4, 0), density=2.0)
    frame.add_shape(Segment((0, 0), (3, 3)))
    run(world, 5)
    assert tuple(line.velocity) == (1.0, 0.0)
    assert tuple(wall.position) == (4.0, 0.0)
    assert tuple(frame.velocity) == pytest.approx((0, 0), abs=1e-6)


def test_two_fluids_lift_twice_and_one_that_went_no_longer() -> None:
    world = World(precision="double", gravity=(0, -10))
    fluids = [world.create_fluid((-10, -10), (10, 10), density=1.0) for _ in range(2)]
    body = world.create_body(Circle(0.5), density=1.0)
    world.step(DT)
    assert body.velocity.y == pytest.approx(DT * 10.0)
    fluids[0].destroy()
    world.step(DT)
    assert body.velocity.y == pytest.approx(DT * 10.0)
    fluids[1].density = 3.0
    world.step(DT)
    assert body.velocity.y == pytest.approx(DT * 30.0)
    fluids[1].destroy()
    world.step(DT)
    assert body.velocity.y == pytest.approx(DT * 20.0)
    assert not {e.name: e.called_for for e in world.effects}["buoyancy"]


def test_far_from_the_origin_it_is_the_same() -> None:
    near, far = (World(precision="double", solver="sequential_impulses") for _ in range(2))
    for world, x in ((near, 0.0), (far, 2.0**20)):
        world.create_fluid((x - 5, -5), (x + 5, 0.125), density=2.0, linear_drag=1.0)
        world.create_body(Box(1, 0.5), position=(x, 0.25), angle=0.3)
        run(world, 60)
    assert far.positions[0] - (2.0**20, 0) == pytest.approx(near.positions[0], abs=1e-8)
    assert far.angles[0] == pytest.approx(near.angles[0], abs=1e-8)
