"""Compiling everything beforehand, and saying what is being compiled while a person waits."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from engine import Box, Circle
from engine.compilation import watch_compilation
from sandbox.scenes import Scene
from sandbox.simulation import Simulation

Say = Callable[[str], None]


def exercise(precision: str) -> None:
    """Runs every kernel once: all shapes, all pairs of them, joints that collide and that do not."""
    simulation = Simulation(Scene("warm up", lambda world: None, "", (0.0, 0.0, 1.0)), precision=precision)
    world = simulation.world
    ground = world.create_body(Box(10, 1), kind="static")
    box = world.create_body(Box(1, 1), position=(0, 0.9))
    for x, shape in ((0.2, Box(1, 1)), (0.4, Circle(0.5)), (0.6, Circle(0.5))):
        world.create_body(shape, position=(x, 1.6))
    world.create_joint_revolute(ground, box, anchor=(0, 0), collide_connected=False)
    for _ in range(2):
        simulation.step()
    simulation.frame()


def compile_all(say: Say, precisions: Iterable[str] = ("single",)) -> tuple[int, float]:
    """Compiles what is not on disk yet, and says what. Returns the number of kernels compiled and the time [s]."""
    started = time.perf_counter()
    count = 0

    def announce(kernel: str) -> None:
        nonlocal count
        if count == 0:
            say("compiling the engine; this is kept on disk, so it waits for it only once:")
        count += 1
        say(f"  {kernel}")

    with watch_compilation(announce):
        for precision in precisions:
            exercise(precision)
    return count, time.perf_counter() - started
