"""Effects that live elsewhere in the engine: joints, bodies that do not collide, events, diagnostics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.effects.effect import Effect

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def joined(state: State, settings: Settings) -> str:
    """Revolute joints."""
    count = state.joints.count
    return f"{count} revolute joint{'s' * (count != 1)}" if count else ""


def passing(state: State, settings: Settings) -> str:
    """Joints whose bodies do not collide with each other."""
    joints = state.joints.tables["joints"][state.joints.order]
    count = int(np.count_nonzero(joints["collide_connected"] == 0))
    return f"{count} joint{'s' * (count != 1)} of bodies that do not collide" if count else ""


def asked(state: State, settings: Settings) -> str:
    """Sums over all bodies are made when somebody asks, not before."""
    recent = state.diagnosed_at is not None and state.step_count - state.diagnosed_at <= 1
    return "somebody asks for energy and momentum" if recent else ""


def told(state: State, settings: Settings) -> str:
    """Arrays of what happened are made where the setting says so."""
    return "the setting tell_events" if settings.tell_events else ""


REVOLUTE = Effect("revolute joints", "bodies are pinned together", joined)
PASSING = Effect("joined without colliding", "joined bodies pass through each other", passing)
EVENTS = Effect("events", "what begins, ends, hits and moves in a step is told", told)
DIAGNOSTICS = Effect("diagnostics", "energy, momentum and overlap are summed up", asked)
