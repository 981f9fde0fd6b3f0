"""How a single body moves: damping, and its own share of gravity."""

from __future__ import annotations

import numpy as np

from engine import Box, Circle, World
from sandbox.lab.references import damped, flight, flight_lag
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

RATES = (0.0, 0.25, 0.5, 1.0, 2.0)  # [1/s]
AFTER = 3.0  # [s]


def damping_error(rate: float, h: float, time: float) -> float:
    """How much too large (1 + h c)^-n is, to first order, in parts: c^2 h t / 2."""
    return 0.5 * rate * rate * h * time


SPEED = 6.0  # [m/s]


@scene(
    "Effects/Linear Damping",
    shows=Criterion(
        "what is left of a puck's speed differs from e^(-c t) by",
        lambda world: float(
            np.abs(world.velocities[:, 0] / [damped(SPEED, rate, world.time) for rate in RATES] - 1.0).max()
        ),
        unit="of it",
        after=AFTER,
        at_most=lambda world, dt: 1.1 * damping_error(max(RATES), dt / world.settings.substeps, AFTER),
    ),
    gravity=(0.0, 0.0),
    sleeping=False,  # what is slow is looked at, too
    view=(2.0, 0.0, 16.0),
)
def linear_damping(world: World) -> None:
    """Pucks seen from above: each loses its speed at its own rate, and one keeps it."""
    for k, rate in enumerate(RATES):
        place = (-8.0, 2.0 * (2 - k))
        world.create_body(Circle(0.6), position=place, velocity=(SPEED, 0.0), linear_damping=rate)


SPIN = 8.0  # [rad/s]


@scene(
    "Effects/Angular Damping",
    shows=Criterion(
        "what is left of a wheel's spin differs from e^(-c t) by",
        lambda world: float(
            np.abs(world.angular_velocities / [damped(SPIN, rate, world.time) for rate in RATES] - 1.0).max()
        ),
        unit="of it",
        after=AFTER,
        at_most=lambda world, dt: 1.1 * damping_error(max(RATES), dt / world.settings.substeps, AFTER),
    ),
    gravity=(0.0, 0.0),
    sleeping=False,  # what is slow is looked at, too
    view=(0.0, 0.0, 8.0),
)
def angular_damping(world: World) -> None:
    """Crosses spin down, each at its own rate, and one for ever."""
    for k, rate in enumerate(RATES):
        place = (2.0 * (k - 2), 0.0)
        cross = world.create_body(Box(1.6, 0.3), position=place, angular_velocity=SPIN, angular_damping=rate)
        cross.add_shape(Box(0.3, 1.6))


SCALES = (1.0, 0.5, 0.165, 0.0, -0.25)  # 0.165: the moon's
HEIGHT = 6.0  # [m]
FALL = 1.0  # [s]


@scene(
    "Effects/Gravity Scale",
    shows=Criterion(
        "a body is off g s t^2 / 2 by",
        lambda world: float(
            np.abs(world.positions[1:, 1] - [flight(HEIGHT, 0.0, GRAVITY * s, world.time) for s in SCALES]).max()
        ),
        unit="m",
        after=FALL,
        at_most=lambda world, dt: 1.001 * flight_lag(GRAVITY, dt / world.settings.substeps, FALL),
    ),
    view=(0.0, 5.5, 12.0),
)
def gravity_scale(world: World) -> None:
    """A stone, a feather's half, a stone on the moon, one in orbit, and a balloon."""
    add_floor(world, 40)
    for k, scale in enumerate(SCALES):
        world.create_body(Circle(0.5), position=(2.0 * (k - 2), HEIGHT), gravity_scale=scale)
