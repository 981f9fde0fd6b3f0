"""What rolls: discs on slopes and floors, and what keeps them from it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine import Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    G,
    Measure,
    Predict,
    Watch,
    add_floor,
    experiment,
    known_of,
    levels,
    places,
    substep,
)
from sandbox.lab.experiments.slopes import add_slope, along_slope, way_down

DISC, ROUGHNESS = 0.5, 0.5  # radius [m], friction
ROLLED, STARTS = 2.0, -8.0  # [s], where discs begin [m]


def with_fresh_contacts(predict: Callable[[World, float], float]) -> Predict:
    """What holds where contacts are found in each integration.

    All solvers but sequential_impulses see contacts ahead, find them once a step at most, and keep them while bodies
    hardly move. A disc turns by w dt meanwhile: an error of the time step, which more substeps do not take away, and of
    which no closed form is known. Its order is: distances converge with dt, the spin of what rolls with dt^2, until a
    disc turns so little in a step that its contact is kept.
    """
    return known_of("sequential_impulses")(predict)


# --- down a slope -----------------------------------------------------------------------------------------------------


def watch_disc(world: World, angle: float, friction: float) -> Watch:
    """Fills the world with discs on slopes; watches how far the first gets [m], and its spin [rad/s]."""
    discs = []
    for y in levels():
        add_slope(world, angle, y, friction)
        place = along_slope(angle, STARTS, DISC, y)
        discs.append(world.create_body(Circle(DISC), position=place, friction=friction))
    disc = discs[0]
    return lambda world: np.array([way_down(disc, angle) - STARTS, -disc.angular_velocity])


GENTLE = math.atan(1.5 * ROUGHNESS)  # half of the slope at which it slips
ROLLS = references.rolling_acceleration(GENTLE, G)  # [m/s^2]


@experiment(
    "rolling",
    "a disc rolls down a slope of half the tangent at which it would slip",
    seconds=ROLLED,
    measures=(
        Measure(
            "distance",
            "m",
            f"how far it rolls in {ROLLED:g} s",
            lambda history, dt: abs(float(history[-1, 0]) - 0.5 * ROLLS * (len(history) * dt) ** 2),
            with_fresh_contacts(lambda world, dt: references.flight_lag(ROLLS, substep(world, dt), ROLLED)),
            scale=0.5 * ROLLS * ROLLED**2,
            against="how far it rolls",
        ),
        Measure(
            "spin",
            "relative",
            "how fast it turns in the end",
            lambda history, dt: abs(float(history[-1, 1]) * DISC / (ROLLS * len(history) * dt) - 1.0),
        ),
    ),
    needs=("friction",),
)
def build_rolling(world: World) -> Watch:
    return watch_disc(world, GENTLE, ROUGHNESS)


STEEP, SMOOTHNESS = math.radians(40.0), 0.1  # tan = 0.84, and it slips above 3 mu = 0.3
SLIPS = references.slope_acceleration(STEEP, SMOOTHNESS, G)  # [m/s^2]
SPINS_UP = references.slip_spin(STEEP, SMOOTHNESS, DISC, G)  # [rad/s^2]


@experiment(
    "slipping",
    "a disc slips down a slope too steep to roll",
    seconds=1.5,
    measures=(
        Measure(
            "distance",
            "m",
            "how far it gets in 1.5 s",
            lambda history, dt: abs(float(history[-1, 0]) - 0.5 * SLIPS * (len(history) * dt) ** 2),
            with_fresh_contacts(lambda world, dt: references.flight_lag(SLIPS, substep(world, dt), 1.5)),
            scale=0.5 * SLIPS * 1.5**2,
            against="how far it gets",
        ),
        Measure(
            "spin",
            "relative",
            "how fast it turns in the end",
            lambda history, dt: abs(float(history[-1, 1]) / (SPINS_UP * len(history) * dt) - 1.0),
        ),
    ),
    needs=("friction",),
)
def build_slipping(world: World) -> Watch:
    return watch_disc(world, STEEP, SMOOTHNESS)


# --- sliding into rolling ---------------------------------------------------------------------------------------------

SKIDS_AT, SKID_FRICTION, SKIDDED = 6.0, 0.25, 2.0  # [m/s], -, [s]
SKID_TIME, SKID_SPEED = references.skid(SKIDS_AT, SKID_FRICTION, G)
SKID_WAY = 0.5 * (SKIDS_AT + SKID_SPEED) * SKID_TIME + SKID_SPEED * (SKIDDED - SKID_TIME)  # [m]


@experiment(
    "skid",
    "a disc thrown without spin slides until it rolls, with 2/3 of its speed",
    seconds=SKIDDED,
    measures=(
        Measure(
            "speed",
            "relative",
            "how fast it rolls in the end",
            lambda history, dt: abs(float(history[-1, 1]) / SKID_SPEED - 1.0),
        ),
        Measure(
            "distance",
            "m",
            f"how far it is after {SKIDDED:g} s",
            lambda history, dt: abs(float(history[-1, 0]) - SKID_WAY),
            with_fresh_contacts(lambda world, dt: references.stopping_lag(SKIDS_AT - SKID_SPEED, substep(world, dt))),
            scale=SKID_WAY,
            against="how far it is",
        ),
    ),
    needs=("friction",),
)
def build_skid(world: World) -> Watch:
    add_floor(world, SKID_FRICTION)
    discs = [
        world.create_body(Circle(DISC), position=(x, y + DISC), velocity=(SKIDS_AT, 0.0), friction=SKID_FRICTION)
        for x, y in places()
    ]
    disc = discs[0]
    return lambda world: np.array([disc.position.x, disc.velocity.x])


# --- rolling resistance -----------------------------------------------------------------------------------------------

RESISTANCE, ROLLS_AT = 0.1, 3.0  # resisting moment / (radius x load), [m/s]
ROLLS_TO = references.rolling_distance(ROLLS_AT, RESISTANCE * DISC, DISC, G)  # [m]


@experiment(
    "rolling_resistance",
    "a disc rolls until its resistance has stopped it",
    seconds=5.0,
    measures=Measure(
        "distance",
        "m",
        "how far it rolls",
        lambda history, dt: abs(float(history[-1, 0]) - ROLLS_TO),
        scale=ROLLS_TO,
        against="how far it rolls",
    ),
    needs=("friction", "rolling resistance"),
)
def build_rolling_resistance(world: World) -> Watch:
    add_floor(world, 0.8)
    discs = [
        world.create_body(
            Circle(DISC), position=(x, y + DISC), velocity=(ROLLS_AT, 0.0), angular_velocity=-ROLLS_AT / DISC,
            friction=0.8, rolling_resistance=RESISTANCE,
        )
        for x, y in places()
    ]  # fmt: skip
    disc = discs[0]
    return lambda world: np.array([disc.position.x])
