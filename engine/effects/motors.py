"""Motors of revolute joints: body2 is driven to turn at a speed of its own over body1, as hard as the motor can.

What a motor is stands in columns of the joints, which are there only while some joint has one; the solvers' part is
engine/joints/revolute_motor.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.effects.effect import Effect
from engine.storage import Column

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

REAL, FLAG = np.dtype(np.float64), np.dtype(np.int64)

MOTOR_COLUMNS = {
    "motored": Column(FLAG, 0),  # 1: the joint has a motor
    "motor_speed": Column(REAL, 0.0),  # of body2 over body1 [rad/s]
    "max_motor_torque": Column(REAL, 0.0),  # [N m]
    "motor_impulse": Column(REAL, 0.0),  # accumulated, on body2: what the next step starts from [N m s]
    "motor_given": Column(REAL, 0.0),  # what the last step gave body2 in all [N m s]
}


def motored(state: State, settings: Settings) -> str:
    """Joints with a motor speed, be the torque what it may."""
    count = state.joints.departing("motored")
    return f"{count} revolute joint{'s' * (count != 1)} with a motor" if count else ""


REVOLUTE_MOTORS = Effect(
    "revolute motors", "joints drive what they pin together round", motored, needs="revolute joints"
)
