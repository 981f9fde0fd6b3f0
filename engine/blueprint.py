"""A shape as it will stand in the tables: checked first, then written for one body or for thousands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.effects import SHAPE_PROPERTIES
from engine.properties import check
from engine.shapes import SHAPES, Shape
from engine.shapes.piece import Piece
from engine.shapes.polygon import edge_normals
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2, rotate
from engine.weights import shape_mass

if TYPE_CHECKING:
    from engine.state import State
    from engine.world import World

Pair = Sequence[float]


class Blueprint:
    """A shape as it will stand in the tables, checked; `write` puts it on a body."""

    def __init__(
        self,
        world: World,
        shape: Shape,
        mass: float | None,
        density: float | None,
        friction: float,
        offset: Pair,
        angle: float,
        properties: dict[str, Any],
    ) -> None:
        if not isinstance(shape, SHAPES):
            raise validate.refuse("shape", shape, "a " + ", ".join(cls.__name__ for cls in SHAPES))
        self.shape = shape
        self.mass = shape_mass(shape, mass, density)
        self.friction = validate.non_negative("friction", friction)
        self.offset = Vec2(*validate.vector("offset", offset))
        self.angle = validate.number("angle", angle)
        self.properties = check(world, properties, SHAPE_PROPERTIES)
        self.pieces = shape.pieces()
        validate.in_range(world.precision, friction=(self.friction,), offset=self.offset)
        for piece in self.pieces:
            sizes = [*piece.fields.values(), *piece.center]
            sizes += [] if piece.corners is None else piece.corners.ravel().tolist()
            validate.in_range(world.precision, shape=sizes)

    def write(self, state: State, body_rows: np.ndarray) -> np.ndarray:
        """Writes the pieces for each of these bodies; returns their rows, body after body."""
        storage, count = state.shapes, len(self.pieces)
        rows = storage.add_many(count * len(body_rows))
        shapes = storage.tables["shapes"]
        serials = shapes["serial"][rows]
        shapes["body"][rows] = np.repeat(body_rows, count)
        shapes["part_of"][rows] = np.repeat(serials[::count], count)
        for k, piece in enumerate(self.pieces):
            self._write_piece(state, rows[k::count], piece, self.mass if k == 0 else 0.0)
        for name, value in self.properties.items():
            storage.put(name, rows, value)
        return rows

    def _write_piece(self, state: State, rows: np.ndarray, piece: Piece, mass: float) -> None:
        center = self.offset + rotate(Vec2(*cos_sin(self.angle)), Vec2(*piece.center))
        cosine, sine = cos_sin(self.angle + piece.angle)
        values = {
            "kind": self.shape.kind, "mass": mass, "friction": self.friction, "hull": -1,
            "local_x": center.x, "local_y": center.y, "local_angle": self.angle + piece.angle,
            "local_cosine": cosine, "local_sine": sine, **piece.fields,
        }  # fmt: skip
        shapes = state.shapes.tables["shapes"]
        for name, value in values.items():
            shapes[name][rows] = value
        if piece.corners is not None:
            shapes["hull"][rows] = write_hulls(state, piece.corners, len(rows))


def write_hulls(state: State, corners: np.ndarray, copies: int) -> np.ndarray:
    """Rows of hulls with these corners (n, 2), counter-clockwise [m]."""
    rows = state.hulls.add_many(copies)
    hulls = state.hulls.tables["hulls"]
    n, normals = len(corners), edge_normals(corners)
    hulls["count"][rows] = n
    for name, values in (("x", corners[:, 0]), ("y", corners[:, 1]), ("nx", normals[:, 0]), ("ny", normals[:, 1])):
        hulls[name][rows, :n] = values
    return rows
