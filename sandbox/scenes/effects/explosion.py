"""An explosion pushes what faces it."""

from __future__ import annotations

import math

import numpy as np

from engine import Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.registry import scene

RINGS = (3.0, 5.0, 7.0, 9.0)  # distances [m]
ON_EACH = 8
RADIUS = 0.4  # of a disc [m]
REACH, FALLOFF = 4.0, 4.0  # all of the impulse so far, and then less and less of it [m]
IMPULSE = 4.0  # for each metre that faces it [N s/m]


def speed(distance: float) -> float:
    """What a disc of 1 kg there gets: the impulse, its width, and what is left of it on its near side [m/s]."""
    part = (REACH + FALLOFF - (distance - RADIUS)) / FALLOFF
    return IMPULSE * 2.0 * RADIUS * min(max(part, 0.0), 1.0)


@scene(
    "Effects/Explosion",
    shows=Criterion(
        "a disc's speed differs from impulse x width / mass by",
        lambda world: float(np.abs(np.hypot(*world.velocities.T) - np.repeat(list(map(speed, RINGS)), ON_EACH)).max()),
        unit="m/s",
        after=1.0,
        at_most=1e-5,
    ),
    gravity=(0.0, 0.0),
    view=(0.0, 0.0, 26.0),
)
def explosion(world: World) -> None:
    """Discs in four rings, just after the bang: the first ring got all of it, the last one nothing."""
    for ring, distance in enumerate(RINGS):
        for k in range(ON_EACH):
            turn = 2.0 * math.pi * (k + 0.25 * ring) / ON_EACH
            place = (distance * math.cos(turn), distance * math.sin(turn))
            world.create_body(Circle(RADIUS), position=place, mass=1.0)
    world.explode((0.0, 0.0), radius=REACH, falloff=FALLOFF, impulse=IMPULSE)
