"""What a body looks like: one file a shape, one line here."""

from __future__ import annotations

from engine.shapes.box import Box, box_bounds
from engine.shapes.circle import Circle, circle_bounds

Shape = Box | Circle

SHAPES: tuple[type[Box] | type[Circle], ...] = (Box, Circle)
SHAPE_KINDS = tuple(shape.name for shape in SHAPES)
BOUNDS = (box_bounds, circle_bounds)
