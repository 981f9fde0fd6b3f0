"""What hits: discs that meet head on, and one that hits a rod off its centre."""

from __future__ import annotations

from functools import partial

import numpy as np

from engine import Box, Circle, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    APART,
    COPIES,
    History,
    Measure,
    Watch,
    exact,
    experiment,
    of_clean_impulses,
    of_impulses,
)

# --- head on ----------------------------------------------------------------------------------------------------------

DISC_MASSES, DISC_RADII, SPEEDS, MEETING = (1.0, 3.0), (0.3, 0.5), (4.0, -1.0), 1.0  # [kg], [m], [m/s], [s]
GAPS = np.linspace(1.0, 2.0, COPIES // 2)  # all different, likewise [m]
APPROACH = SPEEDS[0] - SPEEDS[1]  # [m/s]


def speeds_error(history: History, dt: float, restitution: float) -> float:
    """The farthest that a speed is in the end from what it should be [m/s]."""
    expected = references.collision(*DISC_MASSES, *SPEEDS, restitution)
    return float(np.abs(history[-1].reshape(-1, 2, 2)[:, :, 1] - expected).max())


def places_error(history: History, dt: float, restitution: float) -> float:
    """The same of its place, root mean square over all [m]."""
    hit = GAPS / APPROACH
    left = len(history) * dt - hit  # of the time, after they met
    starts = (-DISC_RADII[0] + 0.0 * GAPS, DISC_RADII[1] + GAPS)
    after = references.collision(*DISC_MASSES, *SPEEDS, restitution)
    exactly = np.column_stack([starts[k] + SPEEDS[k] * hit + after[k] * left for k in range(2)])
    return float(np.sqrt(np.mean((history[-1].reshape(-1, 2, 2)[:, :, 0] - exactly) ** 2)))


def momentum_error(history: History, dt: float) -> float:
    """How far the momentum of a pair ever leaves what it was [kg m/s]."""
    speeds = history.reshape(len(history), -1, 2, 2)[..., 1]
    return float(np.abs(speeds @ DISC_MASSES - np.dot(DISC_MASSES, SPEEDS)).max())


def collision_measures(restitution: float) -> tuple[Measure, ...]:
    approach = "the speed at which they meet"
    speeds = partial(speeds_error, restitution=restitution)
    where = partial(places_error, restitution=restitution)
    momentum = f"the momentum of the lighter, {DISC_MASSES[0] * SPEEDS[0]:g} kg m/s"
    return (
        Measure(
            "speed", "m/s", "how fast they are afterwards, at worst", speeds, of_clean_impulses(exact), APPROACH,
            approach,
        ),
        Measure(
            "place", "m", f"where they are after {MEETING:g} s, root mean square", where, scale=SPEEDS[0] * MEETING,
            against="how far the lighter would get",
        ),
        Measure(
            "momentum", "kg m/s", "how far a pair's momentum leaves what it was, at worst", momentum_error,
            of_impulses(exact), DISC_MASSES[0] * SPEEDS[0], momentum,
        ),
    )  # fmt: skip


def meet(world: World, restitution: float) -> Watch:
    """Pairs of discs that run into each other; watches place and speed of each."""
    world.gravity = (0.0, 0.0)
    for k, gap in enumerate(GAPS):
        for radius, mass, speed, x in zip(
            DISC_RADII, DISC_MASSES, SPEEDS, (-DISC_RADII[0], gap + DISC_RADII[1]), strict=True
        ):
            world.create_body(
                Circle(radius), position=(x, APART * k), velocity=(speed, 0.0), mass=mass, restitution=restitution,
                friction=0.0,
            )  # fmt: skip
    return lambda world: np.column_stack([world.positions[:, 0], world.velocities[:, 0]]).ravel()


@experiment(
    "collision",
    "two discs of 1 and 3 kg meet head on and part elastically",
    seconds=MEETING,
    measures=collision_measures(1.0),
    needs=("restitution",),
)
def build_collision(world: World) -> Watch:
    return meet(world, 1.0)


@experiment(
    "collision_inelastic",
    "two discs of 1 and 3 kg meet head on and stay together",
    seconds=MEETING,
    measures=collision_measures(0.0),
)
def build_collision_inelastic(world: World) -> Watch:
    return meet(world, 0.0)


# --- off the centre ---------------------------------------------------------------------------------------------------

ROD, ROD_MASS, SHOT_MASS, SHOT_RADIUS = (0.4, 3.0), 2.0, 1.0, 0.3  # [m], [kg], [kg], [m]
SHOT_AT, ARM, SHOT_RESTITUTION = 5.0, 1.0, 0.5  # [m/s], how far past its centre [m]
ROD_INERTIA = ROD_MASS * (ROD[0] ** 2 + ROD[1] ** 2) / 12.0  # [kg m^2]
SHOT = references.off_centre_impulse(SHOT_MASS, ROD_MASS, ROD_INERTIA, ARM, SHOT_AT, SHOT_RESTITUTION)  # [N s]
AFTER = (SHOT_AT - SHOT / SHOT_MASS, SHOT / ROD_MASS, -ARM * SHOT / ROD_INERTIA)  # of disc and rod [m/s], spin [rad/s]


def shot_errors(history: History) -> np.ndarray:
    """(pairs, 3) how far the speeds of disc and rod, and its spin, are in the end from what they should be."""
    return np.abs(history[-1].reshape(-1, 3) - AFTER)


@experiment(
    "off_centre",
    "a disc hits a rod at rest, off its centre",
    seconds=0.6,
    measures=(
        Measure(
            "speed",
            "m/s",
            "how fast disc and rod are afterwards, at worst",
            lambda history, dt: float(shot_errors(history)[:, :2].max()),
            of_clean_impulses(exact),
            SHOT_AT,
            "the speed of the disc",
        ),
        Measure(
            "spin",
            "rad/s",
            "how fast the rod turns afterwards, at worst",
            lambda history, dt: float(shot_errors(history)[:, 2].max()),
            of_clean_impulses(exact),
            -AFTER[2],
            "how fast it turns",
        ),
    ),
    needs=("restitution",),
)
def build_off_centre(world: World) -> Watch:
    world.gravity = (0.0, 0.0)
    for k, gap in enumerate(GAPS):
        world.create_body(
            Circle(SHOT_RADIUS), position=(-0.5 * ROD[0] - SHOT_RADIUS - gap, APART * k + ARM),
            velocity=(SHOT_AT, 0.0), mass=SHOT_MASS, restitution=SHOT_RESTITUTION, friction=0.0,
        )  # fmt: skip
        world.create_body(Box(*ROD), position=(0.0, APART * k), mass=ROD_MASS, friction=0.0)

    def watch(world: World) -> np.ndarray:
        speeds, spins = world.velocities[:, 0].reshape(-1, 2), world.angular_velocities[1::2]
        return np.column_stack([speeds, spins]).ravel()

    return watch
