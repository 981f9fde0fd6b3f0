"""The prismatic joint: body2 slides along an axis of body1, and does not turn over it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import validate
from engine.joints.distance import SlideMotor
from engine.joints.fields import Hertz, Limit, Number, damping, limits_of, motor_of, place, spring_of
from engine.joints.joint import Joint, Pair, add, anchored, axis_of, checked_pair
from engine.tables import ALONG_AXIS, LINE, NO_SPRING
from engine.vec2 import Vec2, dot, rotate

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class Sliding(Joint):
    """A joint with an axis."""

    __slots__ = ()

    along = ALONG_AXIS

    @property
    def axis(self) -> Vec2:
        """Unit axis, in the world: it turns with body1."""
        part = self._part("joints")
        return Vec2(*map(float, rotate(self.body1.direction, Vec2(part["axis_x"], part["axis_y"]))))

    @property
    def translation(self) -> float:
        """How far body2's anchor is along the axis from body1's [m]."""
        a, b = self.anchors
        return float(dot(b - a, self.axis))


class SprungSlide(Sliding):
    """A joint with limits and a spring along its axis."""

    __slots__ = ()

    lower = Limit("slides", "lower", "Least translation [m]; None: any.")
    upper = Limit("slides", "upper", "Greatest translation [m]; None: any.")
    hertz = Hertz("slides", NO_SPRING, "Frequency of the spring along the axis [1/s]; None: there is none.")
    damping_ratio = Number("slides", "damping_ratio", damping, "Of that spring: 1 is critical.")
    target = Number("slides", "target", place, "Translation at which that spring rests [m].")


class PrismaticJoint(SlideMotor, SprungSlide):
    """A prismatic joint; World.create_joint_prismatic says what its numbers are."""

    __slots__ = ()

    kind = "prismatic"


def create_joint_prismatic(
    self: World,
    body1: Body,
    body2: Body,
    *,
    anchor: Pair,
    axis: Pair,
    lower: float | None = None,
    upper: float | None = None,
    hertz: float | None = None,
    damping_ratio: float = 1.0,
    target: float = 0.0,
    motor_speed: float | None = None,
    max_motor_force: float = 0.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> PrismaticJoint:
    """Lets body2 slide along an axis of body1, and turn with it.

    anchor: a point of the world [m], where the translation is 0; axis: a direction in the world, which then turns with
    body1. lower, upper: limits of the translation [m]; hertz [1/s], damping_ratio: of a spring that slides it to
    `target` [m]. motor_speed [m/s]: at which a motor drives body2 along the axis, with at most max_motor_force [N].
    collide_connected, break_force and break_torque as in create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    point = validate.vector("anchor", anchor)
    p, numbers = self.precision, PrismaticJoint
    joint = {
        **anchored(1, body1, point),
        **anchored(2, body2, point),
        **axis_of(body1, axis),
        "reference_angle": body2.angle - body1.angle,
    }
    slide = {
        **limits_of(lower, upper),
        **spring_of(p, "hertz", hertz),
        **numbers.damping_ratio.written(p, damping_ratio),
        **numbers.target.written(p, target),
        **motor_of(p, motor_speed),
        **numbers.max_motor_force.written(p, max_motor_force),
    }
    return add(
        self, PrismaticJoint, body1, body2, LINE, collide_connected, break_force, break_torque, joint, slide=slide
    )  # fmt: skip
