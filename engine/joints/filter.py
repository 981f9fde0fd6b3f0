"""The filter joint: two bodies that do not collide with each other, and are otherwise free."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.joints.joint import Joint, add, checked_pair
from engine.tables import NOTHING

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class FilterJoint(Joint):
    """A filter joint: it holds nothing, and no force breaks it."""

    __slots__ = ()

    kind = "filter"


def create_joint_filter(self: World, body1: Body, body2: Body) -> FilterJoint:
    """Lets two bodies pass through each other, as long as the joint lives."""
    checked_pair(self, body1, body2)
    return add(self, FilterJoint, body1, body2, NOTHING, False, None, None, {})
