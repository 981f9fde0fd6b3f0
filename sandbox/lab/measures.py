"""How wrong a world is: what is measured of its state, of its constraints, and of its way through time.

Of a state, after a step: penetration, joint errors, energy, momentum, speeds. Of its constraints: the friction cone and
the complementarity of contacts, each with the constraint that is worst. Of a history: jitter, drift, the distance from
a reference and the time until it diverges. Nothing here changes the world; all sums are in double precision.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from engine import World
from engine.tables import ALONG_WAY, DISTANCE, DYNAMIC, PRISMATIC, REVOLUTE, STIFF, WELD, WHEEL


class Worst(NamedTuple):
    """A residual, and the constraint at which it is largest."""

    value: float
    body1: int  # serials of its bodies; -1 where there is no constraint
    body2: int
    place: tuple[float, float]  # where it is [m]


NOWHERE = Worst(0.0, -1, -1, (math.nan, math.nan))

# --- of a state -------------------------------------------------------------------------------------------------------


def penetration(world: World) -> float:
    """The deepest overlap of two shapes [m], >= 0: of all contacts, as the last step's narrow phase found them."""
    return world.diagnostics().max_penetration


def joint_gaps(world: World) -> np.ndarray:
    """(J,) how far each joint gives way [m], >= 0; 0 of those that hold no point.

    Revolute and weld joints: the distance of the two anchors. Prismatic and wheel joints: that across their axis. Rods
    (distance joints without spring, limits or motor): how far their length is from what it should be.
    """
    records, storage = world.joint_records(), world._state.joints
    joints, slides = storage.tables["joints"][storage.order], storage.tables["slides"][storage.order]
    x, y = records["x2"] - records["x1"], records["y2"] - records["y1"]
    gaps = np.hypot(x, y)
    kinds = records["kind"]
    motions = world._state.bodies.tables["motions"][joints["body1"]]
    axis_x = motions["cosine"] * joints["axis_x"] - motions["sine"] * joints["axis_y"]
    axis_y = motions["sine"] * joints["axis_x"] + motions["cosine"] * joints["axis_y"]
    across = np.abs(axis_x * y - axis_y * x)
    gaps = np.where((kinds == PRISMATIC) | (kinds == WHEEL), across, gaps)
    is_rod = (slides["along"] == ALONG_WAY) & (slides["spring"] == STIFF)
    gaps = np.where(kinds == DISTANCE, np.where(is_rod, np.abs(gaps - slides["target"]), 0.0), gaps)
    held = np.isin(kinds, (REVOLUTE, WELD, PRISMATIC, WHEEL, DISTANCE))
    return np.where(held & ((joints["hertz"] == 0.0) | (kinds != WELD)), gaps, 0.0)


def joint_error(world: World) -> float:
    """The farthest that any joint gives way [m], >= 0: see joint_gaps."""
    return float(joint_gaps(world).max(initial=0.0))


def joint_turn_error(world: World) -> float:
    """The farthest that two bodies turned against each other which a joint keeps from it [rad], >= 0.

    Of prismatic joints, and of welds whose angle no spring holds.
    """
    storage = world._state.joints
    joints, turns = storage.tables["joints"][storage.order], storage.tables["turns"][storage.order]
    angles = world._state.bodies.tables["bodies"]["angle"]
    turned = np.abs(angles[joints["body2"]] - angles[joints["body1"]] - joints["reference_angle"])
    held = (joints["kind"] == PRISMATIC) | ((joints["kind"] == WELD) & (turns["spring"] == STIFF))
    return float(turned[held].max(initial=0.0))


def energy(world: World) -> float:
    """Kinetic and potential energy of all dynamic bodies [J]; what springs hold is not in it."""
    return world.diagnostics().energy


def momentum(world: World) -> np.ndarray:
    """(3,) momentum x, y [kg m/s], and angular momentum about the origin [kg m^2/s], of all dynamic bodies."""
    found = world.diagnostics()
    return np.array([*found.momentum, found.angular_momentum])


def speeds(world: World) -> np.ndarray:
    """(N,) how fast each body is, as the root mean square of all its mass [m/s]: sqrt(v^2 + I w^2 / m).

    Spin counts as what it moves; of bodies that are not dynamic, 0.
    """
    bodies = world.body_records()
    dynamic = bodies["kind"] == DYNAMIC
    turning = np.where(dynamic, bodies["inertia"] / np.where(dynamic, bodies["mass"], 1.0), 0.0)
    turning = np.where(np.isfinite(turning), turning, 0.0)  # of what cannot turn
    squares = np.sum(world.velocities**2, axis=1) + turning * world.angular_velocities**2
    return np.where(dynamic, np.sqrt(squares), 0.0)


# --- of its constraints -----------------------------------------------------------------------------------------------


def cone_violation(world: World) -> Worst:
    """How far friction leaves its cone [N s]: the largest |P_t| - mu P_n of a contact in the last step, >= 0.

    Coulomb's law lets a contact push sideways with mu times what it presses, mu being the pair's friction coefficient.
    """
    worst = NOWHERE
    for arbiter in world.arbiters:
        for contact in arbiter.contacts:
            excess = abs(contact.tangent_impulse) - arbiter.friction * contact.normal_impulse
            if excess > worst.value:
                worst = Worst(excess, arbiter.body1.serial, arbiter.body2.serial, tuple(contact.position))
    return worst


