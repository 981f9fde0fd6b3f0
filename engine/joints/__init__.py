"""Joints: one file a kind, with the handle that a user holds and the method of World that makes it.

A kind says what it holds, a point, a line or nothing (tables.py, HELD), and what acts in the directions that it leaves
free: springs, motors and limits, as its bodies turn or slide against each other. Solvers know these rows, not kinds:
engine/solvers/soft_step/joints. A further kind is one file here, its name in JOINT_KINDS and one line in KINDS.
"""

from __future__ import annotations

from engine.joints.distance import DistanceJoint, create_joint_distance
from engine.joints.filter import FilterJoint, create_joint_filter
from engine.joints.joint import Joint
from engine.joints.motor import MotorJoint, create_joint_motor
from engine.joints.mouse import MouseJoint, create_joint_mouse
from engine.joints.prismatic import PrismaticJoint, create_joint_prismatic
from engine.joints.revolute import RevoluteJoint, create_joint_revolute
from engine.joints.weld import WeldJoint, create_joint_weld
from engine.joints.wheel import WheelJoint, create_joint_wheel
from engine.tables import JOINT_KINDS

KINDS: tuple[type[Joint], ...] = (
    RevoluteJoint, DistanceJoint, PrismaticJoint, WeldJoint, WheelJoint, MotorJoint, MouseJoint, FilterJoint,
)  # fmt: skip
assert tuple(kind.kind for kind in KINDS) == JOINT_KINDS


class Joining:
    """How joints are made, as methods of the world."""

    create_joint_revolute = create_joint_revolute
    create_joint_distance = create_joint_distance
    create_joint_prismatic = create_joint_prismatic
    create_joint_weld = create_joint_weld
    create_joint_wheel = create_joint_wheel
    create_joint_motor = create_joint_motor
    create_joint_mouse = create_joint_mouse
    create_joint_filter = create_joint_filter


__all__ = [
    "KINDS", "DistanceJoint", "FilterJoint", "Joining", "Joint", "MotorJoint", "MouseJoint", "PrismaticJoint",
    "RevoluteJoint", "WeldJoint", "WheelJoint",
]  # fmt: skip
