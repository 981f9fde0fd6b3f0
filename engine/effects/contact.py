"""Effects between shapes that touch: what the solver's contact passes may leave out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.effects.effect import (
    Effect,
    Property,
    any_number,
    at_least_zero,
    at_most_one,
    number_of_shapes,
    shapes_with,
)

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def rough(state: State, settings: Settings) -> str:
    """Friction lies in the table of shapes, for nearly all have it."""
    friction = state.shapes.tables["shapes"]["friction"][state.shapes.order]
    return number_of_shapes(state, friction != 0.0, "friction")


FRICTION = Effect("friction", "shapes that touch hold each other back sideways", rough)

RESTITUTION = Effect(
    "restitution",
    "shapes bounce",
    shapes_with("restitution", "restitution"),
    shape=(Property("restitution", 0.0, at_most_one, "part of the speed of approach that comes back, 0 to 1"),),
)

ROLLING_RESISTANCE = Effect(
    "rolling resistance",
    "round shapes that roll come to rest",
    shapes_with("rolling_resistance", "rolling resistance"),
    shape=(Property("rolling_resistance", 0.0, at_least_zero, "coefficient: resisting moment / (radius x load)"),),
)

CONVEYOR = Effect(
    "conveyor",
    "surfaces run like the belt of a conveyor",
    shapes_with("tangent_speed", "a tangent speed"),
    shape=(Property("tangent_speed", 0.0, any_number, "of the surface, clockwise round the shape [m/s]"),),
)
