"""What a world at rest costs, and what it costs to solve chains at once: figures that the documents claim."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from engine import Box, World
from sandbox.scenes import find_scene
from sandbox.scenes.joints.parts import gap
from sandbox.scenes.robustness.chains import hanging
from sandbox.simulation import TIME_STEP

HEAVY = "20 links, 1000 times a link at the end"
CHAINS = (HEAVY, "Joints/Ball and Chain", "Joints/Bridge")
BOXES, COLUMN, APART = 10_000, 50, 1.5  # in columns of so many, so far apart [m]
LONGEST = 3000  # steps until all must sleep
TIMED = 300  # steps of a world at rest
ROUNDS, STEPS = 60, 10  # turns of two worlds, and the steps of each


@dataclass(frozen=True)
class Rest:
    """A world in which all sleeps."""

    boxes: int
    steps_until_asleep: int
    step_us: float  # median time of World.step [us]
    run_us: float  # of each step of World.run [us]


@dataclass(frozen=True)
class Chain:
    """A scene with its joints solved at once and, in turns with it, visited one by one."""

    scene: str
    seconds: float  # simulated
    gap_mm: float  # that any joint stood open at most in the second half, solved at once [mm]
    iterated_gap_mm: float
    step_us: float  # median time of a step [us]
    iterated_step_us: float

    @property
    def ratio(self) -> float:
        """What it costs: the time of a step over that of a step with visits."""
        return self.step_us / self.iterated_step_us


def rest(boxes: int = BOXES) -> Rest:
    """Columns of boxes on a floor, once they sleep."""
    world = World()
    columns = -(-boxes // COLUMN)
    world.create_body(Box(2.0 * APART * columns, 1.0), position=(0.0, -0.5), kind="static")
    number = np.arange(boxes)
    x, y = APART * (number // COLUMN - 0.5 * columns), 0.25 + 0.5 * (number % COLUMN)
    world.create_bodies(Box(0.5, 0.5), positions=np.column_stack([x, y]))
    while world.awake_count and world.step_count < LONGEST:
        world.step(TIME_STEP)
    steps = world.step_count
    stepped = [timed(lambda: world.step(TIME_STEP)) for _ in range(TIMED)]
    ran = timed(lambda: world.run(TIMED, TIME_STEP)) / TIMED
    return Rest(boxes, steps, 1e6 * float(np.median(stepped)), 1e6 * ran)


def chain(scene: str, rounds: int = ROUNDS) -> Chain:
    """Both ways of solving take turns, so that what slows the machine for a while slows both."""
    worlds = {how: made(scene, how) for how in ("auto", "iterated")}
    gaps = dict.fromkeys(worlds, 0.0)
    times: dict[str, list[float]] = {how: [] for how in worlds}
    for number in range(rounds):
        for how, world in worlds.items():
            for _ in range(STEPS):
                times[how].append(timed(partial(world.step, TIME_STEP)))
                gaps[how] = max(gaps[how], gap(world) if 2 * number >= rounds else 0.0)
    us = {how: 1e6 * float(np.median(found)) for how, found in times.items()}
    return Chain(
        scene, rounds * STEPS * TIME_STEP, 1e3 * gaps["auto"], 1e3 * gaps["iterated"], us["auto"], us["iterated"]
    )


def made(scene: str, joint_solving: str) -> World:
    """The scene at its beginning, in which nothing falls asleep."""
    if scene != HEAVY:
        return find_scene(scene).make(joint_solving=joint_solving, sleeping=False)
    world = World(joint_solving=joint_solving, sleeping=False)
    hanging(1000.0)(world)
    return world


def timed(call: Callable[[], object]) -> float:
    """CPU time [s]."""
    before = time.process_time_ns()
    call()
    return 1e-9 * (time.process_time_ns() - before)


def claims() -> dict[str, Any]:
    """All of them, as JSON takes it."""
    return {
        "rest": asdict(rest()),
        "chains": [{**asdict(found), "ratio": found.ratio} for found in map(chain, CHAINS)],
    }


def as_text(found: dict[str, Any]) -> str:
    """As a person reads it."""
    still = found["rest"]
    lines = [
        f"{still['boxes']} boxes asleep: {still['step_us']:.2f} us a step, {still['run_us']:.2f} us in World.run",
        *(
            f"{one['scene']}: solved at once, joints open by {one['gap_mm']:.2f} mm at most in the second half of"
            f" {one['seconds']:.0f} s, and a step takes {one['step_us']:.0f} us; visited one by one,"
            f" {one['iterated_gap_mm']:.1f} mm and {one['iterated_step_us']:.0f} us: {one['ratio']:.2f} times the time"
            for one in found["chains"]
        ),
    ]
    return "\n".join(lines)
