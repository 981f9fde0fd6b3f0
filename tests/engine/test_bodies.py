"""The body's handle: what it reads and writes, and what a push does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Circle, Vec2, World
from tests.engine.worlds import DT, PRECISIONS

pytestmark = pytest.mark.kernel


def a_body(precision: str = "double") -> tuple[World, object]:
    world = World(gravity=(0, 0), precision=precision)
    return world, world.create_body(Box(2, 1), position=(3, -1), angle=0.5, mass=4, friction=0.3, velocity=(1, 2),
                                    angular_velocity=-3)  # fmt: skip


@pytest.mark.parametrize("precision", PRECISIONS)
def test_reads_what_it_was_made_of(precision: str) -> None:
    _, body = a_body(precision)
    assert (body.position, body.angle, body.rotation) == ((3, -1), 0.5, 0.5)
    assert (body.velocity, body.angular_velocity) == ((1, 2), -3)
    assert (body.kind, body.shape, body.friction, body.mass) == ("dynamic", Box(2, 1), 0.3, 4)
    assert body.inertia == 4 * 5 / 12
    assert body.inverse_mass == pytest.approx(1 / 4)
    assert body.inverse_inertia == pytest.approx(12 / 20)
    assert isinstance(body.position, Vec2)
    assert (body.force, body.torque) == ((0, 0), 0)
    assert body.alive


@pytest.mark.parametrize("precision", PRECISIONS)
def test_reads_what_was_written(precision: str) -> None:
    _, body = a_body(precision)
    for name, value in {
        "position": (7, 8), "angle": 100.0, "velocity": (-1, 5), "angular_velocity": 2.5, "friction": 0.75,
        "force": (1, -2), "torque": 9.0, "rotation": -2.0,
    }.items():  # fmt: skip
        setattr(body, name, value)
        assert getattr(body, name) == value
    assert body.angle == -2.0


def test_static_body_is_infinitely_heavy() -> None:
    body = World().create_body(Circle(1), kind="static", mass=5)
    assert (body.mass, body.inertia, body.inverse_mass, body.inverse_inertia) == (math.inf, math.inf, 0, 0)


@pytest.mark.parametrize(("shape", "area"), [(Box(2, 3), 6.0), (Circle(2), 4 * math.pi)])
def test_mass_from_density(shape, area) -> None:
    world = World(precision="double")
    assert world.create_body(shape).mass == area  # 1 kg/m^2
    assert world.create_body(shape, density=2.5).mass == 2.5 * area
    body = world.create_body(shape, mass=7)
    assert body.mass == 7
    assert body.inverse_mass == 1 / 7
    assert body.inverse_inertia == 1 / shape.inertia(7)


def test_position_is_the_origins_and_velocity_the_centres() -> None:
    world = World(precision="double", gravity=(0, 0))
    body = world.create_body(Box(1, 1), position=(3, 4), angle=math.pi / 2, offset=(2, 0), velocity=(1, 0),
                             angular_velocity=2)  # fmt: skip
    assert tuple(body.position) == (3, 4)
    assert tuple(body.center) == pytest.approx((3, 6), rel=1e-15)
    assert tuple(body.velocity) == (1, 0)
    assert tuple(body.velocity_at(body.center)) == (1, 0)
    assert tuple(body.velocity_at((3, 4))) == pytest.approx((1 + 2 * 2, 0), abs=1e-12)
    body.position = (0, 0)
    assert tuple(body.center) == pytest.approx((0, 2), abs=1e-15)
    body.angle = 0.0
    assert tuple(body.center) == (2, 0)
    body.apply_impulse((0, 3))  # at the centre: does not turn it
    assert body.angular_velocity == 2
    body.apply_force((0, 5), (0, 0))
    assert body.torque == -2 * 5


def test_only_dynamic_bodies_weigh_and_only_static_ones_stay() -> None:
    for kind in ("dynamic", "kinematic", "static"):
        world = World(gravity=(0, 0))
        body = world.create_body(Box(1, 1), kind=kind)
        assert body.kind == kind
        assert (body.inverse_mass > 0) == (kind == "dynamic")
        if kind != "static":
            body.velocity, body.angular_velocity = (1, 0), 0.5
            world.step(1.0)
            assert (body.position.x, body.angle) == (1.0, 0.5)


def test_properties_are_numbers_of_their_own() -> None:
    world, body = a_body()
    other = world.create_body(Circle(1))
    for name, value in {"linear_damping": 0.5, "angular_damping": 2.0, "gravity_scale": -1.5}.items():
        default = getattr(other, name)
        setattr(body, name, np.float32(value))
        assert getattr(body, name) == value
        assert type(getattr(body, name)) is float
        assert getattr(other, name) == default


def test_impulse_off_centre_turns() -> None:
    _, body = a_body()
    body.apply_impulse((8, -4), point=(3 + 0.5, -1 + 2))
    assert body.velocity == (1 + 8 / 4, 2 - 4 / 4)
    assert body.angular_velocity == pytest.approx(-3 + (0.5 * -4 - 2 * 8) / body.inertia, rel=1e-15)
    body.apply_impulse((4, 0))  # at the centre
    assert body.velocity == (4, 1)
    assert body.angular_velocity == pytest.approx(-3 - 18 / body.inertia, rel=1e-15)


def test_forces_add_up() -> None:
    world, body = a_body()
    body.apply_force((8, -4), point=(3 + 0.5, -1 + 2))
    body.apply_force((1, 1))
    assert body.force == (9, -3)
    assert body.torque == 0.5 * -4 - 2 * 8
    spin = body.angular_velocity + DT * body.torque / body.inertia
    world.step(DT)
    assert body.velocity == pytest.approx((1 + DT * 9 / 4, 2 - DT * 3 / 4), rel=1e-14)
    assert body.angular_velocity == pytest.approx(spin, rel=1e-14)


def test_static_body_takes_no_impulse() -> None:
    body = World().create_body(Box(1, 1), kind="static")
    body.apply_impulse((5, 5), (1, 0))
    assert body.velocity == (0, 0)
    assert body.angular_velocity == 0


def test_velocity_at_a_point() -> None:
    _, body = a_body()
    assert body.velocity_at((3, -1)) == (1, 2)
    assert body.velocity_at((3 + 1, -1 + 2)) == (1 + 3 * 2, 2 - 3 * 1)
    # against where that point goes in a moment
    step = 1e-7
    arm = np.array([1.0, 2.0])
    c, s = math.cos(-3 * step), math.sin(-3 * step)
    moved = np.array([1, 2]) * step + (c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]) - arm
    assert tuple(body.velocity_at((4, 1))) == pytest.approx(tuple(moved / step), rel=1e-5)


def test_contains_turns_with_the_body() -> None:
    _, body = a_body()
    for local, inside in (((0.99, 0.49), True), ((-0.99, -0.49), True), ((1.01, 0), False), ((0, 0.51), False)):
        c, s = math.cos(0.5), math.sin(0.5)
        point = (3 + c * local[0] - s * local[1], -1 + s * local[0] + c * local[1])
        assert body.contains(point) is inside


def test_handles_compare_by_what_they_stand_for() -> None:
    world, body = a_body()
    assert world.bodies[0] is body  # while anyone holds it
    serial = body.serial
    del body
    again = world.bodies[0]
    assert again == world.bodies[0]
    assert again.serial == serial
    other = a_body()[1]
    assert again != other
    assert again != 0
    assert len({again, world.bodies[0], other}) == 2


def test_repr_names_it() -> None:
    _, body = a_body()
    assert repr(body) == "<Body 0: dynamic Box(width=2.0, height=1.0) at (3, -1)>"
    body.destroy()
    assert repr(body) == "<Body 0, destroyed>"
