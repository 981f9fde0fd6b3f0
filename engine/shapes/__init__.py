"""What a body looks like: one file a shape, one line here."""

from __future__ import annotations

from engine.shapes.box import Box, box_bounds
from engine.shapes.capsule import Capsule, core_bounds
from engine.shapes.chain import Chain
from engine.shapes.circle import Circle, circle_bounds
from engine.shapes.polygon import Polygon, polygon_bounds
from engine.shapes.segment import Segment

Shape = Box | Circle | Capsule | Polygon | Segment | Chain

SHAPES: tuple[type[Shape], ...] = (Box, Circle, Capsule, Polygon, Segment, Chain)
SHAPE_KINDS = tuple(shape.name for shape in SHAPES)
BOUNDS = (box_bounds, circle_bounds, core_bounds, polygon_bounds, core_bounds, core_bounds)
