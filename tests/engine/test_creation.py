"""Making bodies and joints: mass properties, and anchors in the bodies' own frames."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Box, Circle, World
from engine.creation import mass_properties
from tests.engine.worlds import PRECISIONS

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("shape", [Box(2, 0.5), Circle(3)])
def test_mass_properties(shape, precision: str) -> None:
    mass, inertia, inverse_mass, inverse_inertia = mass_properties(shape, "dynamic", None, 3.0, precision)
    assert mass == 3.0 * shape.area
    assert inertia == shape.inertia(mass)
    assert inverse_mass * mass == pytest.approx(1.0, rel=1e-15)
    assert inverse_inertia * inertia == pytest.approx(1.0, rel=1e-15)
    assert mass_properties(shape, "static", None, None, precision) == (math.inf, math.inf, 0.0, 0.0)


@settings(max_examples=100, deadline=None)
@given(
    x=st.floats(-1e3, 1e3),
    y=st.floats(-1e3, 1e3),
    angle=st.floats(-10, 10),
    anchor=st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)),
)
def test_anchors_are_where_they_were_put(x, y, angle, anchor) -> None:
    world = World(precision="double")
    body1 = world.create_body(Box(1, 1), position=(x, y), angle=angle)
    body2 = world.create_body(Circle(1), position=(y, -x), angle=-2 * angle)
    joint = world.create_joint_revolute(body1, body2, anchor=anchor)
    for end in joint.anchors:
        assert tuple(end) == pytest.approx(anchor, abs=1e-9)


def test_defaults_are_the_talks() -> None:
    world = World()
    assert (world.gravity, world.iterations, world.precision) == ((0.0, -10.0), 10, "single")
    assert world.accumulate_impulses
    assert world.warm_starting
    assert world.position_correction
    body = world.create_body(Box(1, 1))
    assert (body.position, body.angle, body.velocity, body.angular_velocity) == ((0, 0), 0, (0, 0), 0)
    assert (body.kind, body.mass, body.friction) == ("dynamic", 1.0, 0.2)
    joint = world.create_joint_revolute(body, world.create_body(Circle(1)), anchor=(0, 0))
    assert joint.softness == 0
    assert joint.collide_connected


def test_numbers_of_any_type_give_the_same_bits() -> None:
    def make(kind) -> World:
        world = World(gravity=(kind(0), kind(-10)), precision="double")
        world.create_body(Box(kind(2), kind(1)), position=(kind(3), kind(4)), angle=kind(1), mass=kind(2),
                          velocity=np.array([kind(1), kind(2)]), friction=kind(0))  # fmt: skip
        world.step(kind(1))
        return world

    assert len({make(kind).state_hash() for kind in (int, float, np.float32, np.int16, np.float64)}) == 1


def test_a_row_of_a_destroyed_body_starts_afresh() -> None:
    world = World(gravity=(0, 0))
    old = world.create_body(Box(1, 1), angle=1.0, velocity=(3, 3), angular_velocity=4, friction=0.9)
    old.apply_force((5, 5), (1, 0))
    old.destroy()
    body = world.create_body(Circle(1), position=(2, 2))
    assert body._row == old._row
    assert (body.angle, body.velocity, body.angular_velocity, body.force, body.torque) == (0, (0, 0), 0, (0, 0), 0)
    assert body.direction == (1, 0)
    world.step(1.0)
    assert body.position == (2, 2)
