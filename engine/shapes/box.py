"""A box: the talk's one shape, about its centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from engine.jit import kernel
from engine.lanes import absolute
from engine.rows import at
from engine.shapes.piece import Lamina, Piece, rectangle
from engine.shapes.placing import put_shape, write_bounds
from engine.validate import positive

BOX = 0


@dataclass(frozen=True)
class Box:
    """A rectangle of full `width` and `height` [m] about its own origin."""

    width: float
    height: float

    name = "box"
    kind = BOX

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", positive("width", self.width))
        object.__setattr__(self, "height", positive("height", self.height))

    @property
    def area(self) -> float:
        """[m^2]"""
        return self.width * self.height

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centre, m (w^2 + h^2) / 12 [kg m^2]."""
        return mass * (self.width * self.width + self.height * self.height) / 12.0

    def lamina(self) -> Lamina:
        """The plate that it is."""
        return rectangle(self.width, self.height)

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes."""
        return (Piece({"half_x": 0.5 * self.width, "half_y": 0.5 * self.height}),)

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills upright [m]."""
        return self.width, self.height

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: full width and height [m]."""
        return 2.0 * rows["half_x"], 2.0 * rows["half_y"]

    @classmethod
    def filling(cls, width: float, height: float) -> Box:
        """The one that fills a rectangle of that width and height [m]."""
        return cls(width, height)

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Box:
        """The shape whose pieces these rows are."""
        return Box(2.0 * float(rows[0]["half_x"]), 2.0 * float(rows[0]["half_y"]))

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """Whether points in the pieces' own frames lie in them: arrays [m]."""
        return (abs(x) <= rows["half_x"]) & (abs(y) <= rows["half_y"])


@kernel
def box_bounds(group, shapes, hulls, bodies, motions, placements, margin, bounds):
    """Puts boxes, eight at a time, where their bodies are now, and writes their bounding boxes, grown by `margin` [m].

    group: see engine/shapes/placing.py. bounds (4, S) float32: lower x and y, upper x and y, by rank.
    """
    sides = (bounds[0], bounds[1], bounds[2], bounds[3])
    for k in range(len(group)):
        shape = at(group, k)
        place = put_shape(shape, shape.row, bodies, motions, placements)
        c = absolute(place.cosine)
        s = absolute(place.sine)
        reach_x = c * shape.half_x + s * shape.half_y
        reach_y = s * shape.half_x + c * shape.half_y
        write_bounds(shape.rank, place, reach_x, reach_y, margin, sides)
