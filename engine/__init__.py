"""tumble's engine: rigid bodies in the plane. Start reading at engine/world.py."""

from engine.bodies import Body
from engine.broad_phase import BROAD_PHASES
from engine.diagnostics import Diagnostics
from engine.effects import EFFECTS, EffectStatus
from engine.effects.fluid import Fluid
from engine.errors import StepError, TooLarge
from engine.events import BODY_EVENT, BROKEN_EVENT, HIT_EVENT, MOVED_EVENT, TOUCH_EVENT, Events
from engine.joints import (
    DistanceJoint,
    FilterJoint,
    Joint,
    MotorJoint,
    MouseJoint,
    PrismaticJoint,
    RevoluteJoint,
    WeldJoint,
    WheelJoint,
)
from engine.records import Arbiter, Contact
from engine.settings import Settings
from engine.shape_handle import ShapeHandle
from engine.shapes import SHAPE_KINDS, SHAPES, Box, Capsule, Chain, Circle, Polygon, Segment, Shape
from engine.snapshot import Snapshot
from engine.solvers import SOLVERS
from engine.stages import STAGES
from engine.tables import BODY_KINDS, CONTACT_RECORD, JOINT_KINDS, JOINT_RECORD
from engine.vec2 import Vec2
from engine.world import World

__all__ = [
    "BODY_EVENT",
    "BODY_KINDS",
    "BROAD_PHASES",
    "BROKEN_EVENT",
    "CONTACT_RECORD",
    "EFFECTS",
    "HIT_EVENT",
    "JOINT_KINDS",
    "JOINT_RECORD",
    "MOVED_EVENT",
    "SHAPES",
    "SHAPE_KINDS",
    "SOLVERS",
    "STAGES",
    "TOUCH_EVENT",
    "Arbiter",
    "Body",
    "Box",
    "Capsule",
    "Chain",
    "Circle",
    "Contact",
    "Diagnostics",
    "DistanceJoint",
    "EffectStatus",
    "Events",
    "FilterJoint",
    "Fluid",
    "Joint",
    "MotorJoint",
    "MouseJoint",
    "Polygon",
    "PrismaticJoint",
    "RevoluteJoint",
    "Segment",
    "Settings",
    "Shape",
    "ShapeHandle",
    "Snapshot",
    "StepError",
    "TooLarge",
    "Vec2",
    "WeldJoint",
    "WheelJoint",
    "World",
]
