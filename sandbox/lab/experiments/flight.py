"""Free bodies: what the integrator does when nothing touches."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    G,
    History,
    Measure,
    Watch,
    exact,
    experiment,
    places,
    substep,
    times,
)

# --- ballistic --------------------------------------------------------------------------------------------------------

THROWN_AT, FLIGHT = 12.0, 2.0  # [m/s], [s]


def flight_error(history: History, dt: float) -> float:
    return abs(history[-1, 0] - references.flight(0.0, THROWN_AT, G, len(history) * dt))


@experiment(
    "ballistic",
    "a ball thrown upwards",
    seconds=FLIGHT,
    measures=Measure(
        "height",
        "m",
        f"height after {FLIGHT:g} s",
        flight_error,
        lambda world, dt: references.flight_lag(G, substep(world, dt), FLIGHT),
        scale=THROWN_AT**2 / (2.0 * G),
        against="the height it rises",
    ),
)
def build_ballistic(world: World) -> Watch:
    balls = [world.create_body(Circle(0.25), position=place, velocity=(0.0, THROWN_AT)) for place in places()]
    ball = balls[0]
    return lambda world: np.array([ball.position.y])


# --- spinning ---------------------------------------------------------------------------------------------------------

SPIN, DRIFT, SPINNING = 7.0, (0.5, -0.25), 4.0  # [rad/s], [m/s], [s]
OFFSET = 0.5  # of the centre of mass from the body's origin [m]


def spin_errors(history: History, dt: float) -> np.ndarray:
    """(steps, 2) how far the angle [rad], and the body's origin [m], are from where they should be."""
    t = times(history, dt)
    x = OFFSET + DRIFT[0] * t - OFFSET * np.cos(SPIN * t)
    y = DRIFT[1] * t - OFFSET * np.sin(SPIN * t)
    return np.column_stack([np.abs(history[:, 0] - SPIN * t), np.hypot(history[:, 1] - x, history[:, 2] - y)])


@experiment(
    "spinning",
    "a body spins freely about its centre of mass, which is not its origin",
    seconds=SPINNING,
    measures=(
        Measure(
            "angle",
            "rad",
            f"how far it has turned after {SPINNING:g} s",
            lambda history, dt: float(spin_errors(history, dt)[-1, 0]),
            exact,
            scale=SPIN * SPINNING,
            against="how far it turns",
        ),
        Measure(
            "place",
            "m",
            "where its origin is, at worst",
            lambda history, dt: float(spin_errors(history, dt)[:, 1].max()),
            exact,
            scale=math.hypot(*DRIFT) * SPINNING,
            against="how far it drifts",
        ),
        Measure(
            "angular momentum",
            "relative",
            "how far its spin leaves what it was, at worst",
            lambda history, dt: float(np.abs(history[:, 3] / SPIN - 1.0).max()),
            exact,
        ),
    ),
)
def build_spinning(world: World) -> Watch:
    world.gravity = (0.0, 0.0)
    bodies = [
        world.create_body(Box(1.0, 0.5), position=place, offset=(OFFSET, 0.0), velocity=DRIFT, angular_velocity=SPIN)
        for place in places()
    ]
    body = bodies[0]
    return lambda world: np.array([body.angle, *body.position, body.angular_velocity])


# --- damped flight ----------------------------------------------------------------------------------------------------

DAMPING, DAMPED_FROM, DAMPED = 0.7, 6.0, 2.0  # [1/s], [m/s], [s]


@experiment(
    "damping",
    "a ball loses its speed to linear damping, and its spin to angular damping",
    seconds=DAMPED,
    measures=Measure(
        "speed",
        "m/s",
        f"speed after {DAMPED:g} s",
        lambda history, dt: abs(float(history[-1, 0]) - references.damped(DAMPED_FROM, DAMPING, len(history) * dt)),
        lambda world, dt: references.damping_excess(DAMPED_FROM, DAMPING, substep(world, dt), DAMPED),
        scale=DAMPED_FROM,
        against="the speed it had",
    ),
    needs=("linear damping", "angular damping"),
)
def build_damping(world: World) -> Watch:
    world.gravity = (0.0, 0.0)
    balls = [
        world.create_body(
            Circle(0.25), position=place, velocity=(0.0, DAMPED_FROM), angular_velocity=DAMPED_FROM,
            linear_damping=DAMPING, angular_damping=DAMPING,
        )
        for place in places()
    ]  # fmt: skip
    ball = balls[0]
    return lambda world: np.array([ball.velocity.y])


# --- orbit ------------------------------------------------------------------------------------------------------------

PULL, RADIUS = 60.0, 3.0  # [m^3/s^2], [m]
ROUND = 2.0 * math.pi * RADIUS / references.orbit_speed(PULL, RADIUS)  # [s]
PLANETS = 12


@experiment(
    "orbit",
    f"{PLANETS} planets on a circle, which do not feel each other, go round a sun",
    seconds=2.0 * ROUND,
    measures=(
        Measure(
            "radius",
            "m",
            "how far it leaves the circle",
            lambda history, dt: float(np.abs(np.hypot(history[:, 0], history[:, 1]) - RADIUS).max()),
            lambda world, dt: references.orbit_wobble(PULL, RADIUS, substep(world, dt), dt),
            scale=RADIUS,
            against="the circle's radius",
        ),
        Measure(
            "angular momentum",
            "relative",
            "how far its angular momentum leaves what it was: the pull goes through the sun where it is looked up",
            lambda history, dt: float(np.abs(angular_momentum(history) / angular_momentum(history)[0] - 1.0).max()),
            exact,
        ),
    ),
    needs=("point gravity",),
)
def build_orbit(world: World) -> Watch:
    world.gravity = (0.0, 0.0)
    world.create_body(Circle(0.5), kind="static", attraction=PULL)
    speed = references.orbit_speed(PULL, RADIUS)
    for turn in 2.0 * math.pi * np.arange(PLANETS) / PLANETS:
        c, s = math.cos(turn), math.sin(turn)
        world.create_body(Circle(0.2), position=(RADIUS * c, RADIUS * s), velocity=(-speed * s, speed * c))
    planet = world.bodies[1]
    return lambda world: np.array([*planet.position, *planet.velocity])


def angular_momentum(history: History) -> np.ndarray:
    """(steps,) x v_y - y v_x, of what was watched as (x, y, v_x, v_y) [m^2/s]."""
    x, y, vx, vy = history.T
    return x * vy - y * vx
