"""A world mirrored in pymunk has the same bodies, and rubs, hangs and lands as ours does."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

from engine import Box, Circle, World
from sandbox.lab.peers import PeerError, Pymunk
from sandbox.lab.peers.pymunk_peer import PymunkWorld
from sandbox.scenes import SCENES, find_scene

DT = 1 / 60


def mirror(scene: str) -> tuple[World, PymunkWorld]:
    world = find_scene(scene).make(solver="sequential_impulses")
    return world, Pymunk().mirror(world, DT)


@pytest.mark.parametrize("scene", [name for name in SCENES if name.startswith("The Talk/")])
def test_bodies_are_the_same(scene: str) -> None:
    world, copy = mirror(scene)
    assert len(copy.space.bodies) == len(copy.space.shapes) == world.body_count
    assert len(copy.space.constraints) == world.joint_count
    np.testing.assert_array_equal(copy.positions(), world.positions)
    assert [body.angle for body in copy.bodies] == world.angles.tolist()
    for theirs, ours in zip(copy.bodies, world.bodies, strict=True):
        if ours.kind == "dynamic":
            assert (theirs.mass, theirs.moment) == (ours.mass, ours.inertia)
            assert tuple(theirs.velocity) == tuple(ours.velocity)
        else:
            assert theirs.body_type == theirs.STATIC


def test_space_has_the_worlds_settings() -> None:
    world = World(solver="sequential_impulses", gravity=(1.0, -3.0), iterations=7)
    space = Pymunk().mirror(world, DT).space
    assert (tuple(space.gravity), space.iterations) == ((1.0, -3.0), 7)
    assert math.isinf(space.sleep_time_threshold)


def test_shapes_have_the_same_size_and_friction() -> None:
    world = World(solver="sequential_impulses")
    bodies = [world.create_body(Box(2, 1), friction=0.3), world.create_body(Circle(0.7), friction=0.6)]
    box, circle = (next(iter(body.shapes)) for body in Pymunk().mirror(world, DT).bodies)
    assert (box.area, circle.area) == (pytest.approx(2.0), pytest.approx(math.pi * 0.49))
    assert box.friction * circle.friction == pytest.approx(math.sqrt(bodies[0].friction * bodies[1].friction))


def test_a_box_lands_at_the_same_height() -> None:
    world, copy = mirror("Single Box")
    copy.step(200)
    for _ in range(200):
        world.step(DT)
    assert copy.positions()[1] == pytest.approx(world.positions[1], abs=1e-3)


def test_a_pendulum_keeps_to_its_anchor() -> None:
    copy = mirror("Simple Pendulum")[1]
    copy.step(100)
    assert math.dist(copy.positions()[1], (0, 11)) == pytest.approx(9.0, abs=0.1)


def test_joined_bodies_collide_only_if_ours_do() -> None:
    world = World(solver="sequential_impulses")
    bodies = [world.create_body(Box(1, 1), position=(x, 0)) for x in (0.0, 0.5, 1.0)]
    world.create_joint_revolute(bodies[0], bodies[1], anchor=(0, 0))
    world.create_joint_revolute(bodies[1], bodies[2], anchor=(1, 0), collide_connected=False)
    assert [joint.collide_bodies for joint in Pymunk().mirror(world, DT).space.constraints] == [True, False]


def test_every_step_is_timed() -> None:
    times = mirror("Pyramid")[1].step(5)
    assert times.cpu.shape == times.wall.shape == (5,)
    assert times.wall.min() > 0.0


def test_without_pymunk_there_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pymunk", None)
    with pytest.raises(PeerError, match=r"^pymunk is not installed: pip install 'tumble\[peers\]'$"):
        Pymunk()


def test_pymunk_is_loaded_only_when_asked_for() -> None:
    code = "import sys, sandbox.verbs.bench; sys.exit('pymunk' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
