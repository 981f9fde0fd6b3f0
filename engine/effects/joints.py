"""What joints call for: each kind, and the springs, motors and limits that some have."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from engine.effects.effect import Effect
from engine.tables import JOINT_KINDS, NO_SPRING

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

SUMMARIES = {
    "revolute": "bodies are pinned together",
    "distance": "rods, ropes and springs between two points",
    "prismatic": "bodies slide along an axis of another",
    "weld": "bodies are held together as one, or nearly",
    "wheel": "wheels on springs",
    "motor": "bodies are driven to a pose over another",
    "mouse": "bodies are drawn to a point",
    "filter": "pairs of bodies that do not collide",
}


def column(state: State, name: str, table: str = "joints") -> np.ndarray:
    """A field of the living joints, in the order of creation: a copy."""
    return state.joints.tables[table][name][state.joints.order]


def number_of_joints(count: int, what: str) -> str:
    return f"{count} {what.format(s='s' * (count != 1))}" if count else ""


def of_kind(kind: str) -> Callable[[State, Settings], str]:
    """Called for by joints of that kind."""

    def because(state: State, settings: Settings) -> str:
        if not state.joints.count:
            return ""
        count = int(np.count_nonzero(column(state, "kind") == JOINT_KINDS.index(kind)))
        return number_of_joints(count, kind + " joint{s}")

    return because


def with_part(field: str, nothing: int, what: str) -> Callable[[State, Settings], str]:
    """Called for by turns or slides that have it."""

    def because(state: State, settings: Settings) -> str:
        if not state.joints.count:
            return ""
        has = [column(state, field, name) != nothing for name in ("turns", "slides")]
        return number_of_joints(int(np.count_nonzero(has[0] | has[1])), "joint{s} with " + what)

    return because


def passing(state: State, settings: Settings) -> str:
    """Joints whose bodies do not collide with each other."""
    count = int(np.count_nonzero(column(state, "collide_connected") == 0)) if state.joints.count else 0
    return number_of_joints(count, "joint{s} of bodies that do not collide")


def breaking(state: State, settings: Settings) -> str:
    """Joints that a force or a torque breaks."""
    if not state.joints.count:
        return ""
    may = (column(state, "break_force") >= 0.0) | (column(state, "break_torque") >= 0.0)
    return number_of_joints(int(np.count_nonzero(may)), "joint{s} that may break")


def chained(state: State, settings: Settings) -> str:
    """Joints that would give way too far if they were visited one by one, see soft_step/direct/choose.py."""
    if state.chains is None or not state.joints.count:
        return ""
    islands = state.chains.count
    return f"{len(state.chains.plan.order)} joints in {islands} island{'s' * (islands != 1)} that would give way"


KINDS = tuple(Effect(f"{kind} joints", SUMMARIES[kind], of_kind(kind)) for kind in JOINT_KINDS)
JOINT_SPRINGS = Effect(
    "joint springs", "springs, soft or stiff, where joints turn or slide", with_part("spring", NO_SPRING, "a spring"),
    needs="revolute joints",
)  # fmt: skip
JOINT_MOTORS = Effect(
    "joint motors", "joints drive what they join", with_part("motored", 0, "a motor"), needs="revolute joints"
)
JOINT_LIMITS = Effect(
    "joint limits", "joints turn or slide so far and no further", with_part("limited", 0, "limits"),
    needs="revolute joints",
)  # fmt: skip
BREAKING = Effect("breaking joints", "joints give way for good beyond a force or torque", breaking)
CHAINS = Effect("chains", "islands of joints are solved at once", chained)
PASSING = Effect("joined without colliding", "joined bodies pass through each other", passing)
