"""Effects on how a single body moves: gravity and damping, part of the velocity update."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.effects.effect import Effect, Property, any_number, at_least_zero, bodies_with

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def heavy(state: State, settings: Settings) -> str:
    """Gravity pulls where it is not zero."""
    x, y = settings.gravity
    return f"gravity is ({x:g}, {y:g}) m/s²" if x != 0.0 or y != 0.0 else ""


GRAVITY = Effect("gravity", "every body falls", heavy)

GRAVITY_SCALE = Effect(
    "gravity scale",
    "bodies fall more or less than others",
    bodies_with("gravity_scale", "a gravity scale"),
    body=(Property("gravity_scale", 1.0, any_number, "part of the world's gravity that it feels"),),
)

LINEAR_DAMPING = Effect(
    "linear damping",
    "bodies lose speed everywhere: dv/dt = -c v",
    bodies_with("linear_damping", "linear damping"),
    body=(Property("linear_damping", 0.0, at_least_zero, "c in dv/dt = -c v [1/s]"),),
)

ANGULAR_DAMPING = Effect(
    "angular damping",
    "bodies lose spin everywhere: dw/dt = -c w",
    bodies_with("angular_damping", "angular damping"),
    body=(Property("angular_damping", 0.0, at_least_zero, "c in dw/dt = -c w [1/s]"),),
)
