"""Explosions: an impulse as strong as what faces it is wide, in full, in part, or not at all."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Body, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from tests.engine.worlds import DT, POINTS, PRECISIONS, fingerprint, regular, run

pytestmark = pytest.mark.kernel


def alone(shape: Shape, position: tuple[float, float], angle: float = 0.0, **settings: Any) -> tuple[World, Body]:
    world = World(**{"gravity": (0, 0), "precision": "double", **settings})
    return world, world.create_body(shape, position=position, angle=angle, mass=2.0)


def impulse_on(body: Body) -> np.ndarray:
    """What it got, having been at rest [N s]."""
    return np.array(body.velocity) * body.mass


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_box_gets_the_impulse_of_its_face(precision: str) -> None:
    world, box = alone(Box(1, 3), (4.0, 0.5), precision=precision)
    world.explode((0, 0), radius=10, impulse=5.0)
    assert impulse_on(box) == pytest.approx((15.0, 0.0), rel=1e-6)
    # at the nearest point of the face, 0.5 m below the centre and 0.5 m to its left
    assert box.angular_velocity * box.inertia == pytest.approx(0.5 * 15.0, rel=1e-6)


@pytest.mark.parametrize(
    ("shape", "width", "nearest"),
    [
        (Circle(0.7), 1.4, 0.7),
        (Capsule(1.0, 0.3), 0.6, 0.8),
        (Polygon(regular(4, 1.0)), 2.0, 1.0),
        (Polygon(regular(4, 1.0), radius=0.25), 2.5, 1.25),
    ],
    ids=str,
)
@pytest.mark.parametrize("turned", [0.0, 1.0, math.pi])
def test_how_wide_a_shape_is(shape: Shape, width: float, nearest: float, turned: float) -> None:
    """Seen along its own x axis, in whatever direction that is."""
    away = np.array((math.cos(turned), math.sin(turned)))
    world, body = alone(shape, tuple(3.0 * away), turned)
    world.explode((0, 0), radius=3.0 - nearest + 1e-9, impulse=1.0)
    assert impulse_on(body) == pytest.approx(width * away)
    assert body.angular_velocity == pytest.approx(0.0, abs=1e-12)
    world, body = alone(shape, tuple(3.0 * away), turned)
    world.explode((0, 0), radius=3.0 - nearest - 1e-9, impulse=1.0)
    assert tuple(body.velocity) == (0.0, 0.0), "that far it does not reach"


@pytest.mark.parametrize(
    ("distance", "part"), [(1.0, 1.0), (2.0, 1.0), (2.5, 0.75), (3.0, 0.5), (3.99, 0.005), (4.0, 0.0), (9.0, 0.0)]
)
def test_it_falls_off(distance: float, part: float) -> None:
    world, ball = alone(Circle(0.5), (0.0, distance + 0.5))
    world.explode((0, 0), radius=2.0, falloff=2.0, impulse=3.0)
    assert impulse_on(ball) == pytest.approx((0.0, 3.0 * part), abs=1e-12)


def test_without_falloff_it_ends_at_the_radius() -> None:
    world, ball = alone(Circle(0.5), (0.0, 2.5))
    world.explode((0, 0), radius=2.0, impulse=3.0)
    assert impulse_on(ball) == pytest.approx((0.0, 3.0))


def test_a_negative_one_pulls() -> None:
    world, ball = alone(Circle(0.5), (2.0, 0.0))
    world.explode((0, 0), radius=3.0, impulse=-3.0)
    assert impulse_on(ball) == pytest.approx((-3.0, 0.0))


@given(x=st.floats(-3, 3), y=st.floats(-3, 3), angle=st.floats(-3, 3), which=st.integers(0, 2))
def test_where_it_acts_against_a_search(x: float, y: float, angle: float, which: int) -> None:
    """Nearest point and width, found by trying many points of the outline."""
    points = (POINTS, ((-0.5, -1), (0.5, -1), (0.5, 1), (-0.5, 1)), ((0, 0), (2, 0), (0, 1)))[which]
    shape = Polygon(points)
    world, body = alone(shape, (x, y), angle)
    center = np.array(body.center)
    c, s = math.cos(angle), math.sin(angle)
    corners = np.array(shape.points) @ np.array(((c, s), (-s, c))) + (x, y)
    t = np.linspace(0, 1, 2001)[:, None]
    outline = np.concatenate([a + t * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)])
    nearest = outline[np.argmin(np.hypot(*outline.T))]
    distance = float(np.hypot(*nearest))
    world.explode((0, 0), radius=100.0, impulse=1.0)
    if body.contains((0, 0)) or distance < 1e-2:
        return
    direction = nearest / distance
    across = corners @ (-direction[1], direction[0])
    expected = direction * (across.max() - across.min())
    assert impulse_on(body) == pytest.approx(expected, abs=3e-3 / distance)
    arm = nearest - center
    turn = arm[0] * expected[1] - arm[1] * expected[0]
    assert body.angular_velocity * body.inertia == pytest.approx(turn, abs=2e-2 / distance)


def test_from_within_it_pushes_at_the_middle() -> None:
    world, box = alone(Box(2, 2), (0.3, 0.0))
    world.explode((0, 0), radius=1.0, impulse=1.0)
    assert impulse_on(box) == pytest.approx((2.0, 0.0))
    assert box.angular_velocity == 0.0
    world, box = alone(Box(2, 2), (0.0, 0.0))
    world.explode((0, 0), radius=1.0, impulse=1.0)
    assert tuple(box.velocity) == (0.0, 0.0), "from the very middle there is no direction"


def test_only_what_can_move_feels_it() -> None:
    world = World(gravity=(0, 0))
    wall = world.create_body(Box(1, 1), position=(2, 0), kind="static")
    cart = world.create_body(Box(1, 1), position=(-2, 0), kind="kinematic", velocity=(0, 1))
    nothing = world.create_body(position=(0, 1))
    fence = world.create_body(Chain(((0, 2), (3, 2), (6, 2))), kind="static")
    world.explode((0, 0), radius=9.0, impulse=7.0)
    assert [tuple(body.velocity) for body in (wall, cart, nothing, fence)] == [(0, 0), (0, 1), (0, 0), (0, 0)]


def test_each_shape_of_a_body_gets_its_own() -> None:
    world = World(gravity=(0, 0), precision="double")
    body = world.create_body(Circle(0.5), position=(3, 1))
    body.add_shape(Circle(0.5), offset=(0, -2))
    body.add_shape(Segment((0, -1), (0, 0)))
    world.explode((0, 0), radius=9.0, impulse=1.0)
    px, py = np.array(body.velocity) * body.mass
    assert px == pytest.approx(2.0 * 3.0 / math.sqrt(10.0) + 1.0)
    assert py == pytest.approx(0.0, abs=1e-12)


def test_it_acts_at_once_and_is_counted() -> None:
    world, ball = alone(Circle(0.5), (2.0, 0.0))
    run(world, 3)
    assert {e.name: e.because for e in world.effects}["explosions"] == ""
    world.explode((0, 0), radius=3.0, impulse=1.0)
    assert ball.velocity.x > 0.0
    assert {e.name: e.because for e in world.effects}["explosions"] == "1 explosion so far"
    kept = world.snapshot()
    world.explode((0, 0), radius=3.0, impulse=1.0)
    assert {e.name: e.because for e in world.effects}["explosions"] == "2 explosions so far"
    world.restore(kept)
    assert {e.name: e.because for e in world.effects}["explosions"] == "1 explosion so far"
    expected = run(world, 5).state_hash()
    world.restore(kept)
    assert run(world, 5).state_hash() == expected
    assert "explosions" in world._state.effects
    assert world._state.forces == [], "a step runs no code of it"


GOOD: dict[str, Any] = {"position": (0, 0), "radius": 3.0, "impulse": 1.0}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"position": (0, math.nan)}, r"position = .*: must be two finite numbers \(x, y\)"),
        ({"radius": -1}, "radius = -1: must be a finite number >= 0"),
        ({"radius": "all"}, "radius = 'all': must be a finite number >= 0"),
        ({"falloff": math.inf}, "falloff = inf: must be a finite number >= 0"),
        ({"impulse": math.nan}, "impulse = nan: must be a finite number"),
        ({"impulse": 1e39}, "impulse = 1e.39: must be one that velocities in single precision can hold"),
    ],
)
def test_refused(change: dict[str, Any], message: str) -> None:
    world, _ = alone(Circle(0.5), (2.0, 0.0), precision="single")
    world.step(DT)
    before = fingerprint(world)
    with pytest.raises(ValueError, match=f"^{message}$"):
        world.explode(**{**GOOD, **change})
    assert fingerprint(world) == before
