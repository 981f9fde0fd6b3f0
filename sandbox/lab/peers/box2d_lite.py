"""Box2D Lite, the talk's own engine: compiled from a checkout of github.com/erincatto/box2d-lite that the user has."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from engine import Box, RevoluteJoint, World
from sandbox.lab.peers.protocol import CannotMirror, PeerError, bias_factor, passes, refuse_effects
from sandbox.lab.timing import Times

KNOWN = frozenset({"gravity", "friction", "continuous collision", "revolute joints", "joined without colliding"})
DRIVER = Path(__file__).with_name("box2d_lite_driver.cpp")
PARTS = ("include/box2d-lite/World.h", "src/World.cpp")  # a checkout has these
FLAGS = ("-O3", "-DNDEBUG")  # CMake's Release, which is what its own build makes
COMPILE_SECONDS = 120.0  # then something is wrong
END_SECONDS = 1.0  # a driver that was told to end has this long


class Box2DLite:
    """The engine, compiled into a temporary folder that `close` removes."""

    name = "Box2D Lite"

    def __init__(self, checkout: Path) -> None:
        for part in PARTS:
            if not (checkout / part).is_file():
                raise PeerError(f"{checkout}: is no checkout of Box2D Lite: it has no {part}")
        self._folder = tempfile.TemporaryDirectory(prefix="tumble-box2d-lite-")
        self._binary = Path(self._folder.name) / "driver"
        try:
            _compile(checkout, self._binary)
        except PeerError:
            self.close()
            raise

    def mirror(self, world: World, dt: float) -> Box2DLiteWorld:
        return Box2DLiteWorld(self._binary, scene_text(world, dt), world.body_count)

    def close(self) -> None:
        self._folder.cleanup()


class Box2DLiteWorld:
    """A copy of our world in a process of its own, see box2d_lite_driver.cpp for how one talks with it."""

    def __init__(self, binary: Path, scene: str, body_count: int) -> None:
        self._body_count = body_count
        self._process = subprocess.Popen([binary], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self._ask(scene, 0)

    def step(self, count: int) -> Times:
        answers = self._ask(f"step {count}\n", count)
        return Times(answers[:, 0], answers[:, 1])

    def positions(self) -> np.ndarray:
        return self._ask("positions\n", self._body_count)

    def close(self) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(BrokenPipeError):  # it is gone, and has not read all of our last question
            self._process.stdin.close()
        try:
            self._process.wait(END_SECONDS)  # it ends with its input
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def _ask(self, question: str, lines: int) -> np.ndarray:
        """Sends a question; the answer, two numbers in each of so many lines."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(question)
            self._process.stdin.flush()
            answer = [self._process.stdout.readline().split() for _ in range(lines)]
            return np.array(answer, np.float64).reshape(lines, 2)
        except (BrokenPipeError, ValueError):
            self.close()
            raise PeerError(f"Box2D Lite stopped while it ran, with exit code {self._process.returncode}") from None


def scene_text(world: World, dt: float) -> str:
    """The world as the driver reads it. CannotMirror if there is something in it that Box2D Lite has not."""
    refuse_effects(world, KNOWN)
    settings = world.settings
    switches = (settings.accumulate_impulses, settings.warm_starting, settings.position_correction)
    lines = [_line("world", dt, *settings.gravity, passes(world), *map(int, switches))]
    lines.append(_line("bodies", world.body_count))
    for body in world.bodies:
        if len(body.shapes) != 1 or body.center != body.position:
            raise CannotMirror(f"its bodies have one box about their origin, body {body.serial} has not")
        if body.kind == "kinematic" or body.fixed_rotation:
            raise CannotMirror(f"it has no kinematic bodies and no fixed rotation, as body {body.serial} has")
        if not isinstance(body.shape, Box):
            raise CannotMirror(f"it has boxes only, body {body.serial} is a {body.shape.name}")
        mass = 0.0 if body.kind == "static" else body.mass
        motion = (*body.velocity, body.angular_velocity)
        size = (body.shape.width, body.shape.height)
        lines.append(_line(*size, mass, *body.position, body.angle, *motion, body.friction))
    lines.append(_line("joints", world.joint_count))
    ranks = {body.serial: rank for rank, body in enumerate(world.bodies)}
    for joint in world.joints:
        if not isinstance(joint, RevoluteJoint):
            raise CannotMirror(f"it has revolute joints only, joint {joint.serial} is a {joint.kind} joint")
        if not joint.collide_connected:
            raise CannotMirror(f"its joined bodies always collide, those of joint {joint.serial} do not")
        pair = (ranks[joint.body1.serial], ranks[joint.body2.serial])
        lines.append(_line(*pair, *joint.anchors[0], joint.softness, bias_factor(joint)))
    return "".join(lines)


def _line(*values: object) -> str:
    return " ".join(map(str, values)) + "\n"


def _compile(checkout: Path, binary: Path) -> None:
    """Compiles the driver and the engine's sources. PeerError, with the compiler's first complaint, if it cannot."""
    compiler = shutil.which("g++")
    if compiler is None:
        raise PeerError("Box2D Lite cannot be compiled: there is no g++")
    include = checkout / "include"
    folders = (f"-I{include}", f"-I{include / 'box2d-lite'}")
    sources = sorted((checkout / "src").glob("*.cpp"))
    command: list[str | Path] = [compiler, *FLAGS, *folders, "-o", binary, DRIVER, *sources]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=COMPILE_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        raise PeerError(f"Box2D Lite cannot be compiled: g++ took longer than {COMPILE_SECONDS:g} s") from None
    if done.returncode != 0:
        lines = done.stderr.splitlines()
        complaint = next((line for line in lines if "error" in line), next(iter(lines), f"exit code {done.returncode}"))
        raise PeerError(f"Box2D Lite cannot be compiled: {complaint.strip()}")
