"""What an effect is: something that a scene may do without, and then pays nothing for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from engine import validate
from engine.storage import Column

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


class Property(NamedTuple):
    """A number that a body or a shape may have: a column of its own, there only while something departs from it."""

    name: str
    default: Any
    check: Callable[[str, Any], Any]
    meaning: str  # with its unit
    dtype: type = np.float64

    def column(self) -> Column:
        return Column(np.dtype(self.dtype), self.default)


@dataclass(frozen=True)
class Effect:
    """One effect. Its code runs only in a step of a world whose content or settings call for it."""

    name: str
    summary: str
    because: Callable[[State, Settings], str]  # what calls for it, "" if nothing does
    body: tuple[Property, ...] = ()  # what it lets a body have
    shape: tuple[Property, ...] = ()  # what it lets a shape have
    apply: Callable[[State, Settings], None] | None = None  # adds forces to the bodies at the start of a step
    needs: str = ""  # the effect without which its code does nothing


class EffectStatus(NamedTuple):
    """An effect in a world."""

    name: str
    called_for: bool
    because: str  # what calls for it; "" if nothing does


def number_of(count: int, total: int, things: str, have: str) -> str:
    """Such as "3 of 210 shapes have restitution"; "" for none."""
    return f"{count} of {total} {things} {'has' if count == 1 else 'have'} {have}" if count else ""


def shapes_with(name: str, have: str) -> Callable[[State, Settings], str]:
    """Called for by shapes whose column departs from the default."""

    def because(state: State, settings: Settings) -> str:
        values = state.shapes.columns.get(name)
        if values is None:
            return ""
        return number_of_shapes(state, values[state.shapes.order] != state.shapes.possible[name].default, have)

    return because


def number_of_shapes(state: State, departing: np.ndarray, have: str) -> str:
    """departing (S,): of the pieces in the order of creation; the pieces of a chain are one shape."""
    part_of = state.shapes.tables["shapes"]["part_of"][state.shapes.order]
    return number_of(len(np.unique(part_of[departing])), len(np.unique(part_of)), "shapes", have)


def bodies_with(name: str, have: str) -> Callable[[State, Settings], str]:
    """Called for by bodies whose column departs from the default."""
    return lambda state, settings: number_of(state.bodies.departing(name), state.bodies.count, "bodies", have)


def bearers(state: State, effect: str, name: str) -> np.ndarray:
    """Rows of the bodies whose property departs from its default, in the order of creation; if code is forced, of all.

    Found at the first step after content changed.
    """
    if name not in state.gathered:
        order, values = state.bodies.order, state.bodies.columns[name]
        departing = order[values[order] != state.bodies.possible[name].default]
        state.gathered[name] = order if effect in state.forced else departing
    return state.gathered[name]


def dynamic_bearers(state: State, effect: str, name: str) -> np.ndarray:
    """Those of them that a force moves."""
    key = f"{name}, dynamic"
    if key not in state.gathered:
        rows = bearers(state, effect, name)
        state.gathered[key] = rows[state.bodies.tables["motions"]["inverse_mass"][rows] > 0.0]
    return state.gathered[key]


def at_least_zero(name: str, value: Any) -> float:
    return validate.non_negative(name, value)


def at_most_one(name: str, value: Any) -> float:
    return validate.between(name, value, 0.0, 1.0)


def any_number(name: str, value: Any) -> float:
    return validate.number(name, value)
