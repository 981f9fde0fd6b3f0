"""Point gravity: bodies that all others fall towards, such as planets.

    a = mu / d^2,   mu = G x mass of the one that attracts [m^3/s^2],   d from centre of mass to centre of mass

The one that attracts feels nothing of it, unless the others attract too: with mu in proportion to the masses, action
and reaction are equal. Static and kinematic bodies may attract. Closer than CORE_RADIUS the pull falls off to nothing,
as inside a uniform ball.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.effects.ahead import time_ahead
from engine.effects.effect import Effect, Property, any_number, bearers, bodies_with
from engine.effects.inverse_square import centers_ahead, over_cube
from engine.jit import kernel

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


@kernel
def add_attraction(rows, dynamic, bodies, motions, attractions, steps):
    """Adds what pulls dynamic bodies towards those in `rows` to the forces on them, one of those after the other."""
    time = time_ahead(steps[0])
    sources = centers_ahead(rows, bodies, motions, time)
    places = centers_ahead(dynamic, bodies, motions, time)
    for i in range(len(rows)):
        attraction = attractions[rows[i]]
        if attraction == 0.0:  # only where the code is forced
            continue
        for j in range(len(dynamic)):  # its own pull on itself is nothing, for the way there is
            body = bodies[dynamic[j]]
            x = sources[i, 0] - places[j, 0]
            y = sources[i, 1] - places[j, 1]
            pull = attraction * body.mass * over_cube(x, y)
            body.force_x += pull * x
            body.force_y += pull * y


def apply(state: State, settings: Settings) -> None:
    """Adds the pull of all that attracts."""
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    rows = bearers(state, POINT_GRAVITY.name, "attraction")
    add_attraction(rows, state.dynamic, bodies, motions, state.bodies.columns["attraction"], state.steps)


POINT_GRAVITY = Effect(
    "point gravity",
    "bodies fall towards other bodies: a = mu / d²",
    bodies_with("attraction", "attraction"),
    body=(Property("attraction", 0.0, any_number, "mu in a = mu / d², of all others towards it [m³/s²]"),),
    apply=apply,
)
