"""Drag of the air, and wind: a force against the motion of a body through the air, as the square of its speed.

    F = -c |u| u,   u = v - wind,   c = 1/2 (density of the air) x (drag coefficient) x (width)   [kg/m]

The force is held for the whole step, so that it takes the part z = dt c |u| / m of the speed away. Beyond z = 1 it
would turn the body round, and beyond z = 2 make it faster than it was. So it takes this part of the speed:

    z             while z <= 1/2: the law as it stands
    1 - 1/(4 z)   beyond: what is left is 1/(4 z) of the speed, never less than nothing

The two meet with the same slope, and of two bodies the one that was faster stays it. While z <= 1/2 a body that hangs,
leans or falls at an even speed feels the exact law: c v^2 = m g holds at the exact terminal speed sqrt(m g / c).
v / (1 + z), exact for a body that nothing else acts on, misses that by dt g / 2. The price is an error of first
order while the speed changes, as the time step has it everywhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.effects.effect import Effect, Property, at_least_zero, bodies_with, dynamic_bearers
from engine.jit import kernel

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def add_drag(rows, bodies, motions, coefficients, wind, steps):
    """Adds drag to the forces on these bodies. wind: its velocity (x, y) [m/s], None where it is not called for."""
    dt = np.float64(steps[0].dt)
    for k in range(len(rows)):
        body = bodies[rows[k]]
        motion = motions[rows[k]]
        ux = np.float64(motion.vx)
        uy = np.float64(motion.vy)
        if wind is not None:
            ux -= wind[0]
            uy -= wind[1]
        pull = coefficients[rows[k]] * np.sqrt(ux * ux + uy * uy)  # [kg/s]
        part = dt * pull / body.mass
        if part > 0.5:
            pull *= (1.0 - 0.25 / part) / part
        body.force_x -= pull * ux
        body.force_y -= pull * uy


def apply(state: State, settings: Settings) -> None:
    """Adds drag, in the wind if there is any."""
    rows = dynamic_bearers(state, DRAG.name, "drag")
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    wind = settings.wind if WIND.name in state.effects else None
    add_drag(rows, bodies, motions, state.bodies.columns["drag"], wind, state.steps)


def blowing(state: State, settings: Settings) -> str:
    """Wind moves what has drag."""
    x, y = settings.wind
    caught = state.bodies.departing("drag")
    if not caught or (x == 0.0 and y == 0.0):
        return ""
    return f"wind of ({x:g}, {y:g}) m/s on {caught} of {state.bodies.count} bodies"


DRAG = Effect(
    "drag",
    "the air holds back what is fast: F = -c |v| v",
    bodies_with("drag", "drag"),
    body=(Property("drag", 0.0, at_least_zero, "c in F = -c |v| v [kg/m]"),),
    apply=apply,
)

WIND = Effect("wind", "the air takes along what has drag", blowing, needs="drag")
