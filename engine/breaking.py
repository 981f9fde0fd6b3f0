"""Joints that break for good, when what they held with in a step, on average, is more than they bear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.islands import COARSE
from engine.records import joint_records
from engine.sleeping import touch_weights

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def break_joints(state: State, settings: Settings) -> None:
    """Takes joints that bore too much in the step that ends out of the world."""
    joints, order = state.joints.tables["joints"], state.joints.order
    force, torque = joints["break_force"][order], joints["break_torque"][order]
    breakable = order[(force >= 0.0) | (torque >= 0.0)]
    records = joint_records(state, breakable)
    inverse_dt = 1.0 / float(state.steps["dt"][0])
    forces = np.hypot(records["impulse_x"], records["impulse_y"]) * inverse_dt
    torques = np.abs(records["turn_impulse"]) * inverse_dt
    most_force, most_torque = joints["break_force"][breakable], joints["break_torque"][breakable]
    broken = ((most_force >= 0.0) & (forces > most_force)) | ((most_torque >= 0.0) & (torques > most_torque))
    for place in np.flatnonzero(broken):
        record = records[place]
        state.happened.note_broken(record["joint"], record["body1"], record["body2"], forces[place], torques[place])
        touch_weights(state, np.array([joints["body1"][breakable[place]], joints["body2"][breakable[place]]]))
        state.joints.remove(int(breakable[place]))
        state.stale = True
        state.islands.flags[COARSE] = 1  # the island may be two by now
