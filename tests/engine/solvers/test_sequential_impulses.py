"""The talk's solver: its effective masses, one impact worked out by hand, and what each of its switches does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Circle
from engine.solvers.sequential_impulses import effective_mass
from engine.tables import empty, motion_dtype
from engine.vec2 import Vec2
from tests.engine.worlds import DT, PRECISIONS, busy, floor, run, talk

pytestmark = pytest.mark.kernel

MASS = 3.0
WIDTHS = (1e-6, 0.1, 0.5, 1.0, 2.0, 7.0, 1e6)


def corner_mass(a: float, mass: float) -> float:
    """Effective mass of a box of width a and height 1 at a bottom corner, along the vertical (talk, example 3)."""
    return (a * a + 1) / (4 * a * a + 1) * mass


def motions(*bodies: tuple[float, float], precision: str = "double") -> np.ndarray:
    """A motion row for each (mass, inertia)."""
    rows = empty(len(bodies), motion_dtype(precision))
    rows["inverse_mass"] = [1 / mass for mass, _ in bodies]
    rows["inverse_inertia"] = [1 / inertia for _, inertia in bodies]
    return rows


@pytest.mark.parametrize("a", WIDTHS)
def test_effective_mass_of_a_corner(a: float) -> None:
    rows = motions((math.inf, math.inf), (MASS, Box(a, 1).inertia(MASS)))
    m = effective_mass(rows[0], rows[1], Vec2(5.0, 1.0), Vec2(0.5 * a, -0.5), Vec2(0.0, 1.0))
    assert m == pytest.approx(corner_mass(a, MASS), rel=1e-12)


def test_effective_mass_of_the_talks_special_cases() -> None:
    assert corner_mass(1.0, 1.0) == 2 / 5
    rows = motions((math.inf, math.inf), (MASS, 0.7), (MASS, 0.7))
    up, center = Vec2(0.0, 1.0), Vec2(0.0, -0.5)
    # below the centre: the whole mass; two alike: half of it
    assert effective_mass(rows[0], rows[1], center, center, up) == pytest.approx(MASS, rel=1e-15)
    assert effective_mass(rows[1], rows[2], -center, center, up) == pytest.approx(MASS / 2, rel=1e-15)
    for a, limit in ((1e-9, MASS), (1e9, MASS / 4)):
        rows = motions((math.inf, math.inf), (MASS, Box(a, 1).inertia(MASS)))
        m = effective_mass(rows[0], rows[1], center, Vec2(0.5 * a, -0.5), up)
        assert m == pytest.approx(limit, rel=1e-12)


def test_effective_mass_in_single() -> None:
    rows = motions((math.inf, math.inf), (1.0, Box(1, 1).inertia(1.0)), precision="single")
    r, up = Vec2(np.float32(0.5), np.float32(-0.5)), Vec2(np.float32(0.0), np.float32(1.0))
    assert float(effective_mass(rows[0], rows[1], r, r, up)) == pytest.approx(0.4, rel=1e-6)


def impact(a: float, precision: str, tilt: float) -> tuple[float, float, float]:
    """Impulse, velocity and spin of a box a x 1 that falls with 2 m/s on its lower right corner, without friction."""
    world = talk(gravity=(0, 0), precision=precision, iterations=1, position_correction=False)
    floor(world)
    y = 0.5 * math.cos(tilt) + 0.5 * a * math.sin(tilt) - 0.1 * a * tilt  # the left corner is still above the floor
    box = world.create_body(Box(a, 1), position=(0, y), angle=-tilt, mass=MASS, velocity=(0, -2), friction=0)
    world.step(DT)
    records = world.contact_records()
    assert len(records) == 1
    return float(records["normal_impulse"][0]), box.velocity.y, box.angular_velocity


@pytest.mark.parametrize("a", [0.1, 0.5, 1.0, 2.0, 7.0])
def test_impact_on_a_corner(a: float) -> None:
    impulse, speed, spin = impact(a, "double", 1e-8)
    assert impulse == pytest.approx(corner_mass(a, MASS) * 2, rel=1e-6)
    assert speed == pytest.approx(-2 + impulse / MASS, rel=1e-9)
    assert spin == pytest.approx(0.5 * a * impulse / Box(a, 1).inertia(MASS), rel=1e-6)
    assert speed + spin * 0.5 * a == pytest.approx(0.0, abs=1e-6)  # the corner stops


def test_impact_in_single() -> None:
    assert impact(1.0, "single", 1e-5)[0] == pytest.approx(2 / 5 * MASS * 2, rel=1e-4)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_impact_of_two_equal_bodies(precision: str) -> None:
    # m_n = m / 2, and nothing bounces: both go on with the mean of their speeds
    world = talk(gravity=(0, 0), precision=precision, iterations=1, position_correction=False)
    left = world.create_body(Circle(0.5), position=(-0.499, 0), mass=MASS, velocity=(3, 0))
    right = world.create_body(Circle(0.5), position=(0.499, 0), mass=MASS, velocity=(-1, 0))
    world.step(DT)
    assert world.arbiters[0].contacts[0].normal_impulse == pytest.approx(MASS / 2 * 4, rel=1e-6)
    assert left.velocity.x == pytest.approx(1.0, rel=1e-6)
    assert right.velocity.x == pytest.approx(1.0, rel=1e-6)


def test_bodies_that_part_get_no_impulse() -> None:
    world = talk(gravity=(0, 0), precision="double", position_correction=False)
    world.create_body(Circle(0.5), position=(-0.499, 0), velocity=(-1, 0))
    world.create_body(Circle(0.5), position=(0.499, 0), velocity=(1, 0))
    world.step(DT)
    assert world.arbiters[0].contacts[0].normal_impulse == 0.0
    assert world.velocities[:, 0].tolist() == [-1.0, 1.0]


@pytest.mark.parametrize("accumulate", [True, False])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_impulses_push_and_friction_stays_in_its_cone(accumulate: bool, precision: str) -> None:
    world = busy(precision, solver="sequential_impulses", accumulate_impulses=accumulate)
    for _ in range(100):
        world.step(DT)
        for arbiter in world.arbiters:
            for contact in arbiter.contacts:
                assert contact.normal_impulse >= 0.0
                assert abs(contact.tangent_impulse) <= arbiter.friction * contact.normal_impulse * (1 + 1e-6)


def test_friction_is_the_geometric_mean() -> None:
    world = talk(precision="double")
    floor(world, friction=0.9)
    world.create_body(Box(1, 1), position=(0, 0.499), friction=0.4)
    world.step(DT)
    assert world.arbiters[0].friction == math.sqrt(0.9 * 0.4)


def test_friction_is_bounded_by_the_normal_impulse() -> None:
    world = talk(precision="double", position_correction=False)
    floor(world, friction=0.5)
    box = world.create_body(Circle(0.5), position=(0, 0.4999), mass=2, velocity=(5, 0), friction=0.5)
    world.step(DT)
    contact = world.arbiters[0].contacts[0]
    assert contact.normal_impulse == pytest.approx(2 * 10 * DT, rel=1e-12)
    assert abs(contact.tangent_impulse) == pytest.approx(0.5 * contact.normal_impulse, rel=1e-12)
    assert box.velocity.x == pytest.approx(5 - 0.5 * 10 * DT, rel=1e-12)  # friction brakes


@pytest.mark.parametrize("precision", PRECISIONS)
def test_position_correction_removes_a_fifth_of_the_overlap_beyond_the_slop(precision: str) -> None:
    for correct in (True, False):
        world = talk(gravity=(0, 0), precision=precision, position_correction=correct)
        floor(world)
        circle = world.create_body(Circle(0.5), position=(0, 0.4))
        world.step(DT)
        expected = 0.2 * (0.1 - 0.01) if correct else 0.0
        assert circle.position.y - 0.4 == pytest.approx(expected, abs=1e-6)


def test_overlap_within_the_slop_is_left_alone() -> None:
    world = talk(gravity=(0, 0), precision="double")
    floor(world)
    circle = world.create_body(Circle(0.5), position=(0, 0.4901))
    run(world, 20)
    assert circle.position.y == 0.4901
    assert len(world.arbiters) == 1


def test_warm_starting_begins_with_the_impulses_of_the_step_before() -> None:
    # a settled box: one pass suffices if it starts from the answer, and falls short otherwise
    settled = talk(precision="double", iterations=40)
    floor(settled)
    for k in range(4):
        settled.create_body(Box(1, 1), position=(0, 0.495 + 0.99 * k))
    run(settled, 60)
    assert len(settled.contact_records()) == 8
    left_over = {}
    for warm in (True, False):
        world = talk(precision="double")
        world.restore(settled.snapshot())
        world.set(iterations=1, warm_starting=warm)
        world.step(DT)
        left_over[warm] = np.abs(world.velocities).max()
    assert left_over[True] < 1e-3
    assert left_over[False] > 50 * left_over[True]


def test_without_accumulation_nothing_is_carried() -> None:
    world = busy("double", solver="sequential_impulses", accumulate_impulses=False)
    records = run(world, 60).contact_records()
    assert len(records) > 0
    assert not records["normal_impulse"].any()


def test_more_iterations_come_nearer_to_the_answer() -> None:
    errors = []
    for iterations in (1, 4, 16, 64):
        world = talk(precision="double", iterations=iterations, warm_starting=False, position_correction=False)
        floor(world)
        for k in range(3):
            world.create_body(Box(1, 1), position=(0, 0.499 + 0.999 * k))
        world.step(DT)
        errors.append(np.abs(world.velocities).max())
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.05 * errors[0]
