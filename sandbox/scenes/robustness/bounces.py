"""Bounces: none below the threshold, one above it, and never higher than from where it came."""

from __future__ import annotations

import math

import numpy as np

from engine import Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

BALL = 0.25  # [m]

# --- threshold --------------------------------------------------------------------------------------------------------

SLOW, FAST = 0.8, 1.4  # at which two balls hit the floor [m/s]; nothing bounces below 1


def height_for(speed: float) -> float:
    """From which a ball falls as fast, v^2 / 2g [m]."""
    return speed * speed / (2.0 * GRAVITY)


@scene(
    "Robustness/Restitution Threshold",
    shows=(
        Criterion(
            "the ball that is slow comes back at",
            lambda world: float(world.velocities[1, 1]),
            unit="m/s",
            after=1.0,
            at_most=0.02,
            throughout=True,
        ),
        Criterion(
            "the ball that is fast comes back at",
            lambda world: float(world.velocities[2, 1]),
            unit="m/s",
            after=1.0,
            at_least=FAST - GRAVITY / 60.0,  # less what it loses in a step
            at_most=FAST + GRAVITY / 60.0,
            throughout=True,
        ),
    ),
    view=(0.0, 0.5, 3.0),
)
def restitution_threshold(world: World) -> None:
    """Two balls of perfect restitution: one falls below a metre a second and stays, the other comes back."""
    add_floor(world, 20)
    for x, speed in ((-0.5, SLOW), (0.5, FAST)):
        world.create_body(Circle(BALL), position=(x, BALL + height_for(speed)), restitution=1.0)


# --- column -----------------------------------------------------------------------------------------------------------

BALLS, GAP, DROP, BOUNCE = 4, 0.1, 3.0, 0.9  # [m]
WATCHED = 8.0  # [s]
FALLING, TURNED = 0.7, 1.0  # the lowest hits the floor after 0.77 s, and all are on their way back [s]
HITS = 2 * BALLS
"""With the floor and with each other, each twice: no hit takes more than 1 - e^2 of what moves."""
LOWEST = BALL * (2 * np.arange(BALLS) + 1)  # heights in a column at rest [m]
FALL = DROP + GAP * np.arange(BALLS)  # how far each can fall [m]


def energy(world: World) -> float:
    """Of all balls over that of a column at rest, in parts of what they began with."""
    height = world.positions[1:, 1] - LOWEST
    kinetic = 0.5 * (world.velocities[1:] ** 2).sum() + 0.25 * (BALL * world.angular_velocities[1:] ** 2 * BALL).sum()
    return float((kinetic + GRAVITY * height.sum()) / (GRAVITY * FALL.sum()))


def fallen(world: World) -> float:
    """How far the ball that has fallen least has fallen, in parts of g t^2 / 2."""
    return float((LOWEST + FALL - world.positions[1:, 1]).min()) / (0.5 * GRAVITY * FALLING**2)


@scene(
    "Robustness/Bouncing Column",
    shows=(
        Criterion(
            "of their energy, the balls have",
            energy,
            unit="",
            after=WATCHED,
            at_most=lambda world, dt: 1.0 + 2.0 * GRAVITY * dt / math.sqrt(2.0 * GRAVITY * DROP),  # a step's of speed
            throughout=True,
        ),
        Criterion(
            "before the first hit, each ball has fallen, in parts of g t^2 / 2, by",
            fallen,
            unit="",
            after=FALLING,
            at_least=lambda world, dt: 0.99 - dt / FALLING,  # steps of first order are off by g h t / 2
            at_most=lambda world, dt: 1.01 + dt / FALLING,
        ),
        Criterion(
            "when all have come back, of their energy, the balls have",
            energy,
            unit="",
            after=TURNED,
            at_least=BOUNCE ** (2 * HITS),
        ),
    ),
    view=(0.0, 3.0, 8.0),
)
def bouncing_column(world: World) -> None:
    """Four bouncing balls fall on each other: the topmost may fly, all together they have no more than they had."""
    add_floor(world, 40)
    places = np.column_stack([np.zeros(BALLS), LOWEST + FALL])
    world.create_bodies(Circle(BALL), positions=places, restitution=BOUNCE)
