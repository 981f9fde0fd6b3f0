"""Sleeping, as an effect: what calls for it, and which bodies never sleep. What it does: engine/sleeping.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine import validate
from engine.effects.drag import WIND
from engine.effects.effect import Effect, Property
from engine.effects.magnets import MAGNETS
from engine.effects.point_gravity import POINT_GRAVITY
from engine.tables import DYNAMIC

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

SOLVERS = ("soft_step", "xpbd", "avbd")  # those that know it


def resting(state: State, settings: Settings) -> str:
    """The setting calls for it, where there is something that may rest."""
    order = state.bodies.order
    count = int(np.count_nonzero(state.bodies.tables["bodies"]["kind"][order] == DYNAMIC))
    if not settings.sleeping or settings.solver not in SOLVERS or count == 0:
        return ""
    return f"what lies still may sleep: {state.bodies.departing('asleep')} of {count} bodies do"


def restless_rows(state: State, settings: Settings) -> np.ndarray:
    """(rows of bodies,) uint8: 1 for those that never sleep as content and settings are."""
    columns, count = state.bodies.columns, len(state.bodies.tables["bodies"])
    restless = np.zeros(count, np.bool_)
    if "can_sleep" in columns:
        restless |= ~columns["can_sleep"]
    if MAGNETS.because(state, settings):
        restless |= columns["magnet"] != 0.0
    if WIND.because(state, settings):
        restless |= columns["drag"] != 0.0
    if POINT_GRAVITY.because(state, settings):
        restless[:] = True
    order, joints = state.joints.order, state.joints.tables["joints"]
    for part in (state.joints.tables["turns"], state.joints.tables["slides"]):
        driven = order[(part["motored"][order] != 0) & (part["motor_speed"][order] != 0.0)]  # else it is a brake
        restless[joints["body1"][driven]] = restless[joints["body2"][driven]] = True
    return restless.astype(np.uint8)


SLEEPING = Effect(
    "sleeping",
    "what lies still costs nothing until something wakes it",
    resting,
    body=(Property("can_sleep", True, validate.switch, "whether it may fall asleep", np.bool_),),
)
