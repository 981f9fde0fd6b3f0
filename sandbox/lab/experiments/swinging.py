"""What swings: pendulum and spring, by their periods."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    G,
    History,
    Measure,
    Watch,
    as_talk_and_soft_step,
    experiment,
    places,
    substep,
    times,
)
from sandbox.lab.sag import joint_gap

# --- pendulum ---------------------------------------------------------------------------------------------------------

ROD, BOB, AMPLITUDE = 2.0, 0.25, 2.0 * math.pi / 3.0  # [m], [m], [rad]
INERTIA = ROD * ROD + 0.5 * BOB * BOB  # about the pivot, of 1 kg [kg m^2]
PERIOD = references.pendulum_period(INERTIA, 1.0, ROD, G, AMPLITUDE)
INWARD = 2.0 * G * (1.0 - math.cos(AMPLITUDE)) * ROD * ROD / INERTIA  # v^2 / d at the lowest point [m/s^2]


def gap(bob: Body) -> float:
    """How far the end of the rod is from the pivot [m]."""
    return math.dist(bob.position, (ROD * math.sin(bob.angle), -ROD * math.cos(bob.angle)))


def period_error(history: History, dt: float) -> float:
    crossings = zero_crossings(history[:, 0], history[:, 1], dt)
    if len(crossings) < 3:
        return math.inf
    return abs((crossings[2] - crossings[0]) / PERIOD - 1.0)


def swing_energy_error(history: History, dt: float) -> float:
    """The farthest that its energy I w^2 / 2 - m g d cos(angle) ever is from what it was let go with, in parts of that
    above its lowest point, m g d (1 - cos A).
    """
    energy = 0.5 * INERTIA * history[:, 1] ** 2 - G * ROD * np.cos(history[:, 0])
    let_go = -G * ROD * math.cos(AMPLITUDE)
    return float(np.abs(energy - let_go).max()) / (G * ROD * (1.0 - math.cos(AMPLITUDE)))


def zero_crossings(x: np.ndarray, v: np.ndarray, dt: float) -> np.ndarray:
    """Times at which x passes through 0, between steps by the cubic that has its values and its speeds [s]."""
    times = []
    for k in np.flatnonzero(np.sign(x[:-1]) * np.sign(x[1:]) < 0):
        a, b, c, d = x[k], x[k + 1], v[k] * dt, v[k + 1] * dt
        cubic = np.array([2 * a - 2 * b + c + d, -3 * a + 3 * b - 2 * c - d, c, a])
        inside = [root.real for root in np.roots(cubic) if abs(root.imag) < 1e-9 and -1e-9 <= root.real <= 1.0 + 1e-9]
        times.append((k + 1 + (inside[0] if inside else a / (a - b))) * dt)  # the first watched is after one step
    return np.array(times)


def predicted_wobble(world: World, dt: float) -> float | None:
    """Of its energy [relative]. None where the joint gives way by so much that its length, which is wrong to second
    order or as stiffness has it, matters beside what is wrong to first order: by 15 %, in parts of the rod.
    """
    wobble = references.swing_wobble(INERTIA, 1.0, ROD, G, AMPLITUDE, substep(world, dt))
    return wobble if joint_gap(world, dt, G + INWARD, INWARD) < 0.15 * wobble * ROD else None


@experiment(
    "pendulum",
    f"a bob let go {math.degrees(AMPLITUDE):g} degrees from its lowest point",
    seconds=1.3 * PERIOD,
    measures=(
        Measure("period", "relative", "its period", period_error),
        Measure(
            "energy",
            "relative",
            "how far its energy leaves what it was let go with, at worst",
            swing_energy_error,
            as_talk_and_soft_step(predicted_wobble),
            against="what it is let go with, above its lowest point",
        ),
        Measure(
            "joint gap",
            "m",
            "how far its joint gives way",
            lambda history, dt: float(history[:, 2].max()),
            as_talk_and_soft_step(lambda world, dt: joint_gap(world, dt, G + INWARD, INWARD)),
            scale=ROD,
            against="the length of its rod",
        ),
    ),
)
def build_pendulum(world: World) -> Watch:
    pivot = world.create_body(Box(0.2, 0.2), kind="static")
    bobs = []
    for x, y in places():
        place = (x + ROD * math.sin(AMPLITUDE), y - ROD * math.cos(AMPLITUDE))
        bobs.append(world.create_body(Circle(BOB), position=place, angle=AMPLITUDE, mass=1.0))
        world.create_joint_revolute(pivot, bobs[-1], anchor=(x, y), collide_connected=False)
    bob = bobs[0]
    return lambda world: np.array([bob.angle, bob.angular_velocity, gap(bob)])


# --- spring -----------------------------------------------------------------------------------------------------------

HERTZ, REST, STRETCHED, SWINGS = 1.0, 2.0, 0.5, 4.25  # [1/s], length at rest [m], by how much it is let go [m]
OMEGA = 2.0 * math.pi * HERTZ


def spring_error(history: History, dt: float) -> float:
    """The farthest that it ever is from A cos(w t) [m]."""
    return float(np.abs(history[:, 0] - STRETCHED * np.cos(OMEGA * times(history, dt))).max())


def spring_period_error(history: History, dt: float) -> float:
    crossings = zero_crossings(history[:, 0], history[:, 1], dt)
    if len(crossings) < 3:
        return math.inf
    return abs((crossings[-1] - crossings[0]) / (0.5 * (len(crossings) - 1)) * HERTZ - 1.0)


# How springs swing, and by how much their period is too long, in solvers of which that is known.
SPRINGS = {
    "soft_step": (references.soft_oscillation, references.soft_period_excess),
    "xpbd": (references.implicit_oscillation, references.implicit_period_excess),
}


def predicted_spring(world: World, dt: float) -> float | None:
    """At the ends of steps [m]."""
    if world.settings.solver not in SPRINGS:
        return None
    t = np.arange(1, round(SWINGS / HERTZ / dt) + 1) * dt
    found = SPRINGS[world.settings.solver][0](STRETCHED, OMEGA, substep(world, dt), t)
    return float(np.abs(found - STRETCHED * np.cos(OMEGA * t)).max())


def predicted_excess(world: World, dt: float) -> float | None:
    """Of the period [relative]."""
    if world.settings.solver not in SPRINGS:
        return None
    return SPRINGS[world.settings.solver][1](OMEGA, substep(world, dt))


@experiment(
    "spring",
    f"a ball swings on a spring of {HERTZ:g} Hz without damping",
    seconds=SWINGS / HERTZ,
    measures=(
        Measure(
            "place",
            "m",
            "where it is, at worst",
            spring_error,
            predicted_spring,
            scale=STRETCHED,
            against="its amplitude",
        ),
        Measure(
            "period",
            "relative",
            "its period",
            spring_period_error,
            predicted_excess,
        ),
    ),
    needs=("distance joints", "joint springs"),
)
def build_spring(world: World) -> Watch:
    world.gravity = (0.0, 0.0)
    wall = world.create_body(Box(0.2, 0.2), kind="static")
    balls = []
    for x, y in places():
        ball = world.create_body(Circle(0.25), position=(x + REST + STRETCHED, y), mass=1.0)
        world.create_joint_distance(
            wall, ball, anchor1=(x, y), anchor2=ball.position, length=REST, hertz=HERTZ, damping_ratio=0.0
        )
        balls.append(ball)
    ball = balls[0]
    return lambda world: np.array([ball.position.x - REST, ball.velocity.x])
