"""How far a pile sinks, before it is run: from the solver's settings and statics alone.

soft_step: a contact is a spring of m_c w^2, w = 2 pi f, m_c its effective mass. Two square boxes of mass m, face to
face, have two points of 1/m_c = 2/m + 2 (1/2)^2 / (m/6) = 5/m each, so k = 0.4 m w^2; a box on the ground, whose
contacts have twice the frequency, 3.2 m w^2. sequential_impulses: contacts stay in overlap by the slop, whatever they
carry.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from engine import World
from engine.constants import JOINT_BIAS_FACTOR, SLOP, STATIC_STIFFENING
from engine.softness import stiffness
from sandbox.lab.structure import GROUND, Point, Structure

MARGIN = 1.2  # "and a fifth": what a pile may sink deeper than predicted
LEAST = 0.8  # and but a fifth: what springs must give way of it, or they do not carry what lies on them
BOX_INERTIA = 1.0 / 6.0  # of a unit square, in parts of its mass [m^2]


def is_soft(world: World) -> bool:
    """Whether its contacts are springs."""
    return world.settings.solver == "soft_step"


def contact_hertz(world: World, dt: float) -> float:
    """Frequency of a contact between two moving bodies, in a step of dt [Hz]."""
    return stiffness(world.settings, dt).contact_hertz


def joint_hertz(world: World, dt: float) -> float:
    """Frequency of a joint, in a step of dt [Hz]."""
    return stiffness(world.settings, dt).joint_hertz


def spring_sag(force: float, effective_mass: float, hertz: float) -> float:
    """How far a soft constraint gives way under a force, F / (m w^2) [m]."""
    return force / (effective_mass * (2.0 * math.pi * hertz) ** 2)


def joint_gap(world: World, dt: float, pull: float, inward: float) -> float:
    """How far the joint of a body on a circle gives way, the rod through its centre [m].

    pull: force on the joint over the mass [m/s^2]; inward: v^2 / r [m/s^2]. The pull stretches the spring by
    pull / w^2. And in each h the body moves straight, v^2 h^2 / 2 r off its circle, after tension and weight have given
    it an inward speed of v^2 h / r. Of that the pass with bias leaves the part s, and adds -m bias_rate gap (m: mass
    scale, s = 1 - m: impulse scale): in the steady state h times this balances what is gained. Without softness m = 1,
    s = 0 and bias_rate = 0.2 / h.
    """
    if not is_soft(world):
        return 0.5 * inward * dt * dt / JOINT_BIAS_FACTOR
    h = dt / world.settings.substeps
    soft = stiffness(world.settings, dt).joint
    stretched = pull / (2.0 * math.pi * joint_hertz(world, dt)) ** 2
    return stretched + (0.5 - soft.impulse_scale) * inward * h / (soft.mass_scale * soft.bias_rate)


def column_sag(
    count: int, hertz: float, gravity: float, inertia: float = BOX_INERTIA, half_width: float = 0.5
) -> float:
    """How far the top of a column of equal bodies sinks, each on two points half_width off its middle [m].

    inertia: of one, in parts of its mass [m^2]. Each contact carries the weight above it; masses cancel.
    """
    arm = half_width * half_width / inertia
    pair = spring_sag(gravity * count * (count - 1) / 2.0, 2.0 / (2.0 + 2.0 * arm), hertz)
    ground = spring_sag(gravity * count, 2.0 / (1.0 + arm), STATIC_STIFFENING * hertz)
    return pair + ground


def predicted_column(
    world: World, dt: float, count: int, inertia: float = BOX_INERTIA, half_width: float = 0.5
) -> float:
    """How far the top of a column sinks with these settings [m]."""
    if not is_soft(world):
        return count * SLOP
    return column_sag(count, contact_hertz(world, dt), -world.gravity[1], inertia, half_width)


def predicted_pyramid(world: World, dt: float, base: int, spacing: float = 1.0) -> float:
    """How far the apex of a pyramid of unit boxes sinks with these settings [m]."""
    if not is_soft(world):
        return base * SLOP
    return pyramid_sag(base, spacing, contact_hertz(world, dt), -world.gravity[1])


@cache
def pyramid_sag(base: int, spacing: float, hertz: float, gravity: float) -> float:
    """How far the apex sinks on soft contacts [m]. Neighbours in a row do not press on each other."""
    return float(-pyramid(base, spacing).settle(hertz, gravity, STATIC_STIFFENING).moved[-1, 1])


def pyramid(base: int, spacing: float = 1.0) -> Structure:
    """Unit boxes of mass 1 in rows, each of one less than the row below; the apex comes last."""
    numbers: dict[tuple[int, int], int] = {}
    centers: list[tuple[float, float]] = []
    for row in range(base):
        for i in range(base - row):
            numbers[row, i] = len(centers)
            centers.append((spacing * (0.5 * row + i), row + 0.5))
    points = []
    for (row, i), box in numbers.items():
        x = centers[box][0]
        if row == 0:
            points += [Point(GROUND, box, x - 0.5, 0.0), Point(GROUND, box, x + 0.5, 0.0)]
        for below in (numbers[row - 1, i + side] for side in (0, 1) if row):
            left, right = sorted((x, centers[below][0]))
            points += [Point(below, box, right - 0.5, row), Point(below, box, left + 0.5, row)]
    count = len(centers)
    return Structure(np.array(centers), np.ones(count), np.full(count, BOX_INERTIA), points)


def predicted_sink(world: World, dt: float, structure: Structure, body: int) -> float:
    """How far a body of any structure sinks with these settings [m]."""
    if not is_soft(world):
        return SLOP * float(structure.carried(body).sum())
    rest = structure.settle(contact_hertz(world, dt), -world.gravity[1], STATIC_STIFFENING)
    return float(-rest.moved[body, 1])
