"""The command that brings new bodies, of any shape."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from engine import SHAPE_KINDS, Polygon, validate
from engine.shapes import SHAPES, Shape
from engine.tables import HULL_POINTS
from engine.trigonometry import cos_sin
from sandbox.commands.base import PhysicsCommand, coordinates

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

SIZES = (0.05, 20.0)  # [m]
CORNERS = (3, HULL_POINTS)
LARGEST_MASS = 1e6  # [kg]
LARGEST_FRICTION = 10.0
LARGEST_SPAWN = 200  # bodies at once
LARGEST_ANGLE = 1e3  # [rad]
KINDS = ("dynamic", "static")
LINES = ("segment", "chain")  # shapes without mass, of which nothing can fall
ROUNDEST = 0.4  # most of a polygon's smaller side that its rounding takes
SPACING = 1.1  # of bodies spawned together, in their sizes


@dataclass(frozen=True)
class Spawn(PhysicsCommand):
    """New bodies around a point [m], each of a shape that fills width times height, turned by an angle [rad].

    mass: of each, where it is dynamic [kg]; corners and rounding [m] are a polygon's. A circle has width for its
    diameter, a segment is level, and a chain a bowl; these two can only be static.
    """

    shape: str
    x: float
    y: float
    width: float = 1.0
    height: float = 1.0
    mass: float = 10.0
    friction: float = 0.2
    count: int = 1
    kind: str = "dynamic"
    angle: float = 0.0
    restitution: float = 0.0
    rolling_resistance: float = 0.0
    corners: int = 5
    rounding: float = 0.0
    bullet: bool = False
    name = "spawn"

    def __post_init__(self) -> None:
        self._keep(
            shape=validate.choice("shape", self.shape, SHAPE_KINDS),
            width=validate.between("width", self.width, *SIZES),
            height=validate.between("height", self.height, *SIZES),
            mass=validate.between("mass", self.mass, 1e-3, LARGEST_MASS),
            friction=validate.between("friction", self.friction, 0.0, LARGEST_FRICTION),
            count=validate.whole("count", self.count, 1, LARGEST_SPAWN),
            kind=validate.choice("kind", self.kind, KINDS),
            angle=validate.between("angle", self.angle, -LARGEST_ANGLE, LARGEST_ANGLE),
            restitution=validate.between("restitution", self.restitution, 0.0, 1.0),
            rolling_resistance=validate.between("rolling_resistance", self.rolling_resistance, 0.0, 1.0),
            corners=validate.whole("corners", self.corners, *CORNERS),
            rounding=validate.between("rounding", self.rounding, 0.0, SIZES[1]),
            bullet=validate.switch("bullet", self.bullet),
            **coordinates(x=self.x, y=self.y),
        )
        if self.shape in LINES and self.kind != "static":
            raise validate.refuse("kind", self.kind, f"'static' for a {self.shape}, which has no mass")

    def apply(self, simulation: Simulation) -> None:
        simulation.make_room(self.count)
        shape = self._shape()
        simulation.world.create_bodies(
            shape,
            positions=self._positions(shape),
            angles=self.angle,
            kind=self.kind,
            mass=self.mass if self.kind == "dynamic" else None,
            friction=self.friction,
            restitution=self.restitution,
            rolling_resistance=self.rolling_resistance,
            bullet=self.bullet,
        )

    def _shape(self) -> Shape:
        kind: Any = SHAPES[SHAPE_KINDS.index(self.shape)]
        if self.shape != "polygon":
            return cast(Shape, kind.filling(self.width, self.height))
        radius = min(self.rounding, ROUNDEST * min(self.width, self.height))
        sharp = Polygon.filling(self.width - 2.0 * radius, self.height - 2.0 * radius, self.corners)
        return replace(sharp, radius=radius)

    def _positions(self, shape: Shape) -> np.ndarray:
        """(count, 2) side by side in rows, the lowest about the point, so that none overlap [m]."""
        columns = math.ceil(math.sqrt(self.count))
        c, s = map(abs, cos_sin(self.angle))
        width, height = shape.extent
        steps = SPACING * np.maximum((c * width + s * height, s * width + c * height), SIZES[0])
        row, column = np.divmod(np.arange(self.count), columns)
        return np.array([self.x, self.y]) + steps * np.column_stack([column - 0.5 * (columns - 1), row])
