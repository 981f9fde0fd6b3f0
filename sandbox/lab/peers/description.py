"""A world as another engine is told it: bodies with their shapes, and joints, read off the tables all at once.

Handles would do, but ask the tables for one number at a time: a scene of 20,000 bodies would take minutes to copy.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from engine import BODY_KINDS, SHAPE_KINDS, Chain, RevoluteJoint, World
from engine.effects import BODY_PROPERTIES, SHAPE_PROPERTIES
from sandbox.lab.peers.protocol import CannotMirror

BOX, CIRCLE, CAPSULE, POLYGON, SEGMENT, CHAIN = (
    SHAPE_KINDS.index(name) for name in ("box", "circle", "capsule", "polygon", "segment", "chain")
)
LINES = ("segment", "chain")

Point = tuple[float, float]


class Outline(NamedTuple):
    """One shape of a body, in the body's frame; a chain is one, however many pieces it has."""

    kind: str  # of SHAPE_KINDS
    points: list[list[float]]  # corners counter-clockwise, both ends, or the centre [m]; a chain's as ours go
    radius: float  # everything this near to the points' figure belongs to it [m]
    half: Point  # of a box: half its width and height [m]
    place: tuple[float, float, float]  # of its own frame: x, y [m], angle [rad]
    closed: bool  # a chain: its last point is joined with the first
    friction: float
    restitution: float
    rolling_resistance: float
    tangent_speed: float  # clockwise round the shape [m/s]
    category: int
    mask: int
    group: int


class BodyDescription(NamedTuple):
    """A body. mass [kg] and inertia about its centre [kg m^2] are infinite where no impulse changes the motion."""

    serial: int
    kind: str
    position: Point  # of its origin [m]
    angle: float  # [rad]
    velocity: Point  # of its centre of mass [m/s]
    angular_velocity: float
    mass: float
    inertia: float
    center: Point  # of mass, in the body's frame [m]
    linear_damping: float
    angular_damping: float
    gravity_scale: float
    outlines: list[Outline]


class JointDescription(NamedTuple):
    """A revolute joint between two bodies, told by their places in the list of bodies."""

    serial: int
    body1: int
    body2: int
    anchor1: Point  # in the frame of body1 [m]
    anchor2: Point
    softness: float  # [1/kg]
    bias_factor: float | None
    collide_connected: bool
    motor_speed: float | None  # of body2 against body1 [rad/s]; None: no motor
    max_motor_torque: float  # [N m]


def describe_bodies(world: World) -> list[BodyDescription]:
    """All bodies in the order of creation."""
    records = world.body_records()
    rows = world._state.bodies.order
    outlines = _outlines(world, rows)
    fixed = records["fixed_rotation"] != 0
    columns = [
        records["serial"].tolist(),
        [BODY_KINDS[kind] for kind in records["kind"].tolist()],
        _pairs(records["x"], records["y"]),
        records["angle"].tolist(),
        _pairs(*world.velocities.T),
        world.angular_velocities.tolist(),
        records["mass"].tolist(),
        np.where(fixed, math.inf, records["inertia"]).tolist(),
        _pairs(records["local_x"], records["local_y"]),
        *(
            _column(world._state.bodies, name, BODY_PROPERTIES[name].default)
            for name in ("linear_damping", "angular_damping", "gravity_scale")
        ),
        outlines,
    ]
    return [BodyDescription(*values) for values in zip(*columns, strict=True)]


def describe_joints(world: World, bodies: list[BodyDescription]) -> list[JointDescription]:
    """All joints in the order of creation. CannotMirror if one is not revolute."""
    ranks = {body.serial: rank for rank, body in enumerate(bodies)}
    described = []
    for joint, record in zip(world.joints, world.joint_records(), strict=True):
        if not isinstance(joint, RevoluteJoint):
            raise CannotMirror(f"it has revolute joints only, joint {joint.serial} is a {joint.kind} joint")
        body1, body2 = ranks[int(record["body1"])], ranks[int(record["body2"])]
        described.append(
            JointDescription(
                joint.serial,
                body1,
                body2,
                _local(bodies[body1], float(record["x1"]), float(record["y1"])),
                _local(bodies[body2], float(record["x2"]), float(record["y2"])),
                joint.softness,
                joint.bias_factor,
                joint.collide_connected,
                joint.motor_speed,
                float(joint.max_motor_torque),
            )
        )
    return described


