"""The weld joint: body2 neither moves nor turns over body1, or hardly, as springs let it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from engine import validate
from engine.joints.fields import Hertz, Number, checked, damping, spring_of
from engine.joints.joint import Joint, Pair, add, anchored, checked_pair
from engine.joints.revolute import Turning
from engine.tables import POINT, STIFF

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class HeldHertz(Number):
    """The frequency of the spring that holds a point; None: it is as stiff as joints are."""

    def __init__(self, doc: str) -> None:
        super().__init__("joints", "hertz", validate.positive, doc)

    def read(self, joint: Joint) -> float | None:
        return super().read(joint) or None

    def written(self, precision: str, value: Any) -> dict[str, Any]:
        return {"hertz": 0.0 if value is None else checked(precision, self.name, value, validate.positive)}


class Soft(Joint):
    """A joint whose point and angle springs may hold."""

    __slots__ = ()

    linear_hertz = HeldHertz("Frequency of the spring that holds the point [1/s]; None: as stiff as joints.")
    linear_damping_ratio = Number("joints", "damping_ratio", damping, "Of that spring: 1 is critical.")
    angular_hertz = Hertz(
        "turns", STIFF, "Frequency of the spring that holds the angle [1/s]; None: as stiff as joints."
    )
    angular_damping_ratio = Number("turns", "damping_ratio", damping, "Of that spring: 1 is critical.")


class WeldJoint(Soft, Turning):
    """A weld joint; World.create_joint_weld says what its numbers are."""

    __slots__ = ()

    kind = "weld"


def create_joint_weld(
    self: World,
    body1: Body,
    body2: Body,
    *,
    anchor: Pair,
    linear_hertz: float | None = None,
    linear_damping_ratio: float = 1.0,
    angular_hertz: float | None = None,
    angular_damping_ratio: float = 1.0,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> WeldJoint:
    """Holds body2 to body1 as it is now.

    anchor: a point of the world [m]. linear_hertz, angular_hertz [1/s] with their damping ratios: springs that hold the
    point, and the angle; as stiff as joints are if left out. collide_connected, break_force and break_torque as in
    create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    point = validate.vector("anchor", anchor)
    p, numbers = self.precision, WeldJoint
    joint = {
        **anchored(1, body1, point),
        **anchored(2, body2, point),
        **numbers.linear_hertz.written(p, linear_hertz),
        **numbers.linear_damping_ratio.written(p, linear_damping_ratio),
        "reference_angle": body2.angle - body1.angle,
    }
    turn = {
        **spring_of(p, "angular_hertz", angular_hertz, STIFF),
        **numbers.angular_damping_ratio.written(p, angular_damping_ratio),
    }
    return add(self, WeldJoint, body1, body2, POINT, collide_connected, break_force, break_torque, joint, turn)
