"""A human of eleven capsules, seen from the side: its joints have limits, and a little friction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from engine import Body, Capsule, World

DENSITY = 150.0  # [kg/m^2]: 70 kg in all
GRIP = 0.6
FRICTION = 1.5  # of its joints [N m]


class Bone(NamedTuple):
    """A capsule as it is in somebody who stands at (0, 0) and looks to the right; lengths of a human of 1.75 m [m]."""

    parent: str
    top: float  # heights of the capsule's ends
    bottom: float
    radius: float
    joint: float = 0.0  # height of the joint with the parent
    lower: float = 0.0  # its limits, counter-clockwise [rad]
    upper: float = 0.0


LEG = {
    "thigh": Bone("hip", 0.88, 0.54, 0.085, 0.92, -0.5, 2.0),
    "shank": Bone("thigh", 0.46, 0.07, 0.065, 0.5, -2.3, 0.0),
}
ARM = {
    "upper arm": Bone("chest", 1.40, 1.16, 0.055, 1.43, -1.0, 2.8),
    "forearm": Bone("upper arm", 1.09, 0.85, 0.045, 1.13, 0.0, 2.4),
}
BONES: Mapping[str, Bone] = {
    **{f"far {name}": bone for name, bone in {**LEG, **ARM}.items()},
    "hip": Bone("", 1.00, 0.94, 0.12),
    "chest": Bone("hip", 1.36, 1.16, 0.13, 1.06, -1.2, 0.4),
    "head": Bone("chest", 1.64, 1.60, 0.11, 1.48, -0.7, 0.5),
    **{f"near {name}": bone for name, bone in {**LEG, **ARM}.items()},
}
POSES: tuple[Mapping[str, float], ...] = (
    {"far thigh": 0.3, "far shank": -0.4, "near thigh": -0.2, "near shank": -0.2, "far upper arm": -0.4,
     "near upper arm": 0.5, "far forearm": 0.4, "near forearm": 0.7},
    {"far thigh": 1.2, "far shank": -1.5, "near thigh": 0.6, "near shank": -0.9, "far upper arm": 2.2,
     "near upper arm": 1.7, "far forearm": 0.5, "near forearm": 0.3, "chest": -0.4, "head": -0.2},
    {"far thigh": -0.3, "far shank": -0.9, "near thigh": 0.4, "near shank": -0.3, "far upper arm": 2.6,
     "near upper arm": -0.7, "far forearm": 0.2, "near forearm": 1.2, "chest": 0.2},
)  # fmt: skip
"""Angles of bones over their parents [rad]: walking, falling, leaping."""


class Placed(NamedTuple):
    """Where a bone is: what was at (0, height) of somebody who stands is at (x, y), turned by angle [m, rad]."""

    x: float
    y: float
    height: float
    angle: float

    def point(self, height: float) -> tuple[float, float]:
        up = height - self.height
        return self.x - up * math.sin(self.angle), self.y + up * math.cos(self.angle)


def add_human(
    world: World,
    position: tuple[float, float],
    *,
    group: int,
    angle: float = 0.0,
    pose: Mapping[str, float] = POSES[0],
    velocity: tuple[float, float] = (0.0, 0.0),
) -> list[Body]:
    """Eleven bodies and ten joints. position: of the hip [m]; group: > 0, its bones pass through each other."""
    placed: dict[str, Placed] = {}
    while len(placed) < len(BONES):
        for name, bone in BONES.items():
            if not bone.parent:
                placed[name] = Placed(*position, 0.97, angle)
            elif parent := placed.get(parent_of(name)):
                placed[name] = Placed(*parent.point(bone.joint), bone.joint, parent.angle + pose.get(name, 0.0))
    bodies = {
        name: world.create_body(
            Capsule(bone.top - bone.bottom, bone.radius),
            position=placed[name].point(0.5 * (bone.top + bone.bottom)),
            angle=placed[name].angle,
            shape_angle=0.5 * math.pi,
            density=DENSITY,
            friction=GRIP,
            velocity=velocity,
            group=-group,
        )
        for name, bone in BONES.items()
    }
    for name, bone in BONES.items():
        if bone.parent:
            bent = pose.get(name, 0.0)
            world.create_joint_revolute(
                bodies[parent_of(name)], bodies[name], anchor=placed[name].point(bone.joint),
                lower=bone.lower - bent, upper=bone.upper - bent,
                motor_speed=0.0, max_motor_torque=FRICTION, collide_connected=False,
            )  # fmt: skip
    return list(bodies.values())


def bent_too_far(world: World, first: int) -> float:
    """How far a joint of the humans is beyond its limits, at most [rad]; first: the first body of the first of them."""
    angles = world.angles[first:].reshape(-1, len(BONES))
    names = list(BONES)
    beyond = 0.0
    for k, (name, bone) in enumerate(BONES.items()):
        if bone.parent:
            bent = angles[:, k] - angles[:, names.index(parent_of(name))]
            beyond = max(beyond, float(np.maximum(bone.lower - bent, bent - bone.upper).max()))
    return beyond


def parent_of(name: str) -> str:
    """The bone that it hangs on, of the same side where there are two."""
    parent, side = BONES[name].parent, name.partition(" ")[0]
    return f"{side} {parent}" if f"{side} {parent}" in BONES else parent