def _outlines(world: World, rows: np.ndarray) -> list[list[Outline]]:
    """Of each body: its shapes in the order of creation. rows (N,): of the bodies in the table."""
    pieces, hulls = world.shape_records(), world.hull_records()
    rank_of_row = np.zeros(rows.max(initial=-1) + 1, np.int64)
    rank_of_row[rows] = np.arange(len(rows))
    owners = rank_of_row[pieces["body"]].tolist()
    points = _points(pieces, hulls)
    kinds = pieces["kind"].tolist()
    part_of = pieces["part_of"].tolist()
    radii = pieces["radius"].tolist()
    halves = _pairs(pieces["half_x"], pieces["half_y"])
    places = list(zip(*(pieces[name].tolist() for name in ("local_x", "local_y", "local_angle")), strict=True))
    chains = {
        part: pieces[pieces["part_of"] == part] for part in set(pieces["part_of"][pieces["kind"] == CHAIN].tolist())
    }
    surfaces = [pieces["friction"].tolist()] + [
        _column(world._state.shapes, name, SHAPE_PROPERTIES[name].default)
        for name in ("restitution", "rolling_resistance", "tangent_speed", "category", "mask", "group")
    ]
    found: list[list[Outline]] = [[] for _ in range(len(rows))]
    for index, (owner, kind, *surface) in enumerate(zip(owners, kinds, *surfaces, strict=True)):
        closed = False
        if kind == CHAIN:
            own = chains.pop(part_of[index], None)
            if own is None:
                continue  # a further piece of one that is told already
            chain = Chain.from_rows(own, hulls)
            points[index], closed = [list(point) for point in chain.points], chain.closed
        found[owner].append(
            Outline(SHAPE_KINDS[kind], points[index], radii[index], halves[index], places[index], closed, *surface)
        )
    return found


def _points(pieces: np.ndarray, hulls: np.ndarray) -> list[Any]:
    """Of each piece: its points in the body's frame, as lists of pairs; of a chain's nothing."""
    points: list[Any] = [[] for _ in range(len(pieces))]
    signs = {
        BOX: np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]),
        CIRCLE: np.array([(0, 0)]),
        CAPSULE: np.array([(-1, 0), (1, 0)]),
        SEGMENT: np.array([(-1, 0), (1, 0)]),
    }
    for kind, sign in signs.items():
        own = np.flatnonzero(pieces["kind"] == kind)
        rows = pieces[own]
        local = np.stack([sign[:, 0] * rows["half_x"][:, None], sign[:, 1] * rows["half_y"][:, None]], axis=2)
        for index, corners in zip(own.tolist(), _in_body(rows, local).tolist(), strict=True):
            points[index] = corners
    own = np.flatnonzero(pieces["kind"] == POLYGON)
    hull = hulls[pieces["hull"][own]]
    placed = _in_body(pieces[own], np.stack([hull["x"], hull["y"]], axis=2)).tolist()
    for index, count, corners in zip(own.tolist(), hull["count"].tolist(), placed, strict=True):
        points[index] = corners[:count]
    return points


def _in_body(rows: np.ndarray, local: np.ndarray) -> np.ndarray:
    """(n, k, 2) points in the frames of n pieces, taken to those of their bodies."""
    c, s = rows["local_cosine"][:, None], rows["local_sine"][:, None]
    x, y = local[:, :, 0], local[:, :, 1]
    return np.stack([rows["local_x"][:, None] + (c * x - s * y), rows["local_y"][:, None] + (s * x + c * y)], axis=2)


def _column(storage: Any, name: str, default: Any) -> list[Any]:
    """A property of every thing, there or not."""
    values = storage.columns.get(name)
    return [default] * storage.count if values is None else values[storage.order].tolist()


def _pairs(x: np.ndarray, y: np.ndarray) -> list[Point]:
    return list(zip(x.tolist(), y.tolist(), strict=True))


def _local(body: BodyDescription, x: float, y: float) -> Point:
    """A point of the world in the body's frame [m]."""
    dx, dy = x - body.position[0], y - body.position[1]
    c, s = math.cos(body.angle), math.sin(body.angle)
    return c * dx + s * dy, c * dy - s * dx
