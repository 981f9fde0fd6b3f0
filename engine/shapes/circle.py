"""A circle: the talk's first exercise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from engine.jit import kernel
from engine.rows import at
from engine.shapes.piece import Lamina, Piece, disc
from engine.shapes.placing import put_shape, write_bounds
from engine.validate import positive

CIRCLE = 1


@dataclass(frozen=True)
class Circle:
    """A disc of `radius` [m] about its own origin."""

    radius: float

    name = "circle"
    kind = CIRCLE

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive("radius", self.radius))

    @property
    def area(self) -> float:
        """[m^2]"""
        return math.pi * self.radius * self.radius

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centre, m r^2 / 2 [kg m^2]."""
        return 0.5 * mass * self.radius * self.radius

    def lamina(self) -> Lamina:
        """The plate that it is."""
        return disc(self.radius)

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes."""
        return (Piece({"radius": self.radius}),)

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills [m]."""
        return 2.0 * self.radius, 2.0 * self.radius

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: radius, and 0 [m]."""
        return rows["radius"], 0.0

    @classmethod
    def filling(cls, width: float, height: float) -> Circle:
        """The one that has that width for its diameter [m]; the height plays no part."""
        return cls(0.5 * width)

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Circle:
        """The shape whose pieces these rows are."""
        return Circle(float(rows[0]["radius"]))

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """Whether points in the pieces' own frames lie in them: arrays [m]."""
        return x * x + y * y <= rows["radius"] * rows["radius"]


@kernel
def circle_bounds(group, shapes, hulls, bodies, motions, placements, margin, bounds):
    """Puts circles where they are and writes their bounding boxes, as box_bounds does."""
    sides = (bounds[0], bounds[1], bounds[2], bounds[3])
    for k in range(len(group)):
        shape = at(group, k)
        place = put_shape(shape, shape.row, bodies, motions, placements)
        write_bounds(shape.rank, place, shape.radius, shape.radius, margin, sides)
