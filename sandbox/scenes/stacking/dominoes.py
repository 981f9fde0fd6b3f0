"""A row of dominoes: a wave of falling that runs at a speed of its own."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import add_floor
from sandbox.scenes.registry import scene

COUNT = 40
HEIGHT, THICKNESS, SPACING = 1.0, 0.15, 0.4  # [m]
GRIP = 0.6
TILTED = math.radians(45.0)
FALLING = math.radians(5.0)
START = 0.2  # tilt of the first, beyond the 0.15 at which it is balanced on its edge [rad]
PUSH = 1.5  # its spin [rad/s]

WATCHED = 5.0  # [s]
REACHED = 13.5
"""How far the wave gets in that time [m]: what both solvers converge to with ever smaller steps (tests/sandbox/lab/
 test_stability.py)."""


def wave_front(world: World) -> float:
    """How far from the first domino the first is that still stands, or hardly tilts [m]."""
    tilts = -world.angles[1:]
    standing = np.flatnonzero(tilts < FALLING)
    if not len(standing):
        return SPACING * COUNT
    first = int(standing[0])
    part = float(np.clip(tilts[first] / FALLING, 0.0, 1.0))  # how far it has got to be counted as falling
    return SPACING * (first + part)


@scene(
    "Stacking/Dominoes",
    shows=(
        Criterion("the wave of falling has got to", wave_front, "m", WATCHED, 1.1 * REACHED, 0.9 * REACHED),
        Criterion(
            "dominoes that still stand:",
            lambda world: float(np.count_nonzero(-world.angles[1:] < TILTED)),
            unit="",
            after=8.0,
            at_most=0.0,
        ),
    ),
    view=(7.8, 3.0, 13.5),
)
def dominoes(world: World) -> None:
    """Forty dominoes: however the first was pushed, the wave soon runs at its own speed."""
    add_floor(world, 60, friction=GRIP)
    x, y = on_its_edge(START)
    world.create_body(
        Box(THICKNESS, HEIGHT),
        position=(x, y),
        angle=-START,
        velocity=(PUSH * y, -PUSH * (x - 0.5 * THICKNESS)),  # about that edge
        angular_velocity=-PUSH,
        friction=GRIP,
    )
    for k in range(1, COUNT):
        world.create_body(Box(THICKNESS, HEIGHT), position=(SPACING * k, 0.5 * HEIGHT), friction=GRIP)


def on_its_edge(tilt: float) -> tuple[float, float]:
    """Middle of the first domino, turned clockwise about its lower right corner [m]."""
    c, s = math.cos(tilt), math.sin(tilt)
    return 0.5 * (THICKNESS - THICKNESS * c + HEIGHT * s), 0.5 * (THICKNESS * s + HEIGHT * c)
