"""Forces at a distance: magnets, and planets."""

from __future__ import annotations

import numpy as np

from engine import Box, Circle, World
from engine.constants import MAGNET_CONSTANT
from sandbox.lab.references import levitation, orbit_speed, orbit_wobble
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, and_a_fifth
from sandbox.scenes.registry import scene

# --- magnets ----------------------------------------------------------------------------------------------------------

STRENGTH = 10.0  # K p^2 of two of them, in their own weight at 1 m: in the tube each would float 3.2 m above the other
POLE = float(np.sqrt(STRENGTH * GRAVITY / MAGNET_CONSTANT))
FLOATING = 5
HEIGHTS = levitation(FLOATING, STRENGTH)  # above the one at the bottom [m]


@scene(
    "Effects/Magnets",
    shows=Criterion(
        "a magnet floats off the height at which all others carry it by",
        lambda world: float(np.abs(world.positions[-FLOATING:, 1] - HEIGHTS).max()),
        unit="m",
        after=20.0,
        at_most=1e-3,
    ),
    view=(0.0, 8.0, 19.0),
)
def magnets(world: World) -> None:
    """Magnets of one sign in a smooth tube carry each other through the air: further down, closer together."""
    tube = world.create_body(kind="static", friction=0.0)
    for side in (-1.0, 1.0):
        tube.add_shape(Box(0.3, 17.0), offset=(side * 0.7, 8.0), friction=0.0)
    world.create_body(Circle(0.5), kind="static", magnet=POLE, friction=0.0)
    for k in range(FLOATING):
        world.create_body(
            Circle(0.5), position=(0.0, 2.4 * (k + 1)), mass=1.0, magnet=POLE, linear_damping=1.0, friction=0.0
        )


# --- point gravity ----------------------------------------------------------------------------------------------------

PULL = 60.0  # of the sun [m^3/s^2]
ORBITS = (3.0, 4.5, 6.5, 9.0)  # radii [m]


@scene(
    "Effects/Point Gravity",
    shows=Criterion(
        "a planet leaves its circle by",
        lambda world: float(np.abs(np.hypot(*world.positions[1:].T) - ORBITS).max()),
        unit="m",
        after=20.0,
        at_most=and_a_fifth(lambda world, dt: orbit_wobble(PULL, min(ORBITS), dt / world.settings.substeps, dt)),
        throughout=True,
    ),
    gravity=(0.0, 0.0),
    view=(0.0, 0.0, 20.0),
)
def point_gravity(world: World) -> None:
    """Four planets circle a sun, each as fast as its distance asks for."""
    world.create_body(Circle(1.2), kind="static", attraction=PULL)
    for k, radius in enumerate(ORBITS):
        turn = 1.1 * k
        place = (radius * np.cos(turn), radius * np.sin(turn))
        speed = orbit_speed(PULL, radius)
        velocity = (-speed * np.sin(turn), speed * np.cos(turn))
        world.create_body(Circle(0.25 + 0.06 * k), position=place, velocity=velocity, friction=0.0)
