"""The corners of shapes: a shape is all points within its radius of the polygon, line or point that they make."""

from __future__ import annotations

from engine.jit import kernel
from engine.shapes.box import BOX
from engine.shapes.circle import CIRCLE
from engine.shapes.polygon import POLYGON


@kernel
def write_core(shape, hulls, corners):
    """Writes corners (n, 2), counter-clockwise, in its own frame [m]. Returns n: 1 of a circle, 2 of a line."""
    if shape.kind == POLYGON:
        hull = hulls[shape.hull]
        for k in range(hull.count):
            corners[k, 0] = hull.x[k]
            corners[k, 1] = hull.y[k]
        return hull.count
    if shape.kind == BOX:
        corners[0, 0], corners[0, 1] = -shape.half_x, -shape.half_y
        corners[1, 0], corners[1, 1] = shape.half_x, -shape.half_y
        corners[2, 0], corners[2, 1] = shape.half_x, shape.half_y
        corners[3, 0], corners[3, 1] = -shape.half_x, shape.half_y
        return 4
    if shape.kind == CIRCLE:
        corners[0, 0], corners[0, 1] = 0.0, 0.0
        return 1
    corners[0, 0], corners[0, 1] = -shape.half_x, 0.0
    corners[1, 0], corners[1, 1] = shape.half_x, 0.0
    return 2
