"""A convex polygon of up to eight corners, with its edges and corners rounded if asked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from engine import validate
from engine.constants import BOUNDS_MARGIN_RELATIVE
from engine.jit import kernel
from engine.lanes import absolute, maximum, minimum
from engine.rows import at
from engine.shapes.piece import Lamina, Piece, Point, inside_edges, joined, rectangle, sector, triangle
from engine.shapes.placing import put_shape
from engine.simd import WIDTH
from engine.tables import HULL_POINTS

POLYGON = 3
FLAT = 1e-9
"""A corner that turns by less than this [rad] is none."""


@dataclass(frozen=True)
class Polygon:
    """A convex polygon with 3 to 8 `points` [m], in either direction round, and all within `radius` of it [m]."""

    points: tuple[Point, ...]
    radius: float = 0.0

    name = "polygon"
    kind = POLYGON

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", check_convex(validate.points("points", self.points, 3, HULL_POINTS)))
        object.__setattr__(self, "radius", validate.non_negative("radius", self.radius))

    @property
    def area(self) -> float:
        """[m^2]"""
        return self.lamina().area

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centroid [kg m^2]."""
        plate = self.lamina()
        return mass * plate.moment / plate.area

    def lamina(self) -> Lamina:
        """The plate that it is: triangles, a strip along each edge, a sector at each corner."""
        corners = self.points
        parts = [triangle(corners[0], b, c) for b, c in pairwise(corners[1:])]
        if self.radius > 0.0:
            normals = edge_normals(np.array(corners))
            for k, (a, b) in enumerate(pairwise((*corners, corners[0]))):
                (nx, ny), (mx, my) = normals[k], normals[k - 1]
                middle = (0.5 * (a[0] + b[0] + self.radius * nx), 0.5 * (a[1] + b[1] + self.radius * ny))
                parts.append(rectangle(math.dist(a, b), self.radius, *middle))
                turn = math.atan2(mx * ny - my * nx, mx * nx + my * ny)
                parts.append(sector(self.radius, turn, *a, math.atan2(ny, nx) - 0.5 * turn))
        return joined(parts)

    def pieces(self) -> tuple[Piece, ...]:
        """Its rows in the table of shapes."""
        return (Piece({"radius": self.radius}, corners=np.array(self.points)),)

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills upright [m]."""
        width, height = np.ptp(np.array(self.points), axis=0) + 2.0 * self.radius
        return float(width), float(height)

    @staticmethod
    def sizes(rows: Any) -> tuple[Any, Any]:
        """What describes pieces to the outside, from their rows: rounding radius, and 0 [m]."""
        return rows["radius"], 0.0

    @classmethod
    def filling(cls, width: float, height: float, corners: int = 5) -> Polygon:
        """A regular one of that many corners, drawn out to that width and height [m]."""
        turns = 2.0 * np.pi * np.arange(corners) / corners + np.pi / 2.0
        points = np.column_stack([np.cos(turns), np.sin(turns)])
        low, high = points.min(axis=0), points.max(axis=0)
        scaled = (points - 0.5 * (low + high)) / (high - low) * (width, height)
        return cls(tuple((float(x), float(y)) for x, y in scaled))

    @staticmethod
    def from_rows(rows: Any, hulls: Any) -> Polygon:
        """The shape whose pieces these rows are."""
        hull = hulls[int(rows[0]["hull"])]
        count = int(hull["count"])
        points = zip(hull["x"][:count].tolist(), hull["y"][:count].tolist(), strict=True)
        return Polygon(tuple(points), float(rows[0]["radius"]))

    @staticmethod
    def contains(x: Any, y: Any, rows: Any, hulls: Any) -> Any:
        """Whether points in the pieces' own frames lie in them: arrays [m]."""
        hull = hulls[rows["hull"]]
        used = np.arange(HULL_POINTS) < hull["count"][:, None]
        px, py = np.asarray(x)[:, None], np.asarray(y)[:, None]
        within = inside_edges(px, py, *(np.where(used, hull[name], 0.0) for name in ("x", "y", "nx", "ny"))) <= 0.0
        after = np.where(np.arange(HULL_POINTS) + 1 < hull["count"][:, None], np.arange(HULL_POINTS) + 1, 0)
        ax, ay = hull["x"], hull["y"]
        ex, ey = np.take_along_axis(ax, after, 1) - ax, np.take_along_axis(ay, after, 1) - ay
        squared = np.where(used, ex * ex + ey * ey, 1.0)
        t = np.clip(((px - ax) * ex + (py - ay) * ey) / squared, 0.0, 1.0)
        away = (px - ax - t * ex) ** 2 + (py - ay - t * ey) ** 2
        near = np.min(np.where(used, away, np.inf), axis=1) <= rows["radius"] ** 2
        return within | near


