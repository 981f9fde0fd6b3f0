"""Which joints can be solved side by side, and which rows they have: read off the content when it changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.colouring import COLOURS, Layout, colour_joints
from engine.tables import ALONG_NOTHING, HELD, JOINT_KINDS, POINT, STIFF

if TYPE_CHECKING:
    from engine.state import State

ROWS = ("turns", "slides", "lines", "points")  # in the order of soft_step/schedule.py
PARTS = ("joint springs", "joint motors", "joint limits")


def joins(effects: frozenset[str]) -> bool:
    """Whether any joint does anything."""
    return any(f"{kind} joints" in effects for kind in JOINT_KINDS if kind != "filter")


class JointLayout:
    """Joints by colour, for each kind of rows that they have."""

    def __init__(self) -> None:
        self.layouts = {name: Layout() for name in ROWS}
        self.slots = {name: np.empty(0, np.int32) for name in ROWS}  # which joint is in which place of which block
        self.called_for: frozenset[str] = frozenset()  # kinds of rows that any joint has, or whose code is forced
        self.firsts = np.zeros((len(ROWS), COLOURS + 2), np.int64)  # the first block of each colour, and the end
        self.stages = 0  # of a pass: colours that have any block
        self.soft = False  # whether a point gives way otherwise than most

    def blocks(self, name: str) -> int:
        return self.layouts[name].blocks

    def arrange(self, state: State, order: np.ndarray) -> None:
        """Takes up the joints in these rows as they are, those that are solved."""
        joints = state.joints.tables["joints"]
        turns, slides = state.joints.tables["turns"], state.joints.tables["slides"]
        nobody = len(state.bodies.tables["bodies"]) - 1
        joints["body1"][-1] = joints["body2"][-1] = nobody
        active = np.array([f"{kind} joints" in state.effects for kind in JOINT_KINDS])
        order = order[active[joints["kind"][order]]]
        held = joints["held"][order]
        has = {
            "turns": turns["along"][order] != ALONG_NOTHING,
            "slides": slides["along"][order] != ALONG_NOTHING,
            "lines": held > POINT,
            "points": held == POINT,
        }
        if state.chains is not None:
            leave_chains(has, np.isin(order, state.chains.plan.order), turns[order], slides[order])
        colours = np.empty(len(order), np.int32)
        taken = np.zeros(nobody + 1, np.int64)
        colour_joints(joints, order, state.bodies.tables["motions"], taken, colours)
        rows = np.append(order, len(joints) - 1)  # -1, nothing, is the last
        for name, layout in self.layouts.items():
            layout.arrange(np.where(has[name], colours, -1).astype(np.int32), state.lanes, -1)
            self.slots[name] = rows[layout.slots].astype(np.int32)
        self.firsts = np.stack([layout.firsts for layout in self.layouts.values()])
        self.stages = int((np.diff(self.firsts, axis=1) > 0).sum())
        forced = state.forced & {*PARTS, *(f"{kind} joints" for kind in JOINT_KINDS)}
        self.called_for = frozenset(name for name in ROWS if has[name].any() or forced)
        points = joints[order[has["points"]]]
        own = (points["softness"] > 0.0) | (points["hertz"] > 0.0) | (points["bias_factor"] >= 0.0)
        self.soft = bool(own.any() or (points["max_force"] >= 0.0).any() or forced)


def leave_chains(has: dict[str, np.ndarray], chained: np.ndarray, turns: np.ndarray, slides: np.ndarray) -> None:
    """What is solved at once is not visited one by one: all that is rigid."""
    for name in ("lines", "points"):
        has[name] &= ~chained
    has["turns"] &= ~(chained & (turns["spring"] == STIFF))
    has["slides"] &= ~(chained & (slides["spring"] == STIFF))


assert HELD.index("point") == POINT
