"""Magnets: every pair of bodies that have a strength pushes each other apart or together.

    F = K p1 p2 / d^2,   K = engine.constants.MAGNET_CONSTANT,   d from centre of mass to centre of mass

Equal signs repel. Both feel the same force the other way, so momentum is kept to the last bit of the sums. Closer than
CORE_RADIUS the force falls off to nothing, so that two that meet do not fling each other out of the world.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.constants import MAGNET_CONSTANT
from engine.effects.ahead import time_ahead
from engine.effects.effect import Effect, Property, any_number, bearers, number_of
from engine.effects.inverse_square import centers_ahead, over_cube
from engine.jit import kernel

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def add_magnets(rows, bodies, motions, strengths, steps):
    """Adds what each pair does to each other to the forces on these bodies, pair by pair in the order of creation."""
    places = centers_ahead(rows, bodies, motions, time_ahead(steps[0]))
    for i in range(len(rows)):
        strength = MAGNET_CONSTANT * strengths[rows[i]]
        if strength == 0.0:  # only where the code is forced
            continue
        one = bodies[rows[i]]
        for j in range(i + 1, len(rows)):
            other = bodies[rows[j]]
            x = places[j, 0] - places[i, 0]
            y = places[j, 1] - places[i, 1]
            push = strength * strengths[rows[j]] * over_cube(x, y)
            one.force_x -= push * x
            one.force_y -= push * y
            other.force_x += push * x
            other.force_y += push * y


def apply(state: State, settings: Settings) -> None:
    """Adds the forces between magnets. One that no force moves acts on others all the same."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    rows = bearers(state, MAGNETS.name, "magnet")
    add_magnets(rows, bodies, motions, state.bodies.columns["magnet"], state.steps)


def paired(state: State, settings: Settings) -> str:
    """It takes two."""
    count = state.bodies.departing("magnet")
    return number_of(count if count > 1 else 0, state.bodies.count, "bodies", "a magnet")


MAGNETS = Effect(
    "magnets",
    "bodies attract and repel each other: F = K p1 p2 / d²",
    paired,
    body=(Property("magnet", 0.0, any_number, "p in F = K p1 p2 / d²; equal signs repel"),),
    apply=apply,
)