def edge_normals(corners: np.ndarray) -> np.ndarray:
    """(n, 2) unit outward normals of the edges from each corner to the next, counter-clockwise."""
    edges = np.roll(corners, -1, axis=0) - corners
    return np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(edges[:, 0], edges[:, 1])[:, None]


def check_convex(points: tuple[Point, ...]) -> tuple[Point, ...]:
    """The points counter-clockwise. ValueError if they do not go round a convex polygon once."""
    lengths, turns = edges_and_turns(points)
    if turns.sum() < 0.0:
        points = points[::-1]
        lengths, turns = edges_and_turns(points)  # of what is all but in a line they may be below 0 either way
    once = abs(turns.sum() - 2.0 * np.pi) < 1e-6
    if not (np.all(lengths > 0.0) and np.all(turns > FLAT) and once):
        raise validate.refuse("points", list(points), "the corners of a convex polygon, one after another")
    return points


def edges_and_turns(points: tuple[Point, ...]) -> tuple[np.ndarray, np.ndarray]:
    """(n,) lengths of the edges from each corner to the next [m], and (n,) angles from each to the one after [rad]."""
    corners = np.array(points)
    edges = np.roll(corners, -1, axis=0) - corners
    following = np.roll(edges, -1, axis=0)
    turns = np.arctan2(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0], np.sum(edges * following, axis=1))
    return np.hypot(edges[:, 0], edges[:, 1]), turns


@kernel
def polygon_bounds(group, shapes, hulls, bodies, motions, placements, margin, bounds):
    """Puts polygons where they are and writes their bounding boxes, as box_bounds does, but one by one."""
    for k in range(len(group) * WIDTH):
        shape = at(group, k // WIDTH)
        rank, row = shape.rank[k % WIDTH], shape.row[k % WIDTH]
        hull = hulls[shapes[row].hull]
        place = put_shape(shapes[row], row, bodies, motions, placements)
        low_x = high_x = place.cosine * hull.x[0] - place.sine * hull.y[0]
        low_y = high_y = place.sine * hull.x[0] + place.cosine * hull.y[0]
        for corner in range(1, hull.count):
            x = place.cosine * hull.x[corner] - place.sine * hull.y[corner]
            y = place.sine * hull.x[corner] + place.cosine * hull.y[corner]
            low_x, high_x = minimum(low_x, x), maximum(high_x, x)
            low_y, high_y = minimum(low_y, y), maximum(high_y, y)
        radius = shapes[row].radius
        more_x = radius + margin + BOUNDS_MARGIN_RELATIVE * (absolute(place.x) + (high_x - low_x) + radius)
        more_y = radius + margin + BOUNDS_MARGIN_RELATIVE * (absolute(place.y) + (high_y - low_y) + radius)
        bounds[0, rank] = place.x + low_x - more_x
        bounds[1, rank] = place.y + low_y - more_y
        bounds[2, rank] = place.x + high_x + more_x
        bounds[3, rank] = place.y + high_y + more_y