def complementarity(world: World, dt: float) -> Worst:
    """How far contacts are from pushing only where shapes touch and stay [m/s]: the largest |min(P_n / m, w)|, >= 0.

    The Signorini conditions 0 <= P_n, 0 <= w, P_n w = 0, as the natural map min(., .), which is 0 where they hold
    (Q. Le Lidec et al., "Contact Models in Robotics: a Comparative Analysis", 2023, use such residuals). P_n is what
    the last step, of dt [s], gave; m the effective mass, so that both are speeds. w is how fast the shapes part at
    the point; where they were apart by s when the step began, and nothing pushed, s / dt more: so fast they may still
    come together. Without restitution: what bounces parts while it pushes.
    """
    contacts = world.contact_records()
    if len(contacts) == 0:
        return NOWHERE
    bodies, velocities, spins = world.body_records(), world.velocities, world.angular_velocities
    normal = np.column_stack([contacts["nx"], contacts["ny"]])
    points = np.column_stack([contacts["x"], contacts["y"]])
    parting, inverse_mass = np.zeros(len(contacts)), np.zeros(len(contacts))
    for sign, serials in ((-1.0, contacts["body1"]), (1.0, contacts["body2"])):
        rows = np.searchsorted(bodies["serial"], serials)
        body, v, w = bodies[rows], velocities[rows], spins[rows]
        arms = points - (np.column_stack([body["center_x"], body["center_y"]]) - dt * v)  # as the step began
        lever = arms[:, 0] * normal[:, 1] - arms[:, 1] * normal[:, 0]
        parting += sign * (np.sum(v * normal, axis=1) + w * lever)
        moves = body["kind"] == DYNAMIC
        inverse_mass += np.where(moves, 1.0 / body["mass"] + lever * lever / body["inertia"], 0.0)
    pushed = contacts["normal_impulse"]
    gap = parting + np.where(pushed > 0.0, 0.0, np.maximum(contacts["separation"], 0.0) / dt)
    residual = np.abs(np.minimum(pushed * inverse_mass, gap))
    k = int(np.argmax(residual))
    return Worst(float(residual[k]), int(contacts["body1"][k]), int(contacts["body2"][k]), (points[k, 0], points[k, 1]))


# --- of a history -----------------------------------------------------------------------------------------------------


def energy_error(energies: np.ndarray) -> float:
    """The farthest that the energy ever is from what it was at first [J]; energies: (steps,), of `energy`."""
    return float(np.abs(energies - energies[0]).max())


def energy_gain(energies: np.ndarray) -> float:
    """The most that the energy ever rises above what it was at first [J], >= 0: nothing passive may gain any."""
    return float((energies - energies[0]).max())


def momentum_error(momenta: np.ndarray) -> float:
    """The farthest that the momentum ever is from what it was at first [kg m/s]; momenta: (steps, 2 or 3).

    Where nothing pushes from outside it stays. Of three columns the last, angular momentum, is left out.
    """
    return float(np.hypot(*(momenta[:, :2] - momenta[0, :2]).T).max())


def jitter(history: np.ndarray, dt: float, seconds: float = 1.0) -> float:
    """How fast what should rest still moves [m/s]: the fastest of all bodies within the last seconds.

    history: (steps, N) of `speeds`, in steps of dt [s].
    """
    return float(history[-max(1, round(seconds / dt)) :].max(initial=0.0))


def distances(history: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(steps,) how far the farthest body is from where the reference has it, over time [m].

    history, reference: (steps, N, 2) positions at the same times [m]; the shorter one counts.
    """
    steps = min(len(history), len(reference))
    away = history[:steps] - reference[:steps]
    far = np.hypot(away[..., 0], away[..., 1])
    return np.where(np.isfinite(far), far, np.inf).max(axis=1, initial=0.0)


def time_until_divergence(away: np.ndarray, dt: float, limit: float) -> float:
    """When the distance from the reference first exceeds a limit [s]; infinite if it never does.

    away: (steps,) of `distances`, in steps of dt [s]; the first is that after one step; limit [m].
    """
    beyond = np.flatnonzero(~(away <= limit))
    return float(beyond[0] + 1) * dt if len(beyond) else math.inf


# --- all that can be asked of a world ---------------------------------------------------------------------------------


class Quantity(NamedTuple):
    """A measure of a world after a step of dt [s], as it is shown."""

    unit: str
    of: Callable[[World, float], float]


QUANTITIES: dict[str, Quantity] = {
    "penetration": Quantity("m", lambda world, dt: penetration(world)),
    "joint error": Quantity("m", lambda world, dt: joint_error(world)),
    "joint turn error": Quantity("rad", lambda world, dt: joint_turn_error(world)),
    "energy": Quantity("J", lambda world, dt: energy(world)),
    "speed": Quantity("m/s", lambda world, dt: float(speeds(world).max(initial=0.0))),
    "friction beyond its cone": Quantity("N s", lambda world, dt: cone_violation(world).value),
    "complementarity": Quantity("m/s", lambda world, dt: complementarity(world, dt).value),
}
