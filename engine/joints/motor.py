"""The motor joint: drives body2 to a pose over body1, with a largest force and torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import validate
from engine.joints.fields import FAR, Most, Number, place, spring_of
from engine.joints.joint import Pair, add, checked_pair
from engine.joints.weld import Soft
from engine.tables import POINT, STIFF
from engine.vec2 import Vec2, unrotate

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


def offset_of(value: Pair) -> dict[str, float]:
    """The columns of an offset [m]."""
    x, y = validate.vector("offset", value)
    if not max(abs(x), abs(y)) <= FAR:
        raise validate.refuse("offset", value, f"of parts from {-FAR:g} to {FAR:g}")
    return {"anchor1_x": x, "anchor1_y": y}


class MotorJoint(Soft):
    """A motor joint; World.create_joint_motor says what its numbers are."""

    __slots__ = ()

    kind = "motor"

    max_force = Most("joints", "max_force", "That holds the place [N]; None: any.")
    max_torque = Most("turns", "max_spring", "That holds the angle [N m]; None: any.")
    angle = Number("turns", "target", place, "Of body2 over body1, to which it is driven [rad].")

    @property
    def offset(self) -> Vec2:
        """Place of body2's origin in the frame of body1, to which it is driven [m]."""
        part = self._part("joints")
        return Vec2(float(part["anchor1_x"]), float(part["anchor1_y"]))

    @offset.setter
    def offset(self, value: Pair) -> None:
        self._write("joints", offset_of(value))


def create_joint_motor(
    self: World,
    body1: Body,
    body2: Body,
    *,
    offset: Pair | None = None,
    angle: float | None = None,
    max_force: float | None = None,
    max_torque: float | None = None,
    linear_hertz: float | None = None,
    linear_damping_ratio: float = 1.0,
    angular_hertz: float | None = None,
    angular_damping_ratio: float = 1.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> MotorJoint:
    """Drives body2 to a pose over body1, as strongly as it may.

    offset: place of body2's origin in the frame of body1 [m]; angle of body2 over body1 [rad]: both as they are now if
    left out. max_force [N], max_torque [N m]; None: any. Frequencies [1/s] and damping ratios as in create_joint_weld;
    collide_connected, break_force and break_torque as in create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    p, numbers = self.precision, MotorJoint
    if offset is None:
        offset = unrotate(body1.direction, body2.position - body1.position)
    angle = body2.angle - body1.angle if angle is None else angle
    joint = {
        **offset_of(offset),
        **numbers.max_force.written(p, max_force),
        **numbers.linear_hertz.written(p, linear_hertz),
        **numbers.linear_damping_ratio.written(p, linear_damping_ratio),
    }
    turn = {
        **spring_of(p, "angular_hertz", angular_hertz, STIFF),
        **numbers.angular_damping_ratio.written(p, angular_damping_ratio),
        **numbers.angle.written(p, angle),
        **numbers.max_torque.written(p, max_torque),
    }
    return add(self, MotorJoint, body1, body2, POINT, collide_connected, break_force, break_torque, joint, turn)
