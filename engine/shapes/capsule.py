"""A capsule: all points near a segment; and the bounds of everything that has a segment for its core."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from engine.jit import kernel
from engine.lanes import absolute
from engine.rows import at
from engine.shapes.piece import Lamina, Piece, from_capsule, joined, rectangle, sector
from engine.shapes.placing import put_shape, write_bounds
from engine.validate import positive

CAPSULE = 2


@dataclass(frozen=True)
class Capsule:
    """All points within `radius` of a segment of `length` along x, about its own origin [m]."""

    length: float
    radius: float

    name = "capsule"
    kind = CAPSULE

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", positive("length", self.length))
        object.__setattr__(self, "radius", positive("radius", self.radius))

    @property
    def area(self) -> float:
        """[m^2]"""
        return 2.0 * self.radius * self.length + math.pi * self.radius * self.radius

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centre: of a rectangle and two half discs [kg m^2]."""
        return mass * self.lamina().moment / self.area

    def lamina(self) -> Lamina:
        """The plate that it is."""
        half = 0.5 * self.length
        caps = [sector(self.radius, math.pi, side * half, 0.0, math.pi * (side < 0)) for side in (-1, 1)]
        plate = joined([rectangle(self.length, 2.0 * self.radius), *caps])
        return Lamina(plate.area, 0.0, 0.0, plate.moment)  # about its middle, whatever the rounding

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes."""
        return (Piece({"half_x": 0.5 * self.length, "radius": self.radius}),)

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills lying [m]."""
        return self.length + 2.0 * self.radius, 2.0 * self.radius

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: length and radius [m]."""
        return 2.0 * rows["half_x"], rows["radius"]

    @classmethod
    def filling(cls, width: float, height: float) -> Capsule:
        """The one that fills a rectangle of that width and height [m]; a flat one where it would stand."""
        radius = 0.5 * min(height, 0.9 * width)
        return cls(width - 2.0 * radius, radius)

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Capsule:
        """The shape whose pieces these rows are."""
        return Capsule(2.0 * float(rows[0]["half_x"]), float(rows[0]["radius"]))

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """Whether points in the pieces' own frames lie in them: arrays [m]."""
        return from_capsule(x, y, rows["half_x"]) <= rows["radius"] * rows["radius"]


@kernel
def core_bounds(group, shapes, hulls, bodies, motions, placements, margin, bounds):
    """Puts capsules, segments and chain pieces where they are and writes their bounding boxes, as box_bounds does."""
    sides = (bounds[0], bounds[1], bounds[2], bounds[3])
    for k in range(len(group)):
        shape = at(group, k)
        place = put_shape(shape, shape.row, bodies, motions, placements)
        reach_x = absolute(place.cosine) * shape.half_x + shape.radius
        reach_y = absolute(place.sine) * shape.half_x + shape.radius
        write_bounds(shape.rank, place, reach_x, reach_y, margin, sides)
