"""Magnets: the law of force, and momentum."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Box, Circle, World
from engine.constants import CORE_RADIUS, MAGNET_CONSTANT
from tests.engine.worlds import DT, PRECISIONS, run

pytestmark = pytest.mark.kernel


def pushed(p1: float, p2: float, way: tuple[float, float], precision: str = "double") -> tuple[np.ndarray, np.ndarray]:
    """Forces on two magnets, the second one that way from the first [N]."""
    world = World(gravity=(0, 0), precision=precision)
    one = world.create_body(Circle(0.01), position=(3, 4), mass=2.0, magnet=p1, group=-1)
    two = world.create_body(Circle(0.01), position=(3 + way[0], 4 + way[1]), mass=3.0, magnet=p2, group=-1)
    world.step(DT)
    return np.array(one.velocity) * 2.0 / DT, np.array(two.velocity) * 3.0 / DT


strengths = st.floats(-10, 10)


@given(p1=strengths, p2=strengths, distance=st.floats(2 * CORE_RADIUS, 100), angle=st.floats(0, 2 * math.pi))
def test_the_force_is_as_the_square_of_the_distance(p1: float, p2: float, distance: float, angle: float) -> None:
    direction = np.array((math.cos(angle), math.sin(angle)))
    on_one, on_two = pushed(p1, p2, tuple(direction * distance))
    force = MAGNET_CONSTANT * p1 * p2 / distance**2  # > 0: apart
    assert on_two == pytest.approx(force * direction, rel=1e-10, abs=1e-12)
    assert on_one == pytest.approx(-on_two, rel=1e-14, abs=1e-14)


def test_equal_signs_repel() -> None:
    assert pushed(1, 1, (1, 0))[1][0] == pytest.approx(1.0)
    assert pushed(-1, -1, (1, 0))[1][0] == pytest.approx(1.0)
    assert pushed(1, -1, (1, 0))[1][0] == pytest.approx(-1.0)


@pytest.mark.parametrize("part", [0.0, 0.25, 0.5, 0.999])
def test_within_the_core_it_falls_off_to_nothing(part: float) -> None:
    force = pushed(1, 1, (part * CORE_RADIUS, 0.0))[1]
    assert force == pytest.approx((part / CORE_RADIUS**2, 0.0), rel=1e-9)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_momentum_is_kept(precision: str) -> None:
    world = World(gravity=(0, 0), precision=precision)
    rng = np.random.default_rng(3)
    for k in range(12):
        world.create_body(Circle(0.1), position=rng.uniform(-3, 3, 2), magnet=rng.uniform(-1, 1), mass=1 + 0.1 * k)
    run(world, 60)
    momentum = np.array(world.diagnostics().momentum)
    assert np.abs(world.velocities).max() > 0.1
    assert momentum == pytest.approx((0, 0), abs=1e-13 if precision == "double" else 2e-5)


def test_forces_on_a_pair_are_the_same_bits() -> None:
    world = World(gravity=(0, 0), precision="double", substeps=1)
    for x, y in ((0.1, 0.7), (1.3, -0.4)):
        world.create_body(Circle(0.1), position=(x, y), mass=2.0, magnet=0.3)
    world.step(DT)
    assert np.array_equal(world.velocities[0], -world.velocities[1])


def test_what_no_force_moves_acts_and_feels_nothing() -> None:
    world = World(gravity=(0, 0))
    post = world.create_body(Box(0.2, 0.2), kind="static", magnet=2.0)
    ball = world.create_body(Circle(0.1), position=(2, 0), mass=1.0, magnet=2.0)
    iron = world.create_body(Circle(0.1), position=(0, 2), mass=1.0)
    world.step(DT)
    assert ball.velocity.x == pytest.approx(DT * 1.0, rel=1e-6)
    assert tuple(post.position) == (0.0, 0.0)
    assert tuple(iron.velocity) == (0.0, 0.0)


def test_it_takes_two() -> None:
    world = World()
    one = world.create_body(Circle(0.1), magnet=1.0)
    assert {e.name: e.because for e in world.effects}["magnets"] == ""
    world.create_body(Circle(0.1), position=(1, 0), magnet=-1.0)
    world.create_body(Circle(0.1), position=(2, 0))
    assert {e.name: e.because for e in world.effects}["magnets"] == "2 of 3 bodies have a magnet"
    one.magnet = 0.0
    assert not {e.name: e.called_for for e in world.effects}["magnets"]


@pytest.mark.parametrize("value", [math.nan, math.inf, "strong", None])
def test_refused(value: object) -> None:
    body = World().create_body(Circle(0.1))
    with pytest.raises(ValueError, match=r"^magnet = .*: must be a finite number$"):
        body.magnet = value  # type: ignore[assignment]
