"""What a shape is made of: the pieces that stand in the table of shapes, and the plane figure that gives it mass."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

Point = tuple[float, float]


class Piece(NamedTuple):
    """One row of the table of shapes: where it lies in its shape's frame, and its sizes [m]."""

    fields: dict[str, float]
    center: Point = (0.0, 0.0)
    angle: float = 0.0  # [rad]
    corners: np.ndarray | None = None  # (n, 2), counter-clockwise: a polygon's


class Lamina(NamedTuple):
    """A thin plate: area [m^2], centroid [m] and second moment of area about the centroid [m^4]."""

    area: float
    x: float
    y: float
    moment: float


NOTHING = Lamina(0.0, 0.0, 0.0, 0.0)


def joined(laminas: list[Lamina]) -> Lamina:
    """Several plates as one (Huygens and Steiner)."""
    area = math.fsum(part.area for part in laminas)
    if area == 0.0:
        return NOTHING
    x = math.fsum(part.area * part.x for part in laminas) / area
    y = math.fsum(part.area * part.y for part in laminas) / area
    moment = math.fsum(p.moment + p.area * ((p.x - x) ** 2 + (p.y - y) ** 2) for p in laminas)
    return Lamina(area, x, y, moment)


def rectangle(width: float, height: float, x: float = 0.0, y: float = 0.0) -> Lamina:
    """A w x h rectangle about (x, y): moment w h (w^2 + h^2) / 12."""
    area = width * height
    return Lamina(area, x, y, area * (width * width + height * height) / 12.0)


def disc(radius: float) -> Lamina:
    """A disc about the origin: moment A r^2 / 2."""
    area = math.pi * radius * radius
    return Lamina(area, 0.0, 0.0, 0.5 * area * radius * radius)


def sector(radius: float, turn: float, x: float, y: float, middle: float) -> Lamina:
    """A circular sector with its tip at (x, y), `turn` [rad] wide about the direction `middle` [rad]."""
    if radius == 0.0 or turn <= 0.0:
        return NOTHING
    area = 0.5 * radius * radius * turn
    out = 4.0 * radius * math.sin(0.5 * turn) / (3.0 * turn)  # from the tip to the centroid
    about_tip = 0.25 * radius**4 * turn
    return Lamina(area, x + out * math.cos(middle), y + out * math.sin(middle), about_tip - area * out * out)


def triangle(a: Point, b: Point, c: Point) -> Lamina:
    """Moment A (|ab|^2 + |bc|^2 + |ca|^2) / 36."""
    area = 0.5 * abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    sides = math.dist(a, b) ** 2 + math.dist(b, c) ** 2 + math.dist(c, a) ** 2
    return Lamina(area, (a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0, area * sides / 36.0)


def inside_edges(x: Any, y: Any, corners_x: Any, corners_y: Any, normals_x: Any, normals_y: Any) -> Any:
    """How far a point lies beyond the edges of a convex polygon: the largest over the edges, < 0 inside [m]."""
    return np.max(normals_x * (x - corners_x) + normals_y * (y - corners_y), axis=-1)


def from_capsule(x: Any, y: Any, half_x: Any) -> Any:
    """Square of the distance of a point from the segment (-half_x, 0) to (half_x, 0) [m^2]."""
    along = np.clip(x, -half_x, half_x)
    return (x - along) * (x - along) + y * y
