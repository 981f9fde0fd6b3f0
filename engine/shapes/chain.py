"""A chain: a line of segments that can be touched from one side, over whose joints things slide as if there were none.

Each piece knows the points before and after it (ghosts): a contact whose normal belongs to the neighbour, or points
into the corner between the two, is left to the neighbour. Source: E. Catto, "Ghost Collisions" (box2d.org, 2020).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import validate
from engine.shapes.piece import NOTHING, Lamina, Piece, Point
from engine.shapes.segment import ends, line
from engine.vec2 import Vec2, unrotate

CHAIN = 5
MOST_POINTS = 100_000
IN_PLACE = 1e-9  # of a piece's half length: a ghost nearer than this to the piece's own end is that end


@dataclass(frozen=True)
class Chain:
    """Segments through `points` [m] on whose left things lie, going along them: a floor runs from left to right.

    closed: the last point is joined with the first; counter-clockwise it holds things in, clockwise out.
    """

    points: tuple[Point, ...]
    closed: bool = False

    name = "chain"
    kind = CHAIN

    def __post_init__(self) -> None:
        object.__setattr__(self, "closed", validate.switch("closed", self.closed))
        points = validate.points("points", self.points, 3 if self.closed else 2, MOST_POINTS)
        object.__setattr__(self, "points", points)
        following = (*points[1:], points[0]) if self.closed else points[1:]
        for a, b in zip(points, following, strict=False):
            if a == b:
                raise validate.refuse("points", list(points), f"of different neighbours, {a} comes twice in a row")

    area = 0.0

    def inertia(self, mass: float) -> float:
        """It has none."""
        return 0.0

    def lamina(self) -> Lamina:
        """It has no area."""
        return NOTHING

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes: one a segment. Beyond an open end there is nothing."""
        points = self.points
        if self.closed:
            around = (points[-1], *points, points[0], points[1])
        else:
            around = (points[0], *points, points[-1])
        return tuple(chain_piece(*four) for four in zip(around, around[1:], around[2:], around[3:], strict=False))

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills [m]."""
        width, height = np.ptp(np.array(self.points), axis=0)
        return float(width), float(height)

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: length, and 0 [m]."""
        return 2.0 * rows["half_x"], 0.0

    @classmethod
    def filling(cls, width: float, height: float) -> Chain:
        """A shallow bowl of that width and height [m], open above."""
        turns = np.linspace(-1.0, 1.0, 9)
        return cls(tuple((0.5 * width * float(t), height * (float(t * t) - 0.5)) for t in turns))

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Chain:
        """The shape whose pieces these rows are, in the body's frame."""
        starts_and_ends = [ends(row) for row in rows]
        points = [start for start, _ in starts_and_ends]
        last = starts_and_ends[-1][1]
        first = rows[0]  # before an open end there is the end itself
        before = abs(first["ghost1_x"] + first["half_x"]) + abs(first["ghost1_y"])
        closed = bool(before > IN_PLACE * first["half_x"])
        return Chain(tuple(points if closed else [*points, last]), closed)

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """A line covers no point."""
        return np.zeros(np.shape(x), bool)


def chain_piece(before: Point, a: Point, b: Point, after: Point) -> Piece:
    """The piece from a to b that knows its neighbours, in its own frame."""
    piece = line(a, b)
    half = piece.fields["half_x"]
    q = Vec2((b[0] - a[0]) / (2.0 * half), (b[1] - a[1]) / (2.0 * half))
    ghosts = {}
    for number, (x, y) in ((1, before), (2, after)):
        local = unrotate(q, Vec2(x - piece.center[0], y - piece.center[1]))
        ghosts[f"ghost{number}_x"], ghosts[f"ghost{number}_y"] = local
    return piece._replace(fields={**piece.fields, **ghosts})
