"""Shapes of a body: the handle that a user holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.effects import SHAPE_PROPERTIES
from engine.properties import Part
from engine.shapes import SHAPES, Shape
from engine.sleeping import touch

if TYPE_CHECKING:
    from engine.bodies import Body
    from engine.world import World


class ShapeHandle(Part):
    """A shape of a body. Reading or changing one that was destroyed is a ValueError."""

    __slots__ = ("__weakref__", "rows", "serial", "world")

    properties = SHAPE_PROPERTIES
    noun = "shape"

    if TYPE_CHECKING:
        restitution: float
        rolling_resistance: float
        tangent_speed: float
        category: int
        mask: int
        group: int

    def __init__(self, world: World, rows: np.ndarray, serial: int) -> None:
        self.world = world
        self.rows = rows  # of its pieces
        self.serial = serial  # number of creation of its first piece

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ShapeHandle) and other.world is self.world and other.serial == self.serial

    def __hash__(self) -> int:
        return hash((id(self.world), "shape", self.serial))

    def __repr__(self) -> str:
        return f"<ShapeHandle {self.serial}{f': {self.shape}' if self.alive else ', destroyed'}>"

    @property
    def alive(self) -> bool:
        """Whether it is still in its world."""
        return self.world._state.shapes.holds(int(self.rows[0]), self.serial)

    @property
    def shape(self) -> Shape:
        """What it is, in its own frame; a segment or chain in that of the body."""
        rows = self._rows
        return SHAPES[int(rows[0]["kind"])].from_rows(rows, self.world._state.hulls.tables["hulls"])

    @property
    def body(self) -> Body:
        """Whose shape it is."""
        return self.world._body_in_row(int(self._rows[0]["body"]))

    @property
    def mass(self) -> float:
        """What it adds to its body [kg]."""
        return float(self._rows["mass"].sum())

    @property
    def friction(self) -> float:
        """Coefficient; World.friction_mixing says what two shapes make of theirs."""
        return float(self._rows[0]["friction"])

    @friction.setter
    def friction(self, value: float) -> None:
        friction = validate.non_negative("friction", value)
        validate.in_range(self.world.precision, friction=(friction,))
        self._touch_property()
        self.world._state.shapes.tables["shapes"]["friction"][self.rows] = friction
        self.world._state.stale = True

    def destroy(self) -> None:
        """Takes the shape off its body, whose mass, centre and inertia follow."""
        self._check()
        self.world._destroy_shape(self)

    def _touch_property(self) -> None:
        touch(self.world._state, int(self._rows[0]["body"]))

    @property
    def _storage(self) -> Any:
        return self.world._state.shapes

    @property
    def _places(self) -> Any:
        return self.rows

    @property
    def _rows(self) -> Any:
        self._check()
        return self.world._state.shapes.tables["shapes"][self.rows]
