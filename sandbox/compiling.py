"""Compiling beforehand what will be called for, and saying what is being compiled while a person waits."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from engine import EFFECTS, SHAPES, SOLVERS, Box, Circle, World
from engine.compilation import watch_compilation
from engine.threads import WORTH_SHARING
from sandbox.scenes import Scene
from sandbox.simulation import TIME_STEP, Simulation

Say = Callable[[str], None]


@contextmanager
def announced(say: Say) -> Iterator[list[str]]:
    """Names the kernels that are compiled while this lasts; gives the list of them, which grows."""
    names: list[str] = []

    def announce(kernel: str) -> None:
        if not names:
            say("compiling the engine; this is kept on disk, so it waits for it only once:")
        names.append(kernel)
        say(f"  {kernel}")

    with watch_compilation(announce):
        yield names


def rehearse(scene: Scene, say: Say, **settings: Any) -> None:
    """Compiles what this scene calls for, and a box that is spawned into it: what one does first."""
    with announced(say):
        simulation = Simulation(scene, **settings)
        x, y, height = scene.view
        simulation.step()
        simulation.world.create_body(Box(1, 1), position=(x, y + height))
        simulation.step()
        simulation.frame()


def exercise(precision: str) -> None:
    """Runs every kernel once: each solver, all shapes, all pairs of them, joints, every effect."""
    for solver in SOLVERS.values():
        empty = Scene("warm up", lambda world: None, "", (0.0, 0.0, 1.0))
        simulation = Simulation(empty, precision=precision, solver=solver.name)
        (fill if solver.name != "direct" else fill_few)(simulation.world)
        simulation.step()
        simulation.frame()
        state = simulation.world._state
        state.forced = frozenset(effect.name for effect in EFFECTS if effect.name not in solver.lacks)
        state.stale = True
        simulation.step()
        simulation.world.bodies[2].velocity = (900.0, 0.0)  # so fast that it is swept
        simulation.step()
    crowd = World(precision=precision, threads=2)
    fill_to_share(crowd)
    crowd.step(TIME_STEP)
    crowd.threads = 1
    crowd.run(2, TIME_STEP)


def fill_to_share(world: World) -> None:
    """So many that several threads share each stage: boxes and circles in rows, touching."""
    across = np.arange(WORTH_SHARING + 2.0)
    for shape, y in ((Box(1, 1), 0.0), (Circle(0.5), 5.0)):
        world.create_bodies(shape, positions=np.column_stack([0.99 * across, np.full(len(across), y)]))


def fill_few(world: World) -> None:
    """As little as a solver of small islands takes."""
    ground = world.create_body(Box(4, 1), kind="static")
    for k in range(3):
        world.create_body((Box(0.5, 0.5), Circle(0.3), Box(0.4, 0.6))[k], position=(0.7 * k - 0.7, 0.74))
    world.create_joint_revolute(ground, world.bodies[1], anchor=(0, 0), collide_connected=False)


def fill(world: World) -> None:
    """Everything on top of each other."""
    ground = world.create_body(kind="static")
    for number, shape in enumerate(SHAPES):
        ground.add_shape(shape.filling(1.0, 1.0))
        for _ in range(2):
            body = world.create_body(position=(0.1 * number, 0.2))
            body.add_shape(shape.filling(1.0, 1.0))
    world.create_body(Box(1, 1), kind="kinematic")
    world.create_joint_revolute(ground, world.bodies[1], anchor=(0, 0), collide_connected=False)


def compile_all(say: Say, precisions: Iterable[str] = ("single",)) -> tuple[int, float]:
    """Compiles what is not on disk yet, and says what. Returns the number of kernels compiled and the time [s]."""
    started = time.perf_counter()
    with announced(say) as names:
        for precision in precisions:
            exercise(precision)
    return len(names), time.perf_counter() - started


@contextmanager
def compiling_rest(precision: str) -> Iterator[None]:
    """While this lasts, compiles in the background what a scene does not call for yet but a visitor may.

    In another process, onto the disk: the scene does not stutter for it, and it can be ended in the middle of a kernel,
    at which a thread would take this process down with it.
    """
    code = f"from sandbox.compiling import exercise; exercise({precision!r})"
    nothing = subprocess.DEVNULL
    process = subprocess.Popen([sys.executable, "-c", code], stdin=nothing, stdout=nothing, stderr=nothing)
    try:
        yield
    finally:
        process.kill()
        process.wait()
