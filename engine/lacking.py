"""Effects in a world: what calls for each, and refusing what its solver lacks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from engine import validate
from engine.effects import EFFECTS, EffectStatus, Property
from engine.solvers import SOLVERS

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def effect_statuses(state: State, settings: Settings) -> tuple[EffectStatus, ...]:
    """Every effect, in the order of EFFECTS."""
    found = []
    for effect in EFFECTS:
        because = effect.because(state, settings)
        found.append(EffectStatus(effect.name, bool(because), because))
    return tuple(found)


def refuse_lacking(state: State, settings: Settings) -> None:
    """ValueError if the world calls for an effect that the solver of these settings lacks."""
    for effect in EFFECTS:
        if effect.name in SOLVERS[settings.solver].lacks and (because := effect.because(state, settings)):
            raise validate.refuse("solver", settings.solver, f"one that knows {effect.name}: {because}")


def refuse_property(settings: Settings, name: str, value: Any, item: Property) -> None:
    """ValueError if a property departs from its default and belongs to an effect that the solver lacks."""
    for effect in EFFECTS:
        lacking = item in (*effect.body, *effect.shape) and effect.name in SOLVERS[settings.solver].lacks
        if lacking and value != item.default:
            raise validate.refuse(name, value, f"{item.default} with the solver {settings.solver!r}")
