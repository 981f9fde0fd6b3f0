"""Every measure, against worlds and histories made by hand whose value is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Circle, World
from sandbox.lab import measures
from tests.sandbox.lab.experimenting import empty_world

DT = 1 / 60

# --- of a state -------------------------------------------------------------------------------------------------------


def overlapping(depth: float, friction: float = 0.5, gravity: bool = False) -> World:
    """A ball of 2 kg so deep in the floor, after a step so short that nothing moved."""
    world = empty_world()
    if not gravity:
        world.gravity = (0.0, 0.0)
    world.create_body(Box(10, 2), position=(0, -1), kind="static", friction=friction)
    world.create_body(Circle(0.5), position=(0, 0.5 - depth), mass=2.0, friction=friction)
    world.step(1e-9)
    return world


@pytest.mark.parametrize("depth", [0.0, 0.01, 0.2])
def test_penetration(depth: float) -> None:
    assert measures.penetration(overlapping(depth)) == pytest.approx(depth, abs=1e-8)


def test_nothing_touches_in_an_empty_world() -> None:
    world = World()
    assert measures.penetration(world) == measures.joint_error(world) == measures.joint_turn_error(world) == 0.0
    assert measures.cone_violation(world) == measures.complementarity(world, DT) == measures.NOWHERE
    assert measures.speeds(world).shape == (0,)
    assert all(quantity.of(world, DT) == 0.0 for quantity in measures.QUANTITIES.values())


def test_joint_errors() -> None:
    world = empty_world()
    ground = world.create_body(kind="static")

    def box() -> object:
        return world.create_body(Box(1, 1), position=(1.0, 0.0))

    bodies = [box() for _ in range(7)]
    world.create_joint_revolute(ground, bodies[0], anchor=(0, 0))
    world.create_joint_weld(ground, bodies[1], anchor=(0, 0))
    world.create_joint_weld(ground, bodies[2], anchor=(0, 0), linear_hertz=2.0, angular_hertz=2.0)
    world.create_joint_prismatic(ground, bodies[3], anchor=(0, 0), axis=(1, 0))
    world.create_joint_distance(ground, bodies[4], anchor1=(0, 0), anchor2=(1.0, 0.0))
    world.create_joint_distance(ground, bodies[5], anchor1=(0, 0), anchor2=(1.0, 0.0), hertz=2.0)
    world.create_joint_wheel(ground, bodies[6], anchor=(1.0, 0.0), axis=(0, 1), hertz=2.0)
    assert measures.joint_gaps(world) == pytest.approx(np.zeros(7), abs=1e-15)
    for body in bodies:
        body.position = (1.3, 0.4)  # 0.5 m away, 0.3 of it along x
    rod = math.hypot(1.3, 0.4) - 1.0
    expected = [0.5, 0.5, 0.0, 0.4, rod, 0.0, 0.3]
    assert measures.joint_gaps(world) == pytest.approx(expected)
    assert measures.joint_error(world) == pytest.approx(0.5)
    assert measures.joint_turn_error(world) == 0.0
    bodies[2].angle = 2.0  # on a spring
    bodies[0].angle = 3.0  # on a pin
    bodies[1].angle = -0.25
    assert measures.joint_turn_error(world) == pytest.approx(0.25)
    bodies[3].angle = 0.5
    assert measures.joint_turn_error(world) == pytest.approx(0.5)


def test_energy_momentum_and_speed() -> None:
    world = empty_world()
    world.create_body(Box(10, 2), position=(0, -1), kind="static")
    world.create_body(Box(1, 1), position=(3.0, 4.0), mass=2.0, velocity=(1.0, -2.0), angular_velocity=6.0)
    inertia = 2.0 / 6.0
    assert measures.energy(world) == pytest.approx(0.5 * 2 * 5 + 0.5 * inertia * 36 + 2 * 10 * 4)
    assert measures.momentum(world) == pytest.approx([2.0, -4.0, 2.0 * (3 * -2 - 4 * 1) + inertia * 6])
    assert measures.speeds(world) == pytest.approx([0.0, math.sqrt(5.0 + 36.0 / 6.0)])
    world.create_body(Box(1, 1), position=(9.0, 4.0), velocity=(3.0, 4.0), fixed_rotation=True)
    assert measures.speeds(world)[-1] == pytest.approx(5.0)


# --- of its constraints -----------------------------------------------------------------------------------------------


def test_friction_beyond_its_cone() -> None:
    world = overlapping(0.001)
    table = world._state.arbiters.contacts
    table["given_normal"][0, 0], table["given_tangent"][0, 0] = 4.0, 1.5
    assert measures.cone_violation(world) == measures.NOWHERE  # 1.5 < 0.5 x 4
    table["given_tangent"][0, 0] = -3.25
    worst = measures.cone_violation(world)
    assert worst.value == pytest.approx(3.25 - 0.5 * 4.0)
    assert (worst.body1, worst.body2) == (0, 1)
    assert worst.place == pytest.approx((0.0, 0.0), abs=1e-3)


def test_what_presses_and_what_parts_are_complementary() -> None:
    world = overlapping(0.001)
    ball, table = world.bodies[1], world._state.arbiters.contacts
    table["given_normal"][0, 0] = 3.0
    ball.velocity = (5.0, 0.0)  # along the floor
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.0, abs=1e-8)
    ball.velocity = (0.0, 0.25)  # parts, though pressed with 3 N s, which is 1.5 m/s
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.25)
    ball.velocity = (0.0, 4.0)
    worst = measures.complementarity(world, 1e-9)
    assert (worst.value, worst.body1, worst.body2) == (pytest.approx(1.5), 0, 1)
    table["given_normal"][0, 0] = 0.0
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.0, abs=1e-12)  # parts, and is not pressed
    ball.velocity = (0.0, -0.75)  # goes deeper
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.75)


def test_only_how_two_bodies_move_against_each_other_counts() -> None:
    world = empty_world()
    world.gravity = (0.0, 0.0)
    lower, upper = (world.create_body(Circle(0.5), position=(0.0, y), mass=1.0) for y in (0.0, 0.999))
    world.step(1e-9)
    lower.velocity = upper.velocity = (0.0, 7.0)
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.0, abs=1e-6)
    lower.velocity = (0.0, 8.0)  # runs into the upper one
    assert measures.complementarity(world, 1e-9).value == pytest.approx(1.0, rel=1e-6)


def test_what_is_apart_may_come_nearer() -> None:
    world = overlapping(-0.01)
    ball = world.bodies[1]
    ball.velocity = (0.0, -0.5)
    assert measures.complementarity(world, 0.02).value == pytest.approx(0.0, abs=1e-12)  # 0.01 m in 0.02 s: just so
    assert measures.complementarity(world, 0.1).value == pytest.approx(0.4, rel=1e-6)


def test_effective_mass_counts_how_a_body_turns() -> None:
    world = empty_world()
    world.gravity = (0.0, 0.0)
    world.create_body(Circle(0.5), position=(0.5, -0.5), kind="static")
    world.create_body(Box(2.0, 0.5), position=(0.0, 0.249), mass=3.0)
    world.step(1e-9)
    assert len(world.contact_records()) == 1
    world._state.arbiters.contacts["given_normal"][0, 0] = 1.0
    box = world.bodies[1]
    box.velocity, box.angular_velocity = (0.0, 100.0), 0.0
    inertia = 3.0 * (2.0**2 + 0.5**2) / 12.0
    inverse = 1.0 / 3.0 + 0.5**2 / inertia
    assert measures.complementarity(world, 1e-9).value == pytest.approx(inverse, rel=1e-3)
    box.velocity, box.angular_velocity = (0.0, 0.0), -0.1  # the point, right of its centre, goes down
    assert measures.complementarity(world, 1e-9).value == pytest.approx(0.05, rel=1e-3)


def test_healthy_contacts_obey_all_of_it() -> None:
    world = overlapping(0.0, gravity=True)
    for _ in range(120):
        world.step(DT)
    assert world.contact_records()["normal_impulse"].sum() == pytest.approx(2.0 * 10.0 * DT, rel=1e-6)
    assert measures.complementarity(world, DT).value < 1e-9
    assert measures.cone_violation(world).value < 1e-12


# --- of a history -----------------------------------------------------------------------------------------------------


def test_energy_over_time() -> None:
    energies = np.array([10.0, 10.5, 8.0, 9.0])
    assert measures.energy_error(energies) == 2.0
    assert measures.energy_gain(energies) == 0.5
    assert measures.energy_gain(energies[2:3]) == 0.0


def test_momentum_over_time() -> None:
    assert measures.momentum_error(np.array([[1.0, 2.0, 9.0], [4.0, 6.0, -9.0], [1.0, 2.0, 0.0]])) == 5.0


def test_jitter_is_that_of_the_end() -> None:
    history = np.zeros((120, 3))
    history[30, 1], history[70, 2] = 5.0, 0.5
    assert measures.jitter(history, DT) == 0.5
    assert measures.jitter(history, DT, seconds=0.5) == 0.0
    assert measures.jitter(history, 1 / 120) == 5.0


def test_distance_from_a_reference_and_when_it_diverges() -> None:
    reference = np.zeros((50, 4, 2))
    history = reference.copy()
    history[10:, 2] = (0.3, 0.4)
    history[20:, 1] = (0.0, 2.0)
    away = measures.distances(history, reference)
    assert away[[0, 9, 10, 19, 20, 49]] == pytest.approx([0.0, 0.0, 0.5, 0.5, 2.0, 2.0])
    assert measures.time_until_divergence(away, 0.1, 0.1) == pytest.approx(1.1)  # the eleventh step
    assert measures.time_until_divergence(away, 0.1, 1.0) == pytest.approx(2.1)
    assert measures.time_until_divergence(away, 0.1, 2.0) == math.inf
    assert len(measures.distances(history, reference[:7])) == 7


def test_what_is_lost_is_infinitely_far() -> None:
    history = np.zeros((3, 1, 2))
    history[1, 0, 0] = math.nan
    away = measures.distances(history, np.zeros((3, 1, 2)))
    assert list(away) == [0.0, math.inf, 0.0]
    assert measures.time_until_divergence(away, DT, 1e9) == pytest.approx(2 * DT)


def test_every_quantity_has_a_number_and_a_unit() -> None:
    world = overlapping(0.01)
    for quantity in measures.QUANTITIES.values():
        assert quantity.unit
        assert math.isfinite(quantity.of(world, DT))
