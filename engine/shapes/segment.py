"""A segment: a line without mass that is solid from both sides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import validate
from engine.shapes.piece import NOTHING, Lamina, Piece, Point

SEGMENT = 4


@dataclass(frozen=True)
class Segment:
    """The line from `a` to `b` [m]. It has no mass, and two segments never meet."""

    a: Point
    b: Point

    name = "segment"
    kind = SEGMENT

    def __post_init__(self) -> None:
        object.__setattr__(self, "a", validate.vector("a", self.a))
        object.__setattr__(self, "b", validate.vector("b", self.b))
        if self.a == self.b:
            raise validate.refuse("b", self.b, "another point than a")

    area = 0.0

    def inertia(self, mass: float) -> float:
        """It has none."""
        return 0.0

    def lamina(self) -> Lamina:
        """It has no area."""
        return NOTHING

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes."""
        return (line(self.a, self.b),)

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills [m]."""
        return abs(self.b[0] - self.a[0]), abs(self.b[1] - self.a[1])

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: length, and 0 [m]."""
        return 2.0 * rows["half_x"], 0.0

    @classmethod
    def filling(cls, width: float, height: float) -> Segment:
        """A level one of that width [m]; the height plays no part."""
        return cls((-0.5 * width, 0.0), (0.5 * width, 0.0))

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Segment:
        """The shape whose pieces these rows are, in the body's frame."""
        a, b = ends(rows[0])
        return Segment(a, b)

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """A line covers no point."""
        return np.zeros(np.shape(x), bool)


def line(a: Point, b: Point) -> Piece:
    """The piece from a to b."""
    half = 0.5 * math.dist(a, b)
    center = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
    return Piece({"half_x": half}, center, math.atan2(b[1] - a[1], b[0] - a[0]))


def ends(row: Any) -> tuple[Point, Point]:
    """Where a piece begins and ends, in the body's frame [m]."""
    x, y = float(row["local_x"]), float(row["local_y"])
    out_x = float(row["half_x"] * row["local_cosine"])
    out_y = float(row["half_x"] * row["local_sine"])
    return (x - out_x, y - out_y), (x + out_x, y + out_y)
