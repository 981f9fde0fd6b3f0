"""The filter joint: its two bodies pass through each other, and nothing else is changed."""

from __future__ import annotations

import pytest

from engine import SOLVERS, Box, Circle, World
from tests.engine.worlds import DT, PRECISIONS, floor, run

either = pytest.mark.parametrize("solver", SOLVERS)


def meeting(**settings):
    world = World(gravity=(0, 0), **settings)
    a = world.create_body(Box(1, 1), velocity=(1, 0))
    b = world.create_body(Circle(0.5), position=(2, 0), velocity=(-1, 0))
    return world, a, b


@either
@pytest.mark.parametrize("precision", PRECISIONS)
def test_two_bodies_pass_through_each_other(precision: str, solver: str) -> None:
    world, a, b = meeting(precision=precision, solver=solver)
    joint = world.create_joint_filter(a, b)
    run(world, 120)
    rounding = 1e-5 if precision == "single" else 1e-12
    assert tuple(a.position) == pytest.approx((2, 0), abs=rounding)
    assert tuple(b.position) == pytest.approx((0, 0), abs=rounding)
    assert (tuple(joint.force), joint.torque, joint.collide_connected) == ((0, 0), 0.0, False)


@either
def test_others_collide_as_before(solver: str) -> None:
    world = World(solver=solver)
    ground = floor(world)
    a = world.create_body(Box(1, 1), position=(0, 0.5))
    b = world.create_body(Box(1, 1), position=(0.5, 0.5))
    world.create_joint_filter(a, b)
    run(world, 60)
    met = {(arbiter.body1, arbiter.body2) for arbiter in world.arbiters}
    assert met == {(ground, a), (ground, b)}
    assert a.position.x == pytest.approx(0.0, abs=1e-3)
    assert b.position.x == pytest.approx(0.5, abs=1e-3)


@either
def test_destroyed_it_lets_them_collide_again(solver: str) -> None:
    world, a, b = meeting(solver=solver)
    joint = world.create_joint_filter(a, b)
    run(world, 10)
    joint.destroy()
    run(world, 120)
    assert a.position.x < b.position.x, "they met"
    assert a.velocity.x < 0.5


@either
def test_made_while_they_touch_it_parts_them(solver: str) -> None:
    world, a, b = meeting(solver=solver)
    run(world, 40)
    assert len(world.arbiters) == 1
    world.create_joint_filter(a, b)
    world.step(DT)
    assert world.arbiters == []
