"""The distance joint: a point of body1 and a point of body2 stay so far apart. A rod, a rope or a spring."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from engine import validate
from engine.joints.fields import FAR, Hertz, Limit, MotorSpeed, Number, damping, limits_of, motor_of, spring_of
from engine.joints.joint import Joint, Pair, add, anchored, checked_pair
from engine.tables import ALONG_WAY, NO_SPRING, NOTHING
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


def reach(name: str, value: Any) -> float:
    """A length [m]."""
    return validate.between(name, value, 0.0, FAR)


class SlideMotor(Joint):
    """A joint whose motor slides."""

    __slots__ = ()

    motor_speed = MotorSpeed("slides", "At which the motor drives body2 off body1 [m/s]; None: there is no motor.")
    max_motor_force = Number("slides", "max_motor", validate.non_negative, "Of the motor [N].")

    @property
    def motor_force(self) -> float:
        """What the last step's motor gave body2 along the slide, and body1 the other way, on average [N]."""
        given, dt = float(self._part("slides")["motor_given"]), self.world._state.last_dt
        return given / dt if dt > 0.0 else 0.0


class DistanceJoint(SlideMotor):
    """A distance joint; World.create_joint_distance says what its numbers are."""

    __slots__ = ()

    kind = "distance"
    along = ALONG_WAY

    length = Number("slides", "target", reach, "At which the rod holds and the spring rests [m].")
    lower = Limit("slides", "lower", "Least length [m]; None: any.", least=0.0)
    upper = Limit("slides", "upper", "Greatest length [m]; None: any.", least=0.0)
    hertz = Hertz(
        "slides", NO_SPRING, "Frequency of the spring [1/s]; None: no spring but a rod, or what limits leave."
    )
    damping_ratio = Number("slides", "damping_ratio", damping, "Of that spring: 1 is critical.")

    @property
    def current_length(self) -> float:
        """From anchor to anchor as they are now [m]."""
        a, b = self.anchors
        return float(((b.x - a.x) ** 2 + (b.y - a.y) ** 2) ** 0.5)


def create_joint_distance(
    self: World,
    body1: Body,
    body2: Body,
    *,
    anchor1: Pair,
    anchor2: Pair,
    length: float | None = None,
    lower: float | None = None,
    upper: float | None = None,
    hertz: float | None = None,
    damping_ratio: float = 1.0,
    motor_speed: float | None = None,
    max_motor_force: float = 0.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> DistanceJoint:
    """Holds a point of body1 and a point of body2 `length` apart: a rod, a rope or a spring.

    anchor1, anchor2: points of the world [m]; length [m]: as it is now if left out. A rod, unless hertz [1/s] makes
    it a spring of that frequency and damping_ratio, or it has limits lower and upper [m] or a motor: upper alone is a
    rope. motor_speed [m/s]: at which a motor drives them apart, with at most max_motor_force [N]. collide_connected,
    break_force and break_torque as in create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    first, second = Vec2(*validate.vector("anchor1", anchor1)), Vec2(*validate.vector("anchor2", anchor2))
    joint = {**anchored(1, body1, first, "anchor1"), **anchored(2, body2, second, "anchor2")}
    way = second - first
    p, numbers = self.precision, DistanceJoint
    length = float((way.x * way.x + way.y * way.y) ** 0.5) if length is None else length
    slide = {
        **numbers.length.written(p, length),
        **limits_of(lower, upper, least=0.0),
        **spring_of(p, "hertz", hertz),
        **numbers.damping_ratio.written(p, damping_ratio),
        **motor_of(p, motor_speed),
        **numbers.max_motor_force.written(p, max_motor_force),
    }
    return add(
        self, DistanceJoint, body1, body2, NOTHING, collide_connected, break_force, break_torque, joint, slide=slide
    )  # fmt: skip
