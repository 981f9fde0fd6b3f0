"""What several of the scenes measure and build: gaps of joints, rows of links."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine import Body, RevoluteJoint, World
from engine.tables import REVOLUTE, WELD
from sandbox.scenes.criterion import Criterion, Limit

Point = tuple[float, float]


def gap(world: World) -> float:
    """The farthest that the anchors of a joint that holds a point are apart [m]."""
    joints = world.joint_records()
    joints = joints[(joints["kind"] == REVOLUTE) | (joints["kind"] == WELD)]
    return float(np.hypot(joints["x2"] - joints["x1"], joints["y2"] - joints["y1"]).max(initial=0.0))


def gaps(after: float, at_most: Limit) -> Criterion:
    """That joints hold together, from the first step on."""
    return Criterion("a joint's anchors are apart by", gap, unit="m", after=after, at_most=at_most, throughout=True)


def turned(world: World, index: int = 0) -> float:
    """Angle of a revolute joint, by its place among the joints [rad]."""
    joint = world.joints[index]
    assert isinstance(joint, RevoluteJoint)
    return joint.angle


def between(first: Point, last: Point, count: int) -> list[Point]:
    """`count` + 1 points from first to last."""
    return list(
        zip(
            np.linspace(first[0], last[0], count + 1).tolist(),
            np.linspace(first[1], last[1], count + 1).tolist(),
            strict=True,
        )
    )


def hanging(first: Point, last: Point, sag: float, count: int) -> list[Point]:
    """`count` + 1 points on a parabola that hangs so deep, equally far from each other along x."""
    points = between(first, last, count)
    return [(x, y - 4.0 * sag * (k / count) * (1.0 - k / count)) for k, (x, y) in enumerate(points)]


def pin(world: World, bodies: Sequence[Body], points: Sequence[Point], **joint: float | bool | None) -> None:
    """A revolute joint between each body and the next, at one of the points after the other."""
    for one, other, point in zip(bodies[:-1], bodies[1:], points, strict=True):
        world.create_joint_revolute(one, other, anchor=point, **joint)  # type: ignore[arg-type]
