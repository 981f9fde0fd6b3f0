"""The motor of a revolute joint: an impulse that turns, w2 - w1 = motor speed, |P_m| <= max motor torque x time.

With the effective mass 1 / (1/I1 + 1/I2), the point where the joint holds taken for free: the joint's own constraint
comes after it in every pass, and both agree as the passes go on. Both solvers use it, with the time of a step or of a
substep. A joint without a motor has neither mass nor limit, so it gives nothing.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from engine.jit import kernel
from engine.lanes import clamp, const, over
from engine.tables import REALS, empty

if TYPE_CHECKING:
    from engine.state import State


@cache
def motor_dtype(precision: str) -> np.dtype:
    """What a pass needs of a motor: a row for each joint, in the order of creation, made afresh each step."""
    real = REALS[precision]
    return np.dtype(
        [
            ("speed", real),  # of body2 over body1 [rad/s]
            ("mass", real),  # 1 / (1/I1 + 1/I2) [kg m^2]
            ("limit", real),  # of the impulse: torque times the time of a pass [N m s]
            ("impulse", real),  # accumulated, on body2 [N m s]
            ("given", real),  # in all substeps [N m s]
        ]
    )


@kernel
def prepare(joints, order, motions, motored, speeds, torques, impulses, motors, steps):
    """Writes the motors' rows; the columns of joints are those of engine/effects/motors.py."""
    step = steps[0]
    for rank in range(len(order)):
        joint, motor = order[rank], motors[rank]
        i1 = motions[joints[joint].body1].inverse_inertia
        i2 = motions[joints[joint].body2].inverse_inertia
        motor.speed = const(speeds[joint], i1)
        motor.mass = const(0.0, i1)
        motor.limit = const(0.0, i1)
        if motored[joint] != 0:
            motor.mass = over(const(1.0, i1), i1 + i2)
            motor.limit = const(torques[joint], i1) * step.h
        motor.impulse = const(impulses[joint], i1) * step.carried
        motor.given = const(0.0, i1)


@kernel
def change(spin, motor_speed, mass, impulse, limit):
    """The impulse to add so that the bodies turn at the motor's speed, as far as it is strong enough [N m s]."""
    return clamp(impulse - mass * (spin - motor_speed), -limit, limit) - impulse


@kernel
def drive(motor, motion1, motion2, mover1, mover2):
    """One pass of one motor. motions: with inverse inertias; movers: with spins."""
    turn = change(mover2.w - mover1.w, motor.speed, motor.mass, motor.impulse, motor.limit)
    motor.impulse += turn
    mover1.w -= motion1.inverse_inertia * turn
    mover2.w += motion2.inverse_inertia * turn


@kernel
def start(motor, motion1, motion2, mover1, mover2):
    """Gives the bodies what the motor gave in the substep, or step, before."""
    mover1.w -= motion1.inverse_inertia * motor.impulse
    mover2.w += motion2.inverse_inertia * motor.impulse


@kernel
def store(order, motors, impulses, given, steps):
    """Keeps the impulses, as for a whole step, and what was given."""
    parts = steps[0].parts
    for rank in range(len(order)):
        impulses[order[rank]] = motors[rank].impulse * parts
        given[order[rank]] = motors[rank].given


def begin(state: State) -> np.ndarray | None:
    """The table of motors for a step, one row a joint; None where no joint has one."""
    if state.active_joints is None or "revolute motors" not in state.effects:
        return None
    columns, motions = state.joints, state.bodies.tables["motions"]
    motors = state.scratch.get("motors")
    if motors is None or len(motors) < columns.count:
        motors = state.scratch["motors"] = empty(2 * columns.count, motor_dtype(state.precision))
    prepare(
        state.active_joints, columns.order, motions, columns.ensure("motored"), columns.ensure("motor_speed"),
        columns.ensure("max_motor_torque"), columns.ensure("motor_impulse"), motors, state.steps,
    )  # fmt: skip
    return motors


def end(state: State, motors: np.ndarray | None) -> None:
    """Keeps what the motors gave."""
    if motors is not None:
        columns = state.joints
        store(columns.order, motors, columns.ensure("motor_impulse"), columns.ensure("motor_given"), state.steps)
