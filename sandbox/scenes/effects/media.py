"""Air and water: drag, wind, buoyancy."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Circle, World
from sandbox.lab.references import terminal_speed
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

# --- drag -------------------------------------------------------------------------------------------------------------

DRAGS = (0.4, 0.8, 1.6, 3.2)  # of bodies of 1 kg [kg/m]
FALLING = 2.5  # [s]


@scene(
    "Effects/Drag",
    shows=Criterion(
        "the speed of a fall differs from sqrt(m g / c) by",
        lambda world: float(
            np.abs(-world.velocities[1:, 1] / [terminal_speed(1.0, GRAVITY, drag) for drag in DRAGS] - 1.0).max()
        ),
        unit="of it",
        after=FALLING,
        at_most=1e-3,  # what tanh(g t / v) has still to go is 9e-5 of the fastest
    ),
    view=(0.0, 6.8, 16.5),
)
def drag(world: World) -> None:
    """Four bodies of one weight, each with twice the drag of the one before, end at speeds of their own."""
    add_floor(world, 40)
    for k, coefficient in enumerate(DRAGS):
        width = 0.5 * 1.5**k
        world.create_body(
            Box(width, 0.4), position=(3.2 * (k - 1.5), 14.0), mass=1.0, drag=coefficient, fixed_rotation=True
        )


# --- wind -------------------------------------------------------------------------------------------------------------

WIND = 6.0  # [m/s]
LANTERNS = (0.05, 0.1, 0.2, 0.4)  # drag, of 1 kg [kg/m]
CORD, HUNG = 2.5, 6.0  # length of a lantern's cord, height that it hangs at [m]


def lean_error(world: World) -> float:
    """The worst angle of a cord, against that at which drag and weight pull along it [degrees]."""
    leans = [
        math.atan2(x - 3.5 * (k - 1.5), HUNG - y) - math.atan(c * WIND**2 / GRAVITY)
        for k, ((x, y), c) in enumerate(zip(world.positions[1:], LANTERNS, strict=True))
    ]
    return math.degrees(max(map(abs, leans)))


@scene(
    "Effects/Wind",
    shows=Criterion(
        "a lantern's cord is off atan(c W^2 / m g) by", lean_error, unit="degrees", after=20.0, at_most=0.05
    ),
    wind=(WIND, 0.0),
    view=(1.0, 4.2, 11.0),
)
def wind(world: World) -> None:
    """Lanterns on cords lean into a steady wind: the tangent of the angle is drag over weight."""
    beam = world.create_body(Box(14, 0.3), position=(0.0, HUNG + 0.15), kind="static")
    for k, coefficient in enumerate(LANTERNS):
        x = 3.5 * (k - 1.5)
        lantern = world.create_body(
            Circle(0.3 + 0.05 * k), position=(x, HUNG - CORD), mass=1.0, drag=coefficient, angular_damping=1.0
        )
        world.create_joint_revolute(beam, lantern, anchor=(x, HUNG), collide_connected=False)


# --- buoyancy ---------------------------------------------------------------------------------------------------------

WATER = 1000.0  # [kg/m^2]
RAFTS = (0.25, 0.5, 0.75)  # density, in parts of the water's
POOL, DEPTH = 16.0, 4.0  # [m]
THICK = 0.8  # of a raft [m]


def draft_error(world: World) -> float:
    """The worst depth of a raft, against that of the water that weighs as much [m]."""
    bottoms = world.positions[1 : 1 + len(RAFTS), 1] - 0.5 * THICK
    return float(np.abs(bottoms + np.array(RAFTS) * THICK).max())


@scene(
    "Effects/Buoyancy",
    shows=(
        Criterion("a raft floats off the depth that Archimedes says by", draft_error, "m", 20.0, at_most=1e-3),
        Criterion(
            "a ball of half the water's density floats off its middle by",
            lambda world: abs(float(world.positions[-2, 1])),
            unit="m",
            after=20.0,
            at_most=1e-3,
        ),
    ),
    view=(0.0, -1.0, 14.0),
)
def buoyancy(world: World) -> None:
    """Rafts, a ball and a stone fall into a pool: each displaces its own weight, but the stone cannot."""
    pool = world.create_body(kind="static")
    pool.add_shape(Box(POOL + 2.0, 1.0), offset=(0.0, -DEPTH - 0.5))
    for side in (-1.0, 1.0):
        pool.add_shape(Box(1.0, DEPTH + 0.5), offset=(side * 0.5 * (POOL + 1.0), 0.25 - 0.5 * DEPTH))
    world.create_fluid((-0.5 * POOL, -DEPTH), (0.5 * POOL, 0.0), density=WATER, linear_drag=2.0, angular_drag=2.0)
    for k, part in enumerate(RAFTS):
        world.create_body(Box(2.4, THICK), position=(-6.0 + 3.3 * k, 1.0), density=part * WATER)
    world.create_body(Circle(0.6), position=(3.6, 1.5), density=0.5 * WATER)
    world.create_body(Circle(0.5), position=(6.2, 2.0), density=2.5 * WATER)
