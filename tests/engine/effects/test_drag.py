"""Drag and wind against their closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Body, Box, Circle, World
from tests.engine.worlds import DT, PRECISIONS, fingerprint, run

pytestmark = pytest.mark.kernel

EXACT = {"single": 2e-6, "double": 1e-12}  # rounding of the solver's own numbers over a second


def one_body(precision: str = "double", **settings: Any) -> tuple[World, Body]:
    """A world with one body of 2 kg in it, and that."""
    world = World(precision=precision, **settings)
    return world, world.create_body(Circle(0.5), mass=2.0)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulses"])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_falling_body_ends_at_the_terminal_speed(precision: str, solver: str) -> None:
    world, body = one_body(precision, solver=solver)
    body.drag = 0.4
    run(world, 1200)
    speed = math.sqrt(2.0 * 10.0 / 0.4)
    # the speed stops changing where its change in a substep is lost: (g - c v^2 / m) h < half a unit in the last place
    lost = 0.5 * float(np.spacing(np.float32(speed) if precision == "single" else speed))
    bar = lost / (DT / world.substeps) / (2.0 * 0.4 * speed / 2.0)
    assert -body.velocity.y == pytest.approx(speed, abs=1.5 * bar)
    assert body.velocity.x == 0.0


def expected(speed: float, drag: float, acceleration: float) -> float:
    """The speed after one step of a body of 2 kg."""
    z = DT * drag * abs(speed) / 2.0
    left = 1.0 - z if z <= 0.5 else 0.25 / z
    return speed * left + DT * acceleration


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("drag", [0.01, 1.0, 30.0, 1e4])
def test_each_step_is_the_recurrence(precision: str, drag: float) -> None:
    world, body = one_body(precision)
    body.drag, body.velocity = drag, (0.0, 9.0)
    speed = 9.0
    for _ in range(60):
        world.step(DT)
        speed = expected(speed, drag, -10.0)
        assert body.velocity.y == pytest.approx(speed, rel=EXACT[precision], abs=EXACT[precision])


speeds = st.floats(-100.0, 100.0)


@given(drag=st.floats(0.0, 1e9), vx=speeds, vy=speeds, wx=speeds, wy=speeds)
def test_drag_never_turns_a_body_round(drag: float, vx: float, vy: float, wx: float, wy: float) -> None:
    world, body = one_body(gravity=(0.0, 0.0), wind=(wx, wy))
    body.drag, body.velocity = drag, (vx, vy)
    before = np.array((vx - wx, vy - wy))
    world.step(DT)
    after = np.array(body.velocity) - (wx, wy)
    size = np.hypot(*before)
    assert after @ before >= -1e-9 * size, "still the same way through the air"
    assert np.hypot(*after) <= size * (1.0 + 1e-12), "and no faster"
    assert abs(after[0] * before[1] - after[1] * before[0]) <= 1e-9 * size, "along the same line"


@given(drag=st.floats(0.0, 1e4), slow=st.floats(0.0, 100.0), more=st.floats(0.0, 100.0))
def test_the_faster_of_two_bodies_stays_it(drag: float, slow: float, more: float) -> None:
    assert expected(slow, drag, 0.0) <= expected(slow + more, drag, 0.0) * (1.0 + 1e-12)


def test_wind_takes_a_body_along() -> None:
    world, body = one_body(gravity=(0.0, 0.0), wind=(6.0, 0.0))
    body.drag = 1.0
    speeds = []
    for _ in range(600):
        world.step(DT)
        speeds.append(body.velocity.x)
    exact = 6.0 - 6.0 / (1.0 + 1.0 * 6.0 * world.time / 2.0)
    assert np.all(np.diff(speeds) > 0.0)
    assert np.max(speeds) < 6.0
    assert speeds[-1] == pytest.approx(exact, rel=1e-3)


def test_a_body_that_friction_holds_feels_the_whole_wind() -> None:
    world = World(precision="double", wind=(5.0, 0.0))
    world.create_body(Box(50, 2), position=(0, -1), kind="static", friction=1.0)
    world.create_body(Box(1, 1), position=(0, 0.5), mass=2.0, friction=1.0, drag=0.2)
    run(world, 120)
    contacts = world.contact_records()
    assert contacts["normal_impulse"].sum() / DT == pytest.approx(20.0, rel=1e-4), "it stands with its weight"
    assert abs(contacts["tangent_impulse"].sum()) / DT == pytest.approx(0.2 * 25.0, rel=1e-3)


def test_wind_is_called_for_by_drag_alone() -> None:
    world, body = one_body()
    status = {effect.name: effect.because for effect in world.effects}
    assert (status["drag"], status["wind"]) == ("", "")
    world.wind = (3.0, 0.5)
    assert {e.name: e.because for e in world.effects}["wind"] == ""
    world.step(DT)
    assert body.velocity.x == 0.0
    body.drag = 0.1
    status = {effect.name: effect.because for effect in world.effects}
    assert status["drag"] == "1 of 1 bodies has drag"
    assert status["wind"] == "wind of (3, 0.5) m/s on 1 of 1 bodies"
    world.step(DT)
    assert body.velocity.x > 0.0
    body.drag = 0.0
    assert not {e.name: e.called_for for e in world.effects}["wind"]


def test_bodies_that_no_force_moves_have_it_without_effect() -> None:
    world = World(wind=(5.0, 0.0))
    wall = world.create_body(Box(1, 1), kind="static", drag=1.0)
    cart = world.create_body(Box(1, 1), position=(5, 0), kind="kinematic", velocity=(1, 0), drag=1.0)
    nothing = world.create_body(drag=1.0)  # without a shape it has no mass
    run(world, 3)
    assert tuple(wall.position) == (0.0, 0.0)
    assert tuple(cart.velocity) == (1.0, 0.0)
    assert nothing.alive


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, "much", True])
def test_refused(value: object) -> None:
    world, body = one_body()
    before = fingerprint(world)
    with pytest.raises(ValueError, match=r"^drag = .*: must be a finite number >= 0$"):
        body.drag = value  # type: ignore[assignment]
    with pytest.raises(ValueError, match=r"^drag = .*: must be a finite number >= 0$"):
        world.create_body(Circle(1), drag=value)
    assert fingerprint(world) == before
