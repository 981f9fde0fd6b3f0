"""What a state adds up to, against sums written out."""

from __future__ import annotations

import math

import pytest

from engine import Box, Circle, World
from tests.engine.worlds import DT, PRECISIONS, busy, floor, gathering, run

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("make", [busy, gathering])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_sums_over_bodies(precision: str, make) -> None:
    world = run(make(precision, gravity=(1, -9)), 40)
    energy, momentum, angular, potential = 0.0, [0.0, 0.0], 0.0, 0.0
    for body in world.bodies:
        if body.kind != "dynamic":
            continue
        (x, y), (vx, vy), w = body.center, body.velocity, body.angular_velocity
        energy += body.mass * (vx * vx + vy * vy) / 2 + body.inertia * w * w / 2
        potential -= body.mass * (x - 9 * y)
        momentum[0] += body.mass * vx
        momentum[1] += body.mass * vy
        angular += body.mass * (x * vy - y * vx) + body.inertia * w
    found = world.diagnostics()
    assert found.kinetic_energy == pytest.approx(energy, rel=1e-12)
    assert found.potential_energy == pytest.approx(potential, rel=1e-12)
    assert found.energy == found.kinetic_energy + found.potential_energy
    assert tuple(found.momentum) == pytest.approx(tuple(momentum), rel=1e-12)
    assert found.angular_momentum == pytest.approx(angular, rel=1e-12)
    records = world.contact_records()
    assert found.contact_count == len(records) > 0
    assert found.max_penetration == -records["separation"].min() > 0


def test_empty_world() -> None:
    assert World().diagnostics() == (0.0, 0.0, (0.0, 0.0), 0.0, 0.0, 0)


def test_sums_are_taken_in_double() -> None:
    world = World(precision="single")
    world.create_body(Circle(1), mass=1e8, velocity=(1, 0))
    world.create_body(Circle(1), mass=1, velocity=(1, 0))
    assert world.diagnostics().momentum.x == 1e8 + 1


def test_free_fall_keeps_its_energy_but_for_the_time_step() -> None:
    # symplectic Euler: m g y falls short by m g (g h t / 2), h being the time of a substep
    for solver, substeps in (("soft_step", 4), ("soft_step", 7), ("sequential_impulses", 1)):
        world = World(precision="double", solver=solver, substeps=substeps)
        world.create_body(Box(1, 1), mass=2, velocity=(1, 3), angular_velocity=1)
        before = world.diagnostics().energy
        run(world, 100)
        h, t = DT / substeps, 100 * DT
        assert world.diagnostics().energy - before == pytest.approx(-2 * 10 * (10 * h * t / 2), rel=1e-9)


def test_penetration_is_the_deepest() -> None:
    world = World(gravity=(0, 0), precision="double")
    floor(world)
    for k, depth in enumerate((0.1, 0.3, 0.2)):
        world.create_body(Circle(1), position=(3 * k, 1 - depth))
    world.step(DT)
    assert math.isclose(world.diagnostics().max_penetration, 0.3, rel_tol=1e-12)
