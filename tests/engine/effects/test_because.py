"""world.effects: every effect the engine has, whether the world calls for it, and by what."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from engine import EFFECTS, SOLVERS, Box, Circle, World
from tests.engine.worlds import DT, floor, gathering, run


def three() -> World:
    """A floor and two boxes; nothing special."""
    world = World()
    floor(world)
    world.create_body(Box(1, 1), position=(0, 0.5))
    world.create_body(Box(1, 1), position=(3, 0.5))
    return world


def because(world: World) -> dict[str, str]:
    statuses = world.effects
    assert [status.name for status in statuses] == [effect.name for effect in EFFECTS], "always all, in one order"
    assert all(status.called_for == bool(status.because) for status in statuses)
    return {status.name: status.because for status in statuses if status.called_for}


PLAIN = {
    "gravity": "gravity is (0, -10) m/s²",
    "friction": "3 of 3 shapes have friction",
    "continuous collision": "2 bodies could go through 1 shape that nothing moves",
    "sleeping": "what lies still may sleep: 0 of 2 bodies do",
}
SLEEPING = {"sleeping": PLAIN["sleeping"]}


def join(world: World, **arguments: Any) -> None:
    a, b = world.bodies[1:]
    world.create_joint_revolute(a, b, anchor=(1.5, 0.5), **arguments)


def set_shape(name: str, value: float) -> Callable[[World], None]:
    return lambda world: setattr(world.bodies[1].shapes[0], name, value)


def set_body(name: str, value: Any) -> Callable[[World], None]:
    return lambda world: setattr(world.bodies[1], name, value)


CALLS: dict[str, tuple[Callable[[World], None], dict[str, str]]] = {
    "restitution": (set_shape("restitution", 0.5), {"restitution": "1 of 3 shapes has restitution"}),
    "rolling": (set_shape("rolling_resistance", 0.1), {"rolling resistance": "1 of 3 shapes has rolling resistance"}),
    "belt": (set_shape("tangent_speed", -1.0), {"conveyor": "1 of 3 shapes has a tangent speed"}),
    "category": (set_shape("category", 2), {"filters": "1 of 3 shapes has a category, mask or group"}),
    "mask": (set_shape("mask", 1), {"filters": "1 of 3 shapes has a category, mask or group"}),
    "group": (set_shape("group", -1), {"filters": "1 of 3 shapes has a category, mask or group"}),
    "linear": (set_body("linear_damping", 0.5), {"linear damping": "1 of 3 bodies has linear damping"}),
    "angular": (set_body("angular_damping", 0.5), {"angular damping": "1 of 3 bodies has angular damping"}),
    "scale": (set_body("gravity_scale", 0.5), {"gravity scale": "1 of 3 bodies has a gravity scale"}),
    "joint": (join, {"revolute joints": "1 revolute joint"}),
    "motor": (
        lambda world: join(world, motor_speed=0.0),
        {"revolute joints": "1 revolute joint", "joint motors": "1 joint with a motor"},
    ),
    "passing": (
        lambda world: join(world, collide_connected=False),
        {"revolute joints": "1 revolute joint", "joined without colliding": "1 joint of bodies that do not collide"},
    ),
    "bullet": (set_body("bullet", True), {"bullets": "1 of 3 bodies has the property bullet"}),
    "diagnostics": (lambda world: world.diagnostics(), {"diagnostics": "somebody asks for energy and momentum"}),
}


def test_a_plain_world_calls_for_little() -> None:
    assert because(three()) == PLAIN
    assert because(World(gravity=(0, 0))) == {}


@pytest.mark.parametrize("name", CALLS)
def test_what_calls_for_an_effect(name: str) -> None:
    call, expected = CALLS[name]
    world = three()
    call(world)
    assert because(world) == PLAIN | expected
    world.step(DT)
    assert because(world) == PLAIN | expected, "a step does not change it"


def test_counts_and_plurals() -> None:
    world = three()
    for body in world.bodies[1:]:
        body.shapes[0].restitution = 0.5
        body.linear_damping = 1
    join(world)
    join(world)
    assert because(world) == PLAIN | {
        "restitution": "2 of 3 shapes have restitution",
        "linear damping": "2 of 3 bodies have linear damping",
        "revolute joints": "2 revolute joints",
    }


def test_it_follows_the_content() -> None:
    world = three()
    ball = world.create_body(Circle(0.5), position=(8, 3), restitution=0.5, linear_damping=0.1)
    assert because(world)["restitution"] == "1 of 4 shapes has restitution"
    run(world, 3)
    assert "restitution" in world._state.effects
    ball.destroy()
    assert because(world) == PLAIN
    run(world, 1)
    assert world._state.effects == {"gravity", "friction", "continuous collision", "sleeping"}
    world.gravity = (0, 0)
    world.continuous = False
    world.bodies[0].friction = 0
    assert because(world) == {"friction": "2 of 3 shapes have friction"} | SLEEPING
    for body in world.bodies:
        body.friction = 0.0
    assert because(world) == SLEEPING
    world.sleeping = False
    assert because(world) == {}
    run(world, 1)
    assert world._state.effects == set()


def test_sleeping_is_called_for_by_its_setting() -> None:
    world = three()
    run(world, 60)
    assert because(world)["sleeping"] == "what lies still may sleep: 2 of 2 bodies do"
    world.bodies[2].awake = True
    assert because(world)["sleeping"] == "what lies still may sleep: 1 of 2 bodies do"
    world.sleeping = False
    assert "sleeping" not in because(world)
    world.set(sleeping=True, solver="sequential_impulses")
    assert "sleeping" not in because(world), "this one knows no sleep"


def test_diagnostics_are_called_for_only_while_somebody_asks() -> None:
    world = three()
    for _ in range(3):
        world.step(DT)
        world.diagnostics()
        assert "diagnostics" in because(world)
    run(world, 2)
    assert "diagnostics" not in because(world)


def test_asking_changes_nothing() -> None:
    worlds = [gathering(), gathering()]
    for _ in range(40):
        worlds[0].step(DT)
        worlds[1].step(DT)
        assert worlds[1].effects
        worlds[1].diagnostics()
    assert worlds[0].state_hash() == worlds[1].state_hash()


@pytest.mark.parametrize("solver", SOLVERS)
def test_columns_stay_away_until_they_are_called_for(solver: str) -> None:
    # setting the default brings no column, and a column that is no longer needed goes
    world = World(solver=solver)
    body = world.create_body(Box(1, 1), linear_damping=0.0, gravity_scale=1.0, restitution=0.0, category=1)
    assert not world._state.bodies.columns
    assert not world._state.shapes.columns
    body.gravity_scale = 2.0
    assert list(world._state.bodies.columns) == ["gravity_scale"]
    world.step(DT)
    assert world._state.gravity_scales is not None
    body.gravity_scale = 1.0
    world.step(DT)
    assert world._state.gravity_scales is None
    assert not world._state.bodies.columns
