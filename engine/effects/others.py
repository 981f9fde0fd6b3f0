"""Effects that live elsewhere in the engine: events, diagnostics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.effects.effect import Effect

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def asked(state: State, settings: Settings) -> str:
    """Sums over all bodies are made when somebody asks, not before."""
    recent = state.diagnosed_at is not None and state.step_count - state.diagnosed_at <= 1
    return "somebody asks for energy and momentum" if recent else ""


def told(state: State, settings: Settings) -> str:
    """Arrays of what happened are made where the setting says so."""
    return "the setting tell_events" if settings.tell_events else ""


EVENTS = Effect("events", "what begins, ends, hits and moves in a step is told", told)
DIAGNOSTICS = Effect("diagnostics", "energy, momentum and overlap are summed up", asked)
