"""Restitution: how high and how fast shapes bounce."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Body, Box, Capsule, Circle, Polygon, Shape, World
from tests.engine.worlds import DT, PRECISIONS, floor, regular, run

G = 10.0
RISES = {  # shapes that fall flat, and how high their middle then lies
    "circle": Circle(0.5),
    "box": Box(1, 1),
    "wide box": Box(3, 1),
    "capsule": Capsule(0.5, 0.5),
    "polygon": Polygon(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))),
    "rounded polygon": Polygon(((-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)), radius=0.2),
}


def bounce(body: Body, world: World) -> float:
    """Height of the first bounce above the first fall's lowest point [m]."""
    while body.velocity.y <= 0:
        world.step(DT)
    start = body.position.y
    while body.velocity.y > 0:
        world.step(DT)
    return body.position.y - min(start, 0.5)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("name", RISES)
@pytest.mark.parametrize("e", [0.3, 0.5, 0.8, 1.0])
def test_it_rises_to_e_squared_of_the_height(e: float, name: str, precision: str) -> None:
    world = World(precision=precision)
    floor(world)
    body = world.create_body(RISES[name], position=(0, 0.5 + 5), restitution=e)
    # the step in which it lands is 1/60 s long, and it has up to 10 m/s: a part of that in speed, twice that in height
    assert bounce(body, world) == pytest.approx(e * e * 5, rel=0.02, abs=0.02)
    assert body.angle == pytest.approx(0.0, abs=0.03), "nor does it tumble"
    assert body.angular_velocity == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("e", [0.0, 0.4, 1.0])
def test_two_bodies_part_with_e_times_the_speed_at_which_they_met(e: float) -> None:
    world = World(gravity=(0, 0), precision="double")
    a = world.create_body(Circle(0.5), position=(-0.6, 0), velocity=(3, 0), mass=2, restitution=e)
    b = world.create_body(Circle(0.5), position=(0.6, 0), velocity=(-1, 0), mass=5)
    before = world.diagnostics()
    run(world, 20)
    after = world.diagnostics()
    assert b.velocity.x - a.velocity.x == pytest.approx(e * 4, abs=1e-9)
    assert after.momentum.x == pytest.approx(before.momentum.x, abs=1e-12)
    # the energy lost is that of the relative motion, less e^2 of it
    assert before.energy - after.energy == pytest.approx(0.5 * (2 * 5 / 7) * 16 * (1 - e * e), rel=1e-9, abs=1e-9)


def test_elastic_bodies_keep_their_energy() -> None:
    world = World(gravity=(0, 0), precision="double")
    rng = np.random.default_rng(3)
    for x, y in ((5, 0), (-5, 0), (0, 5), (0, -5)):
        size = (1, 11) if x else (11, 1)
        world.create_body(Box(*size), position=(x, y), kind="static", restitution=1, friction=0)
    for k in range(6):
        place = (-3 + 1.2 * k, rng.uniform(-3, 3))
        velocity = tuple(rng.uniform(-4, 4, 2))
        world.create_body(Circle(0.4), position=place, velocity=velocity, restitution=1, friction=0)
    world.restitution_threshold = 0.0
    before = world.diagnostics().kinetic_energy
    run(world, 300)
    assert world.diagnostics().kinetic_energy == pytest.approx(before, rel=0.03)


@pytest.mark.parametrize("shape", [Circle(0.5), Box(1, 1), Capsule(0.6, 0.3), Polygon(regular(5))])
@pytest.mark.parametrize("e", [0.5, 1.0])
def test_no_bounce_adds_energy(shape: Shape, e: float) -> None:
    # however it lands: on a corner, an edge, turning
    world = World(precision="double")
    floor(world, restitution=0.2)
    for k in range(7):
        body = world.create_body(
            shape, position=(3.0 * k, 3), angle=0.4 * k, velocity=(k, -k), angular_velocity=k - 3, restitution=e
        )
        assert body.shapes[0].restitution == e
    energies = [world.diagnostics().energy]
    for _ in range(240):
        world.step(DT)
        energies.append(world.diagnostics().energy)
    assert max(energies) <= energies[0] * 1.02
    assert energies[-1] < energies[0]


def test_below_the_threshold_nothing_bounces() -> None:
    for threshold, bounces in ((1.0, True), (3.0, False)):
        world = World(precision="double", gravity=(0, 0), restitution_threshold=threshold)
        floor(world)
        ball = world.create_body(Circle(0.5), position=(0, 0.6), velocity=(0, -2), restitution=0.5)
        run(world, 30)
        assert (ball.velocity.y > 0.9) == bounces
        assert bounces or ball.velocity.y == pytest.approx(0.0, abs=1e-9)


def test_a_ball_comes_to_rest() -> None:
    world = World()
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 3), restitution=0.7)
    run(world, 600)
    assert abs(ball.velocity.y) < 1e-3
    assert ball.position.y == pytest.approx(0.5, abs=1e-3)


RULES = {
    "geometric": lambda a, b: math.sqrt(a * b), "mean": lambda a, b: (a + b) / 2, "least": min, "greatest": max,
    "product": lambda a, b: a * b,
}  # fmt: skip


@pytest.mark.parametrize("rule", RULES)
def test_the_rule_of_mixing(rule: str) -> None:
    for a, b in ((0.0, 0.8), (0.9, 0.4)):
        world = World(precision="double", gravity=(0, 0), restitution_mixing=rule)
        floor(world, restitution=a)
        ball = world.create_body(Circle(0.5), position=(0, 0.6), velocity=(0, -4), restitution=b)
        run(world, 10)
        assert ball.velocity.y == pytest.approx(4 * RULES[rule](a, b), abs=1e-9)


def test_each_shape_has_its_own() -> None:
    world = World(precision="double", gravity=(0, 0))
    ground = world.create_body(kind="static")
    for x, e in ((-5, 0.25), (5, 0.75)):
        ground.add_shape(Box(6, 1), offset=(x, -0.5), restitution=e)
    balls = [world.create_body(Circle(0.5), position=(x, 0.6), velocity=(0, -4)) for x in (-5, 5)]
    run(world, 10)
    assert [ball.velocity.y for ball in balls] == pytest.approx([1.0, 3.0], abs=1e-9)
