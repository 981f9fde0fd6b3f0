"""Mechanics with a known answer, through whole steps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, Box, Circle, World
from tests.engine.worlds import DT, PRECISIONS, floor, run, talk

G = 10.0
RESTS = dict.fromkeys(SOLVERS, 0.5) | {
    "sequential_impulses": 0.495
}  # height of a unit box that begins to rest on the floor [m]
ROLLS = {"soft_step": 1e-2, "sequential_impulses": 1e-4, "ngs": 3e-2, "direct": 3e-2, "xpbd": 2e-2, "avbd": 4e-2}
"""Part by which speeds of a rolling disc may differ. Where contacts are seen ahead this one is found once a step and
turns with the disc until the next: an error of the order of v dt / r."""

either = pytest.mark.parametrize("solver", SOLVERS)


def incline(angle: float, friction: float, precision: str = "double", solver: str = "soft_step") -> World:
    """A floor that gravity is tilted over, so that bodies slide towards +x."""
    world = World(gravity=(G * math.sin(angle), -G * math.cos(angle)), precision=precision, solver=solver)
    if solver in ("sequential_impulses", "ngs"):
        world.iterations = 30
    floor(world, friction)
    return world


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.8])
def test_sliding_stops_where_friction_says(friction: float) -> None:
    world = incline(0.0, friction)
    box = world.create_body(Box(2, 0.1), position=(0, 0.05), friction=friction, velocity=(4, 0))
    stop = 16 / (2 * friction * G)
    run(world, math.ceil(4 / (friction * G) / DT) + 5)
    assert box.velocity.x == pytest.approx(0.0, abs=1e-7)
    assert box.position.x == pytest.approx(stop, abs=4 * DT / 4 / 2)  # half a substep of its speed


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.8])
def test_sliding_stops_in_the_talk_where_friction_says(friction: float) -> None:
    # v falls by mu g dt each step, and the body moves with the new speed: it stops v dt / 2 short of v^2 / (2 mu g)
    world = incline(0.0, friction, solver="sequential_impulses")
    box = world.create_body(Box(2, 0.1), position=(0, 0.045), friction=friction, velocity=(4, 0))
    speeds, v = [], 4.0
    while v > 0:
        v = max(v - friction * G * DT, 0.0)
        speeds.append(v)
    run(world, len(speeds) + 5)
    assert box.velocity.x == pytest.approx(0.0, abs=1e-9)
    assert box.position.x == pytest.approx(DT * sum(speeds), rel=1e-6)
    assert box.position.x == pytest.approx(16 / (2 * friction * G) - 4 * DT / 2, abs=friction * G * DT * DT)


@either
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("friction", [0.2, 0.5])
def test_friction_angle(friction: float, precision: str, solver: str) -> None:
    critical = math.atan(friction)
    for angle in (critical - 0.02, critical + 0.02):
        world = incline(angle, friction, precision, solver)
        box = world.create_body(Box(2, 0.1), position=(0, RESTS[solver] - 0.45), friction=friction)
        run(world, 120)
        expected = max(G * (math.sin(angle) - friction * math.cos(angle)), 0.0) * 120 * DT
        near = 30 if solver == "avbd" else 1  # whose friction is not all there after 10 iterations
        assert box.velocity.x == pytest.approx(expected, rel=1e-3 * near, abs=1e-5 * near)
        if angle < critical:
            assert box.position.x == pytest.approx(0.0, abs=1e-4 * near)


@either
def test_without_friction_it_slides_freely(solver: str) -> None:
    world = incline(0.3, 0.0, solver=solver)
    box = world.create_body(Box(2, 0.1), position=(0, 0.045), friction=0.7)  # sqrt(0 * 0.7) = 0
    run(world, 60)
    assert box.velocity.x == pytest.approx(G * math.sin(0.3), rel=1e-9)


@either
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("angle", [0.1, 0.4])
def test_circle_rolls_down_with_two_thirds(angle: float, precision: str, solver: str) -> None:
    world = incline(angle, 1.0, precision, solver)
    circle = world.create_body(Circle(0.5), position=(0, 0.499999), friction=1.0)
    run(world, 60)
    assert circle.velocity.x == pytest.approx(2 / 3 * G * math.sin(angle), rel=ROLLS[solver])
    assert circle.angular_velocity == pytest.approx(-2 / 3 * G * math.sin(angle) / 0.5, rel=ROLLS[solver])  # clockwise


@either
def test_circle_slips_where_friction_is_too_weak_to_roll(solver: str) -> None:
    angle, friction = 0.6, 0.1  # rolling needs mu >= tan(angle) / 3
    world = incline(angle, friction, solver=solver)
    circle = world.create_body(Circle(0.5), position=(0, 0.499999), friction=friction)
    run(world, 60)
    assert circle.velocity.x == pytest.approx(G * (math.sin(angle) - friction * math.cos(angle)), rel=ROLLS[solver])
    assert circle.angular_velocity == pytest.approx(-2 * friction * G * math.cos(angle) / 0.5, rel=ROLLS[solver])


@either
def test_a_stack_at_rest_carries_the_weight_above(solver: str) -> None:
    world = World(precision="double", solver=solver, sleeping=False)
    if solver in ("sequential_impulses", "ngs"):
        world.iterations = 50
    floor(world)
    masses = [4.0, 1.0, 2.5, 0.5, 3.0]
    for k, mass in enumerate(masses):
        world.create_body(Box(1, 1), position=(0, RESTS[solver] * (2 * k + 1)), mass=mass)
    run(world, 300)
    records = world.contact_records()
    for below in range(5):
        between = records[(records["body1"] == below) & (records["body2"] == below + 1)]
        assert len(between) == 2
        assert between["normal_impulse"].sum() == pytest.approx(
            sum(masses[below:]) * G * DT, rel=3e-2 if solver == "avbd" else 1e-4
        )
        assert between["tangent_impulse"].sum() == pytest.approx(0.0, abs=1e-3)


@either
def test_every_action_has_its_reaction(solver: str) -> None:
    # contacts give both bodies the same impulse at the same point: neither momentum changes but by rounding. In
    # soft_step the point is that of the step's beginning, while the bodies go on moving in substeps: the angular
    # momentum drifts a little.
    drift = {"soft_step": 0.02, "sequential_impulses": 1e-12}.get(solver, 0.05)
    rng = np.random.default_rng(7)
    world = World(gravity=(0, 0), precision="double", solver=solver)
    rounding = 1e-12
    if solver == "avbd":  # body after body: kept as far as it has converged; with 10 iterations it is off by 23 kg m/s
        world.iterations, rounding = 1000, 1e-9
    for k in range(24):
        shape = Box(*rng.uniform(0.5, 1.5, 2)) if k % 3 else Circle(rng.uniform(0.3, 0.8))
        place = np.array([k % 5 - 2, k // 5 - 2]) * 1.6
        world.create_body(
            shape,
            position=tuple(place),
            angle=rng.uniform(0, 6),
            velocity=tuple(-place + rng.uniform(-1, 1, 2)),
            angular_velocity=rng.uniform(-3, 3),
            friction=0.5,
        )
    before = world.diagnostics()
    most = 0
    for _ in range(180):
        world.step(DT)
        after = world.diagnostics()
        most = max(most, after.contact_count)
        assert tuple(after.momentum) == pytest.approx(tuple(before.momentum), abs=rounding)
        assert after.angular_momentum == pytest.approx(before.angular_momentum, rel=drift)
    assert most > 20
    assert after.kinetic_energy < before.kinetic_energy


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_box_at_rest_stays_at_rest(precision: str) -> None:
    world = talk(precision=precision)
    floor(world)
    box = world.create_body(Box(1, 1), position=(0.3, 0.495))
    run(world, 600)
    assert tuple(box.position) == pytest.approx((0.3, 0.495), abs=1e-5)
    assert box.angle == pytest.approx(0.0, abs=1e-6)
    assert len(world.contact_records()) == 2


@pytest.mark.parametrize("precision", PRECISIONS)
def test_overlap_at_rest_stays_near_the_slop(precision: str) -> None:
    world = talk(precision=precision)
    floor(world)
    for k in range(6):
        world.create_body(Box(1, 1), position=(0, 0.5 + 1.05 * k))
    run(world, 600)
    assert 0.005 < world.diagnostics().max_penetration < 0.02
    assert np.abs(world.velocities).max() < 1e-3


def test_a_hit_in_the_middle_does_not_turn_it() -> None:
    world = World(gravity=(0, 0), precision="double")
    target = world.create_body(Box(1, 3), position=(1.0, 0))
    world.create_body(Circle(0.25), position=(0, 0), velocity=(5, 0))
    run(world, 60)
    assert target.angular_velocity == 0.0
    assert target.velocity.x > 0
    assert target.velocity.y == 0.0
