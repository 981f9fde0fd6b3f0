"""The wheel joint: body2 turns freely about a point that slides along an axis of body1, on a spring."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import validate
from engine.joints.fields import limits_of, motor_of, spring_of
from engine.joints.joint import Pair, add, anchored, axis_of, checked_pair
from engine.joints.prismatic import SprungSlide
from engine.joints.revolute import Turning, TurnMotor
from engine.tables import ACROSS

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class WheelJoint(TurnMotor, Turning, SprungSlide):
    """A wheel joint; World.create_joint_wheel says what its numbers are."""

    __slots__ = ()

    kind = "wheel"


def create_joint_wheel(
    self: World,
    body1: Body,
    body2: Body,
    *,
    anchor: Pair,
    axis: Pair,
    lower: float | None = None,
    upper: float | None = None,
    hertz: float | None = 1.0,
    damping_ratio: float = 0.7,
    target: float = 0.0,
    motor_speed: float | None = None,
    max_motor_torque: float = 0.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> WheelJoint:
    """Hangs a wheel, body2, on a spring along an axis of body1, the chassis.

    anchor: the wheel's middle, a point of the world [m]; axis: of the suspension, a direction in the world, which then
    turns with body1. hertz [1/s], damping_ratio: of the spring along it, which rests at `target` [m] from where the
    anchor is now; None: it slides freely between lower and upper [m]. motor_speed [rad/s]: at which a motor turns the
    wheel, with at most max_motor_torque [N m]. collide_connected, break_force and break_torque as in
    create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    point = validate.vector("anchor", anchor)
    p, numbers = self.precision, WheelJoint
    joint = {
        **anchored(1, body1, point),
        **anchored(2, body2, point),
        **axis_of(body1, axis),
        "reference_angle": body2.angle - body1.angle,
    }
    turn = {**motor_of(p, motor_speed), **numbers.max_motor_torque.written(p, max_motor_torque)}
    slide = {
        **limits_of(lower, upper),
        **spring_of(p, "hertz", hertz),
        **numbers.damping_ratio.written(p, damping_ratio),
        **numbers.target.written(p, target),
    }
    return add(self, WheelJoint, body1, body2, ACROSS, collide_connected, break_force, break_torque, joint, turn, slide)
