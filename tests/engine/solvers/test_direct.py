"""direct: exact answers, and the rules that make its own answer one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Circle, World
from engine.solvers.direct import pivoting
from tests.engine.worlds import DT, floor, run

G = 10.0


def new(**settings) -> World:
    return World(**{"solver": "direct", "precision": "double", **settings})


def stack(masses: list[float]) -> World:
    world = new()
    floor(world, 0.6)
    for k, mass in enumerate(masses):
        world.create_body(Box(1, 1), position=(0, 0.5 + k), mass=mass, friction=0.6)
    return world


@pytest.mark.parametrize("masses", [[1.0] * 10, [1.0] * 9 + [1000.0], [1000.0] + [1.0] * 4], ids=str)
def test_a_stack_carries_the_weight_above_from_the_first_step(masses: list[float]) -> None:
    world = stack(masses)
    for _ in range(3):
        world.step(DT)
        records = world.contact_records()
        for below in range(len(masses)):
            between = records[records["body2"] == below + 1]
            assert between["normal_impulse"].sum() == pytest.approx(sum(masses[below:]) * G * DT, rel=1e-11)
            assert between["normal_impulse"] == pytest.approx(
                between["normal_impulse"].mean(), rel=1e-9
            )  # in the middle
            assert between["tangent_impulse"].sum() == pytest.approx(0.0, abs=1e-10 * sum(masses))
    assert np.abs(world.velocities).max() < 1e-11
    assert np.abs(world.positions[1:, 1] - 0.5 - np.arange(len(masses))).max() < 1e-12


def test_loads_that_may_be_shared_in_many_ways_are_shared_evenly() -> None:
    # a beam on five posts: of all answers the one of least norm, which is symmetric and carries the weight
    world = new()
    for k in range(5):
        world.create_body(Circle(0.2), position=(k - 2, 0.2), kind="static", friction=0)
    beam = world.create_body(Box(4.5, 0.2), position=(0, 0.5), friction=0)
    world.step(DT)
    loads = world.contact_records()["normal_impulse"]
    assert len(loads) == 5
    assert loads.sum() == pytest.approx(beam.mass * G * DT, rel=1e-12)
    np.testing.assert_allclose(loads, loads[::-1], rtol=1e-6)
    # scaled by sqrt(mass_k), 1/mass_k = 1/m + x_k^2/I: minimise sum P^2/mass_k with the weight and no moment given
    offsets = np.arange(5) - 2.0
    inverse = 1 / beam.mass + offsets**2 / beam.inertia
    equations = np.stack([np.ones(5), offsets])
    weighted = equations / inverse
    expected = weighted.T @ np.linalg.solve(equations @ weighted.T, [beam.mass * G * DT, 0.0])
    np.testing.assert_allclose(np.sort(loads), np.sort(expected), rtol=1e-6)


@pytest.mark.parametrize("friction", [0.1, 0.5, 1.2])
def test_a_block_slides_as_friction_says_and_holds_below_its_angle(friction: float) -> None:
    for angle in (math.atan(friction) - 1e-6, math.atan(friction) + 1e-3):
        world = new(gravity=(G * math.sin(angle), -G * math.cos(angle)))
        floor(world, friction)
        block = world.create_body(Box(4, 0.2), position=(0, 0.1), friction=friction)
        run(world, 10)
        expected = max(G * (math.sin(angle) - friction * math.cos(angle)), 0.0) * 10 * DT
        assert block.velocity.x == pytest.approx(expected, rel=1e-9, abs=1e-12)
        assert block.position.y == pytest.approx(0.1, abs=1e-12)


@pytest.mark.parametrize("masses", [(1.0, 2.0), (1.0, 1000.0)])
def test_a_wheel_with_two_weights_accelerates_as_atwoods(masses: tuple[float, float]) -> None:
    # both hang from the rim of a wheel, on rods so long that they stay upright: a = (m2 - m1) g / (m1 + m2 + I / r^2)
    world = new()
    top = world.create_body(kind="static")
    wheel = world.create_body(Circle(0.5), position=(0, 0), mass=3)
    world.create_joint_revolute(top, wheel, anchor=(0, 0))
    weights = [
        world.create_body(Circle(0.1), position=(x, -5), mass=m) for x, m in zip((-0.5, 0.5), masses, strict=True)
    ]
    for weight in weights:
        x, y = weight.position
        world.create_joint_distance(wheel, weight, anchor1=(x, 0), anchor2=(x, y), collide_connected=False)
    world.step(DT)
    inertia = wheel.inertia / 0.25
    a = (masses[1] - masses[0]) * G / (masses[0] + masses[1] + inertia)
    assert weights[1].velocity.y == pytest.approx(-a * DT, rel=1e-12)
    assert weights[0].velocity.y == pytest.approx(a * DT, rel=1e-12)
    assert world.joints[1].force.y == pytest.approx(masses[0] * (G + a), rel=1e-11)


def test_a_chain_with_a_ball_a_thousand_times_as_heavy_does_not_stretch() -> None:
    world = new()
    before = world.create_body(kind="static", position=(0, 0))
    for k in range(10):
        link = world.create_body(Box(0.4, 0.1), position=(0.2 + 0.4 * k, 0), mass=1)
        world.create_joint_revolute(before, link, anchor=(0.4 * k, 0), collide_connected=False)
        before = link
    ball = world.create_body(Circle(0.5), position=(4.5, 0), mass=1000)
    world.create_joint_revolute(before, ball, anchor=(4, 0), collide_connected=False)
    for _ in range(120):  # of a step in which a taut link swings across by less than it is long: docs/solvers.md
        world.step(1 / 480)
        for joint in world.joints:
            a, b = joint.anchors
            assert math.hypot(b.x - a.x, b.y - a.y) < 1e-11


def test_a_rod_does_not_drift_while_a_pendulum_swings() -> None:
    world = new()
    top = world.create_body(kind="static")
    bob = world.create_body(Circle(0.1), position=(2, 0))
    world.create_joint_distance(top, bob, anchor1=(0, 0), anchor2=(2, 0))
    for _ in range(300):
        world.step(DT)
        assert math.hypot(*bob.position) == pytest.approx(2.0, abs=1e-12)


def heap(seed: int) -> World:
    """Boxes and discs that fall on each other, two of them on a rod."""
    rng = np.random.default_rng(seed)
    world = new()
    floor(world, 0.5)
    bodies = [
        world.create_body(
            Box(*rng.uniform(0.5, 1.0, 2)) if k % 2 else Circle(rng.uniform(0.3, 0.5)),
            position=(rng.uniform(-0.6, 0.6), 0.7 + 1.2 * k),
            angle=rng.uniform(0, 6),
            friction=0.5,
            density=rng.choice([1.0, 3.0]),
        )
        for k in range(5)
    ]
    world.create_joint_revolute(bodies[0], bodies[2], anchor=tuple(bodies[2].position), collide_connected=False)
    return world


@pytest.mark.parametrize("seed", range(2))
def test_its_answer_keeps_the_rules(seed: int) -> None:
    # nothing pulls, nothing comes nearer than it may, and not both; friction within its bounds, full where it slides
    world, touched, slid, exact = heap(seed), 0, 0, 0
    for _ in range(100):
        world.step(DT)
        speeds = {b.serial: (*b.velocity, b.angular_velocity) for b in world.bodies}
        error = world._state.scratch["direct, error"]
        exact += error < 1e-12
        table = world._state.arbiters
        serials = world._state.bodies.tables["bodies"]["serial"]
        largest = max(1.0, float(np.abs(world.contact_records()["normal_impulse"]).max(initial=0.0)))
        for k in range(table.count):
            pair = table.rows[k]
            n = np.array([pair["nx"], pair["ny"]])
            t = np.array([n[1], -n[0]])
            one, two = speeds[serials[pair["body1"]]], speeds[serials[pair["body2"]]]
            for point in table.contacts[k, : pair["count"]]:
                moving = np.array(
                    [
                        two[0] - two[2] * point["r2_y"] - one[0] + one[2] * point["r1_y"],
                        two[1] + two[2] * point["r2_x"] - one[1] - one[2] * point["r1_x"],
                    ]
                )
                gap = float(moving @ n) + max(float(point["separation"]), 0.0) / DT
                press, hold = float(point["normal_impulse"]), float(point["tangent_impulse"])
                small = 100 * max(error, 1e-12) * largest + 1e-7  # gaps that count as none: direct/rows.py, TOUCHING
                assert press >= -small
                assert gap >= -small
                assert min(press, gap) <= small
                assert abs(hold) <= pair["friction"] * press + small
                slides = float(moving @ t)
                if abs(slides) > 1e-3 and press > 1e-3:
                    assert hold == pytest.approx(-math.copysign(pair["friction"] * press, slides), abs=small)
                    slid += 1
                touched += press > 0
    assert touched > 200
    assert slid > 10
    assert exact > 95


def random_problem(rng: np.random.Generator, n: int) -> tuple:
    """A mixed problem with a positive definite matrix, of contacts with friction and of rows with bounds."""
    jacobian = rng.normal(size=(n, n))
    matrix = jacobian @ jacobian.T + 0.1 * np.eye(n)
    scale = 1 / np.sqrt(matrix.diagonal())
    matrix = matrix * scale * scale[:, None]
    np.fill_diagonal(matrix, 1.0)
    low, high = np.full(n, -np.inf), np.full(n, np.inf)
    normal, ratio = np.full(n, -1), np.zeros(n)
    low[: n // 2 : 2] = 0.0
    for k in range(1, n // 2, 2):
        normal[k], ratio[k] = k - 1, 0.3
    low[n // 2 :: 3], high[n // 2 :: 3] = -0.2, 0.3
    return matrix, rng.normal(size=n), low, high, ratio, normal


@pytest.mark.kernel
def test_pivoting_finds_what_sweeping_finds() -> None:
    rng = np.random.default_rng(1)
    for n in (2, 4, 8, 12):
        for _ in range(4):
            matrix, b, low, high, ratio, normal = random_problem(rng, n)
            x = np.zeros(n)
            error = pivoting.solve(matrix, b, low, high, ratio, normal, x)
            assert error < 1e-12
            slow = np.zeros(n)  # projected Gauss-Seidel, by hand
            for _ in range(3000):
                for i in range(n):
                    upper = ratio[i] * slow[normal[i]] if normal[i] >= 0 else high[i]
                    lower = -upper if normal[i] >= 0 else low[i]
                    slow[i] = min(max(slow[i] - (matrix[i] @ slow + b[i]), lower), upper)
            np.testing.assert_allclose(x, slow, atol=1e-7)


@pytest.mark.kernel
def test_a_regular_system_is_solved_and_a_singular_one_gives_its_least_answer() -> None:
    rng = np.random.default_rng(2)
    square = rng.normal(size=(6, 6))
    x = rng.normal(size=6)
    found = square @ x
    pivoting.eliminate(square.copy(), found, 6)
    np.testing.assert_allclose(found, x, atol=1e-10)
    none = np.full(3, -1)
    found = np.empty(3)
    far = np.full(3, np.inf)
    assert pivoting.solve(np.ones((3, 3)), np.full(3, -3.0), -far, far, np.zeros(3), none, found) < 1e-12
    np.testing.assert_allclose(found, 1.0, rtol=1e-6)  # x1 + x2 + x3 = 3


def test_single_precision_rounds_and_does_no_more() -> None:
    world = new(precision="single")
    floor(world, 0.6)
    for k in range(5):
        world.create_body(Box(1, 1), position=(0, 0.5 + k), friction=0.6)
    run(world, 30)
    assert np.abs(world.positions[1:, 1] - 0.5 - np.arange(5)).max() < 1e-5
    total = world.contact_records()["normal_impulse"][:2].sum()
    assert total == pytest.approx(5 * G * DT, rel=1e-5)


def test_a_belt_carries_what_lies_on_it() -> None:
    world = new()
    floor(world, 0.5, tangent_speed=2.0)
    box = world.create_body(Box(2, 0.2), position=(0, 0.1), friction=0.5)
    run(world, 60)
    assert box.velocity.x == pytest.approx(2.0, abs=1e-10)
