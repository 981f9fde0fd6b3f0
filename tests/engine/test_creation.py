"""Making bodies and joints: mass properties, and anchors in the bodies' own frames."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import SOLVERS, Box, Circle, World
from tests.engine.worlds import PRECISIONS, talk

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("shape", [Box(2, 0.5), Circle(3)])
def test_mass_properties(shape, precision: str) -> None:
    world = World(precision=precision)
    body = world.create_body(shape, density=3.0)
    assert body.mass == 3.0 * shape.area
    assert body.inertia == shape.inertia(body.mass)
    rounding = 1e-15 if precision == "double" else 1e-7
    assert body.inverse_mass * body.mass == pytest.approx(1.0, rel=rounding)
    assert body.inverse_inertia * body.inertia == pytest.approx(1.0, rel=rounding)
    still = world.create_body(shape, kind="static")
    assert (still.mass, still.inertia, still.inverse_mass, still.inverse_inertia) == (math.inf, math.inf, 0.0, 0.0)


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
    for world, passes in ((World(), (4, 1)), (talk(), (1, 10))):
        assert (world.gravity, world.precision) == ((0.0, -10.0), "single")
        assert (world.substeps, world.iterations) == passes
        assert world.accumulate_impulses
        assert world.warm_starting
        assert world.position_correction
    assert World().solver == "soft_step"
    body = world.create_body(Box(1, 1))
    assert (body.position, body.angle, body.velocity, body.angular_velocity) == ((0, 0), 0, (0, 0), 0)
    assert (body.kind, body.mass, body.friction) == ("dynamic", 1.0, 0.2)
    joint = world.create_joint_revolute(body, world.create_body(Circle(1)), anchor=(0, 0))
    assert joint.softness == 0
    assert joint.bias_factor is None
    assert joint.collide_connected


@pytest.mark.parametrize("solver", SOLVERS)
def test_numbers_of_any_type_give_the_same_bits(solver: str) -> None:
    def make(kind) -> World:
        world = World(solver=solver, gravity=(kind(0), kind(-10)), precision="double")
        world.create_body(Box(kind(2), kind(1)), position=(kind(3), kind(4)), angle=kind(1), mass=kind(2),
                          velocity=np.array([kind(1), kind(2)]), friction=kind(0))  # fmt: skip
        world.step(kind(1))
        return world

    assert len({make(kind).state_hash() for kind in (int, float, np.float32, np.int16, np.float64)}) == 1


def test_a_row_of_a_destroyed_body_starts_afresh() -> None:
    world = World(gravity=(0, 0))
    old = world.create_body(
        Box(1, 1), angle=1.0, velocity=(3, 3), angular_velocity=4, friction=0.9, linear_damping=3, restitution=1
    )
    old.apply_force((5, 5), (1, 0))
    old.destroy()
    body = world.create_body(Circle(1), position=(2, 2))
    assert body._row == old._row
    assert (body.angle, body.velocity, body.angular_velocity, body.force, body.torque) == (0, (0, 0), 0, (0, 0), 0)
    assert body.direction == (1, 0)
    assert (body.linear_damping, body.shapes[0].restitution, body.friction) == (0, 0, 0.2)
    world.step(1.0)
    assert body.position == (2, 2)
