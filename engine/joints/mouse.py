"""The mouse joint: a spring draws a point of body2 to a target, which body1 carries: most often what is static."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine import validate
from engine.joints.fields import Most, Number, damping
from engine.joints.joint import Joint, Pair, add, anchored, checked_pair
from engine.joints.weld import HeldHertz
from engine.tables import POINT
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class MouseJoint(Joint):
    """A mouse joint; World.create_joint_mouse says what its numbers are."""

    __slots__ = ()

    kind = "mouse"

    max_force = Most("joints", "max_force", "With which it draws at most [N]; None: any.")
    hertz = HeldHertz("Frequency of the spring [1/s]; None: as stiff as joints.")
    damping_ratio = Number("joints", "damping_ratio", damping, "Of that spring: 1 is critical.")

    @property
    def target(self) -> Vec2:
        """Where body2's anchor is drawn to, in the world [m]: set it to move what is held."""
        return self.anchors[0]

    @target.setter
    def target(self, value: Pair) -> None:
        self._write("joints", anchored(1, self.body1, validate.vector("target", value), "target"))


def create_joint_mouse(
    self: World,
    body1: Body,
    body2: Body,
    *,
    target: Pair,
    anchor: Pair | None = None,
    hertz: float | None = 5.0,
    damping_ratio: float = 0.7,
    max_force: float | None = None,
    collide_connected: bool = True,
    break_force: float | None = None,
    break_torque: float | None = None,
) -> MouseJoint:
    """Draws a point of body2 to a target, softly.

    target: a point of the world [m], which from now on body1 carries; anchor: the point of body2 that is held, in the
    world [m], the one at the target if left out. hertz [1/s], damping_ratio: of the spring; max_force [N]; None: any.
    collide_connected, break_force and break_torque as in create_joint_revolute.
    """
    checked_pair(self, body1, body2)
    goal = validate.vector("target", target)
    held = goal if anchor is None else validate.vector("anchor", anchor)
    p, numbers = self.precision, MouseJoint
    joint = {
        **anchored(1, body1, goal, "target"),
        **anchored(2, body2, held),
        **numbers.hertz.written(p, hertz),
        **numbers.damping_ratio.written(p, damping_ratio),
        **numbers.max_force.written(p, max_force),
    }
    return add(self, MouseJoint, body1, body2, POINT, collide_connected, break_force, break_torque, joint)
