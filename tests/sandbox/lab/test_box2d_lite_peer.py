"""Box2D Lite is compiled from a checkout, is told the scene, and answers; what goes wrong is one clear line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine import Box, World
from sandbox.lab.peers import Box2DLite, CannotMirror, PeerError
from sandbox.lab.peers.box2d_lite import DRIVER, scene_text
from sandbox.scenes import find_scene
from tests.sandbox.lab import fake_box2d_lite as fake

DT = 1 / 60


def numbers(line: str) -> list[float]:
    return [float(word) for word in line.split() if word[0] in "-0123456789"]


def test_scene_text_has_every_body_and_joint() -> None:
    world = find_scene("The Talk/Dominos").make(solver="sequential_impulses")
    text = scene_text(world, DT).splitlines()
    assert numbers(text[0]) == [DT, 0.0, -10.0, 10.0, 1.0, 1.0, 1.0]
    assert text[1] == f"bodies {world.body_count}"
    bodies, joints = text[2 : 2 + world.body_count], text[3 + world.body_count :]
    np.testing.assert_array_equal([numbers(line)[3:5] for line in bodies], world.positions)
    masses = [body.mass if body.kind == "dynamic" else 0.0 for body in world.bodies]
    assert [numbers(line)[2] for line in bodies] == masses
    assert [numbers(line)[9] for line in bodies] == [body.friction for body in world.bodies]
    assert len(joints) == world.joint_count
    assert numbers(joints[0])[:2] == [0, world.joints[0].body2.serial]


def test_bodies_are_numbered_as_they_stand() -> None:
    world = World(solver="sequential_impulses")
    gone, *kept = (world.create_body(Box(1, 1), position=(3 * i, 0)) for i in range(3))
    gone.destroy()
    world.create_joint_revolute(*kept, anchor=(4.5, 0))
    assert numbers(scene_text(world, DT).splitlines()[-1])[:2] == [0, 1]


def test_switches_are_told() -> None:
    world = World(solver="sequential_impulses", warm_starting=False)
    assert scene_text(world, DT).splitlines()[0].endswith(" 10 1 0 1")


def test_what_it_has_not_is_refused() -> None:
    with pytest.raises(CannotMirror, match="it has boxes only, body 5 is a circle"):
        scene_text(find_scene("Circles").make(), DT)
    world = World(solver="sequential_impulses")
    bodies = [world.create_body(Box(1, 1)) for _ in range(2)]
    world.create_joint_revolute(*bodies, anchor=(0, 0), collide_connected=False)
    with pytest.raises(CannotMirror, match="those of joint 0 do not"):
        scene_text(world, DT)


@pytest.mark.parametrize(
    ("properties", "reason"),
    [
        ({"offset": (0.5, 0.0)}, "its bodies have one box about their origin, body 0 has not"),
        ({"kind": "kinematic"}, "it has no kinematic bodies and no fixed rotation, as body 0 has"),
        ({"fixed_rotation": True}, "it has no kinematic bodies and no fixed rotation, as body 0 has"),
        ({"restitution": 0.5}, "it has no restitution: 1 of 1 shapes has restitution"),
    ],
)
def test_bodies_that_it_has_not_are_refused(properties: dict, reason: str) -> None:
    world = World()
    world.create_body(Box(1, 1), **properties)
    with pytest.raises(CannotMirror, match=f"^{reason}$"):
        scene_text(world, DT)


def test_the_driver_is_compiled_asked_and_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    checkout = fake.make_checkout(tmp_path / "checkout")
    fake.install_driver(monkeypatch, tmp_path / "bin")
    world = find_scene("The Talk/Pyramid").make()
    peer = Box2DLite(checkout)
    copy = peer.mirror(world, DT)
    np.testing.assert_array_equal(copy.positions(), world.positions)
    times = copy.step(3)
    assert times.cpu.tolist() == [fake.STEP_CPU] * 3
    assert times.wall.tolist() == [fake.STEP_WALL] * 3
    copy.close()
    peer.close()
    arguments = (tmp_path / "bin" / "arguments").read_text().split()
    assert "-O3" in arguments
    assert {str(DRIVER), str(checkout / "src" / "World.cpp")} <= set(arguments)
    assert not Path(arguments[arguments.index("-o") + 1]).exists()


def test_the_driver_is_shipped() -> None:
    assert DRIVER.is_file()


@pytest.mark.parametrize("name", ["empty", "absent"])
def test_no_checkout(tmp_path: Path, name: str) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(
        PeerError, match=rf"{name}: is no checkout of Box2D Lite: it has no include/box2d-lite/World\.h"
    ):
        Box2DLite(tmp_path / name)


def test_no_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(PeerError, match=r"^Box2D Lite cannot be compiled: there is no g\+\+$"):
        Box2DLite(fake.make_checkout(tmp_path / "checkout"))


@pytest.mark.parametrize(
    ("script", "complaint"),
    [
        (
            "echo 'In file a.h:' >&2; echo 'a.h:3:1: error: no Body' >&2; echo more >&2; exit 1",
            "a.h:3:1: error: no Body",
        ),
        ("echo 'out of memory' >&2; exit 1", "out of memory"),
        ("exit 4", "exit code 4"),
    ],
)
def test_a_compile_error_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, complaint: str
) -> None:
    fake.install_compiler(monkeypatch, tmp_path / "bin", script)
    with pytest.raises(PeerError) as raised:
        Box2DLite(fake.make_checkout(tmp_path / "checkout"))
    assert str(raised.value) == f"Box2D Lite cannot be compiled: {complaint}"


def test_a_compiler_that_hangs_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sandbox.lab.peers.box2d_lite.COMPILE_SECONDS", 0.1)
    fake.install_compiler(monkeypatch, tmp_path / "bin", "exec sleep 30")
    with pytest.raises(PeerError, match=r"g\+\+ took longer than 0\.1 s"):
        Box2DLite(fake.make_checkout(tmp_path / "checkout"))


def test_a_driver_that_dies_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake.install_driver(monkeypatch, tmp_path / "bin", fake.BROKEN_DRIVER)
    peer = Box2DLite(fake.make_checkout(tmp_path / "checkout"))
    with pytest.raises(PeerError, match="Box2D Lite stopped while it ran, with exit code 7"):
        peer.mirror(find_scene("Single Box").make(), DT).step(1)
    peer.close()
