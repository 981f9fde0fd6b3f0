"""Bridges: one of 160 planks that holds, and one that breaks."""

from __future__ import annotations

import itertools
import math

import numpy as np

from engine import Body, Box, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import Point, gaps, hanging, pin
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene

THICK = 0.5  # of a plank, where bridges are long [m]


def add_deck(world: World, banks: Body, points: list[Point], thickness: float, density: float, **joint: float) -> None:
    """Planks from each of the points to the next, pinned to each other and to the banks."""
    planks = [
        world.create_body(
            Box(math.dist(one, other), thickness), position=(0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])),
            angle=math.atan2(other[1] - one[1], other[0] - one[0]), density=density, friction=ROUGH,
        )
        for one, other in itertools.pairwise(points)
    ]  # fmt: skip
    pin(world, [banks, *planks, banks], points, collide_connected=False, **joint)


# --- one that holds ---------------------------------------------------------------------------------------------------

PLANKS, SPAN, SAG = 160, 80.0, 8.0  # planks; from bank to bank, and how deep it hangs [m]
DENSITY, LOAD = 20.0, 2.0  # of its planks and of what rolls on it [kg/m^2]


@scene(
    "Joints/Bridge",
    shows=(
        gaps(6.0, at_most=0.01),  # where stones run into each other; elsewhere and at rest a tenth of it
        Criterion(
            "of what rolls on it, there lie below it:",
            lambda world: float(sum(body.position.y < -SAG - 4.0 for body in world.bodies[1 + PLANKS :])),
            unit="",
            after=6.0,
            at_most=0.0,
        ),
        Criterion(
            "of six stones that roll onto it, there have come:",
            lambda world: float(sum(abs(body.position.x) < 0.5 * SPAN for body in world.bodies[1 + PLANKS :][:6])),
            unit="",
            after=6.0,
            at_least=6.0,  # the last has 7.4 m to go, at 2 m/s
        ),
    ),
    view=(0.0, 0.0, 72.0),
)
def bridge(world: World) -> None:
    """A bridge of 160 planks, and what rolls onto it: however long it is, its joints do not open."""
    banks = world.create_body(kind="static")
    for side in (-1.0, 1.0):
        banks.add_shape(Box(24.0, 40.0), offset=(side * (0.5 * SPAN + 12.0), -20.0 + 0.5 * THICK), friction=ROUGH)
    points = hanging((-0.5 * SPAN, 0.0), (0.5 * SPAN, 0.0), SAG, PLANKS)
    add_deck(world, banks, points, THICK, DENSITY)
    for k in range(3):
        radius = 1.0 + 0.2 * k
        for side in (-1.0, 1.0):
            place = (side * (0.5 * SPAN + 1.0 + 3.2 * k), 0.5 * THICK + radius)
            world.create_body(
                Circle(radius), position=place, velocity=(-2.0 * side, 0.0), angular_velocity=2.0 * side / radius,
                density=LOAD, friction=ROUGH,
            )  # fmt: skip
    for x, y in points[PLANKS // 2 - 30 : PLANKS // 2 + 31 : 10]:
        world.create_body(Box(2.0, 2.0), position=(x, y + 0.5 * THICK + 1.1), density=LOAD, friction=ROUGH)


# --- one that breaks --------------------------------------------------------------------------------------------------

SEED = 20261122
SHORT, GORGE, DEPTH = 30, 24.0, 9.0  # planks, width and depth of what it spans [m]
WEAKEST, STRONGEST = 12e3, 24e3  # of its joints [N]: the planks alone pull with 1200
STONES = ((0.6, -12.9), (0.8, 14.4), (1.0, -15.6), (1.2, 16.5))
"""Radii of what rolls onto it, one after another, and where they begin [m]."""


def intact(world: World) -> float:
    """Joints of the bridge that still hold."""
    return float(world.joint_count)


@scene(
    "Joints/Breakable Bridge",
    shows=(
        Criterion("with the first stone on it, joints that hold:", intact, "", 3.0, at_least=SHORT + 1.0),
        Criterion("with all of them on it, joints that hold:", intact, "", 12.0, at_least=SHORT / 3.0, at_most=SHORT),
    ),
    view=(0.0, -2.0, 25.0),
)
def breakable_bridge(world: World) -> None:
    """Stones roll onto a bridge, each heavier than the one before, until a joint breaks."""
    banks = world.create_body(Box(60.0, 2.0), kind="static", offset=(0.0, -DEPTH - 1.0), friction=ROUGH)
    for side in (-1.0, 1.0):
        banks.add_shape(
            Box(16.0, DEPTH + 2.0), offset=(side * (0.5 * GORGE + 8.0), -0.5 * DEPTH - 0.88), friction=ROUGH
        )
    points = hanging((-0.5 * GORGE, 0.0), (0.5 * GORGE, 0.0), 1.5, SHORT)
    add_deck(world, banks, points, 0.25, 10.0)
    strengths = np.random.default_rng(SEED).uniform(WEAKEST, STRONGEST, SHORT + 1)
    for joint, strength in zip(world.joints, strengths.tolist(), strict=True):
        joint.break_force = strength
    for radius, x in STONES:
        side = math.copysign(1.0, x)
        world.create_body(
            Circle(radius), position=(x, 0.12 + radius), velocity=(-1.5 * side, 0.0),
            angular_velocity=1.5 * side / radius, density=50.0, friction=ROUGH, rolling_resistance=0.01,
        )  # fmt: skip
