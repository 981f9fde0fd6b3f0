"""The revolute joint: a point of body1 and a point of body2 stay together, as if pinned. They may turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import validate
from engine.joints.fields import Hertz, Limit, MotorSpeed, Number, damping, limits_of, motor_of, place, spring_of
from engine.joints.joint import Joint, Pair, add, anchored, checked_pair
from engine.tables import NO_SPRING, POINT

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class Turning(Joint):
    """A joint that has an angle."""

    __slots__ = ()

    @property
    def angle(self) -> float:
        """Of body2 over body1, less the joint's reference angle, unwrapped [rad]."""
        return self.body2.angle - self.body1.angle - self.reference_angle

    @property
    def speed(self) -> float:
        """At which body2 turns over body1 [rad/s]."""
        return self.body2.angular_velocity - self.body1.angular_velocity

    @property
    def reference_angle(self) -> float:
        """Of body2 over body1, where the joint's own angle is 0 [rad]."""
        return float(self._part("joints")["reference_angle"])


class TurnMotor(Joint):
    """A joint whose motor turns."""

    __slots__ = ()

    motor_speed = MotorSpeed("turns", "At which the motor turns body2 over body1 [rad/s]; None: there is no motor.")
    max_motor_torque = Number("turns", "max_motor", validate.non_negative, "Of the motor [N m].")

    @property
    def motor_torque(self) -> float:
        """What the last step's motor gave body2, and body1 the other way, on average [N m]."""
        given, dt = float(self._part("turns")["motor_given"]), self.world._state.last_dt
        return given / dt if dt > 0.0 else 0.0


class RevoluteJoint(TurnMotor, Turning):
    """A revolute joint; World.create_joint_revolute says what its numbers are."""

    __slots__ = ()

    kind = "revolute"

    softness = Number("joints", "softness", validate.non_negative, "How far it gives way [1/kg].")
    lower = Limit("turns", "lower", "Least angle [rad]; None: any.")
    upper = Limit("turns", "upper", "Greatest angle [rad]; None: any.")
    hertz = Hertz("turns", NO_SPRING, "Frequency of the spring that turns [1/s]; None: there is none.")
    damping_ratio = Number("turns", "damping_ratio", damping, "Of that spring: 1 is critical.")
    target = Number("turns", "target", place, "Angle at which that spring rests [rad].")

    @property
    def bias_factor(self) -> float | None:
        """Part of the separation that a step removes, 0 to 1; None: the solver's own."""
        factor = float(self._part("joints")["bias_factor"])
        return None if factor < 0.0 else factor

    @bias_factor.setter
    def bias_factor(self, value: float | None) -> None:
        factor = -1.0 if value is None else validate.between("bias_factor", value, 0.0, 1.0)
        self._write("joints", {"bias_factor": factor})


def create_joint_revolute(
    self: World,
    body1: Body,
    body2: Body,
    *,
    anchor: Pair,
    softness: float = 0.0,
    bias_factor: float | None = None,
    lower: float | None = None,
    upper: float | None = None,
    hertz: float | None = None,
    damping_ratio: float = 1.0,
    target: float = 0.0,
    motor_speed: float | None = None,
    max_motor_torque: float = 0.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> RevoluteJoint:
    """Pins two bodies together at a point of the world.

    anchor [m]; softness [1/kg]: 0 is rigid, 1/(dt (d + dt k)) a spring k [N/m] with damper d [N s/m]; bias_factor:
    part of the separation that a step removes, dt k/(d + dt k) for that spring, the solver's own if left out: 0.2
    in sequential_impulses, that of the joint stiffness in soft_step. Angles [rad] are of body2 over body1, 0 as they
    are now. lower, upper: limits; hertz [1/s], damping_ratio: of a spring that turns them to `target`. motor_speed
    [rad/s]: at which a motor turns body2, with at most max_motor_torque [N m]; None: none. collide_connected: whether
    the two collide. break_force [N], break_torque [N m]: beyond them it breaks for good; None: never.
    """
    checked_pair(self, body1, body2)
    x, y = validate.vector("anchor", anchor)
    p, numbers = self.precision, RevoluteJoint
    joint = {
        **anchored(1, body1, (x, y)),
        **anchored(2, body2, (x, y)),
        **numbers.softness.written(p, softness),
        "bias_factor": -1.0 if bias_factor is None else validate.between("bias_factor", bias_factor, 0.0, 1.0),
        "reference_angle": body2.angle - body1.angle,
    }
    turn = {
        **limits_of(lower, upper),
        **spring_of(p, "hertz", hertz),
        **numbers.damping_ratio.written(p, damping_ratio),
        **numbers.target.written(p, target),
        **motor_of(p, motor_speed),
        **numbers.max_motor_torque.written(p, max_motor_torque),
    }
    return add(
        self, RevoluteJoint, body1, body2, POINT, collide_connected, break_force, break_torque, joint, turn
    )  # fmt: skip
