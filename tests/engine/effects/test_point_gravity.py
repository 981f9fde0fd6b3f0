"""Point gravity: the law, and orbits that close as the integrator's equations say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Circle, World
from engine.constants import CORE_RADIUS
from tests.engine.worlds import DT, PRECISIONS, run

pytestmark = pytest.mark.kernel

MU, RADIUS = 100.0, 5.0
SUBSTEPS = (1, 4, 16)


def system(substeps: int, position: tuple[float, float], velocity: tuple[float, float], mu: float = MU) -> World:
    """A sun that stands, and a planet."""
    world = World(gravity=(0, 0), precision="double", substeps=substeps)
    world.create_body(Circle(0.5), kind="static", attraction=mu)
    world.create_body(Circle(0.1), position=position, velocity=velocity, mass=7.0)
    return world


@pytest.mark.parametrize("distance", [0.5 * CORE_RADIUS, 2 * CORE_RADIUS, 3.0, 50.0])
def test_the_law(distance: float) -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_body(kind="static", attraction=2.0)
    bodies = [world.create_body(Circle(0.01), position=(0, -distance), mass=mass, group=-1) for mass in (1.0, 30.0)]
    world.step(DT)
    expected = 2.0 / distance**2 if distance > CORE_RADIUS else 2.0 * distance / CORE_RADIUS**3
    for body in bodies:
        assert body.velocity.y / DT == pytest.approx(expected, rel=1e-12)
        assert body.velocity.x == 0.0


@pytest.mark.parametrize("substeps", SUBSTEPS)
def test_a_circle_of_the_discrete_equations_closes_to_rounding(substeps: int) -> None:
    """Kicks at distance rho turn the planet by phi = 2 asin((dt / 2) sqrt(mu / rho^3)) each: whole turns come back.

    A step drifts by (1 - 1/n) dt / 2, is kicked, and drifts on: it begins that long before a kick, on the chord.
    """
    steps = 200
    phi = 2.0 * math.pi / steps
    mu = 4.0 * math.sin(0.5 * phi) ** 2 * RADIUS**3 / DT**2
    speed = 2.0 * RADIUS * math.sin(0.5 * phi) / DT
    before = 0.5 * (1.0 - 1.0 / substeps) * DT
    vx, vy = speed * math.sin(0.5 * phi), speed * math.cos(0.5 * phi)  # along the chord that ends at (RADIUS, 0)
    start = (RADIUS - before * vx, -before * vy)
    world = system(substeps, start, (vx, vy), mu)
    for turn in range(1, 4):
        run(world, steps)
        assert tuple(world.positions[1]) == pytest.approx(start, abs=1e-10 * turn)
        assert tuple(world.velocities[1]) == pytest.approx((vx, vy), abs=1e-10 * turn)


@pytest.mark.parametrize("substeps", SUBSTEPS)
def test_a_circular_orbit_closes_within_what_is_predicted(substeps: int) -> None:
    """Begun as the exact circle, after T = 2 pi sqrt(r^3 / mu) it lags by 2 pi r (w dt)^2 / 3 for the time step, and by
    2 pi r (w h)^2 3 / 8 for the substep, which begins it as an ellipse: both of second order.
    """
    w = math.sqrt(MU / RADIUS**3)
    period = 2.0 * math.pi / w
    steps = round(period / DT)
    dt = period / steps
    h = dt / substeps
    world = system(substeps, (RADIUS, 0.0), (0.0, w * RADIUS))
    run(world, steps, dt)
    lag = 2.0 * math.pi * RADIUS * w * w * (dt * dt / 3.0 + 3.0 * h * h / 8.0)
    x, y = world.positions[1]
    assert -y == pytest.approx(lag, rel=0.02)
    assert math.hypot(x, y) == pytest.approx(RADIUS, abs=RADIUS * (w * h) ** 2)


@pytest.mark.parametrize("substeps", SUBSTEPS)
def test_energy_does_not_drift(substeps: int) -> None:
    """An ellipse of eccentricity 0.5, 20 times round: the energy swings, and comes back."""
    world = system(substeps, (RADIUS, 0.0), (0.0, math.sqrt(MU / RADIUS * 0.5)))
    energies = []
    for _ in range(3000):
        world.step(DT)
        (x, y), v = world.positions[1], world.velocities[1]
        energies.append(0.5 * float(v @ v) - MU / math.hypot(x, y))
    first, last = energies[:600], energies[-600:]  # more than two rounds each
    swing = np.ptp(first)
    assert 1e-3 < swing < 2.0
    assert (np.min(last), np.max(last)) == pytest.approx((np.min(first), np.max(first)), abs=0.05 * swing)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_two_that_attract_each_other_keep_momentum(precision: str) -> None:
    world = World(gravity=(0, 0), precision=precision)
    heavy = world.create_body(Circle(0.3), mass=4.0, attraction=40.0)
    light = world.create_body(Circle(0.2), position=(3, 0), velocity=(0, 3), mass=1.0, attraction=10.0)
    heavy.velocity = (0, -0.75)
    run(world, 300)
    assert abs(light.position.y) > 0.1
    assert tuple(world.diagnostics().momentum) == pytest.approx((0, 0), abs=1e-11 if precision == "double" else 1e-4)


def test_the_one_that_attracts_feels_nothing_itself() -> None:
    world = World(gravity=(0, 0))
    sun = world.create_body(Circle(0.3), attraction=40.0)
    world.create_body(Circle(0.2), position=(3, 0))
    run(world, 5)
    assert tuple(sun.velocity) == (0.0, 0.0)
    assert {e.name: e.because for e in world.effects}["point gravity"] == "1 of 2 bodies has attraction"


@pytest.mark.parametrize("value", [math.nan, -math.inf, "down"])
def test_refused(value: object) -> None:
    body = World().create_body(Circle(0.1))
    with pytest.raises(ValueError, match=r"^attraction = .*: must be a finite number$"):
        body.attraction = value  # type: ignore[assignment]
