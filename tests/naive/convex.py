"""How far two rounded convex shapes are apart, or how deep in each other: every corner against every edge."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from tests.naive.circles import nearest_on_segment

IN_ONE_LINE = 1e-9  # [m]


@dataclass(frozen=True)
class Rounded:
    """The hull of `points`, (n, 2) counter-clockwise [m], grown by `radius`, turned by `angle` and moved to (x, y).

    One point: a circle; two: a capsule, or without a radius a segment.
    """

    points: tuple[tuple[float, float], ...]
    radius: float = 0.0
    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0

    @property
    def center(self) -> np.ndarray:
        return np.array([self.x, self.y])

    @property
    def corners(self) -> np.ndarray:
        """(n, 2) in the world [m]."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return self.center + np.array(self.points) @ np.array([[c, s], [-s, c]])

    @property
    def edges(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """A single point is an edge from itself to itself."""
        corners = self.corners
        return [(corners[k], corners[(k + 1) % len(corners)]) for k in range(len(corners))]

    @property
    def normals(self) -> list[np.ndarray]:
        found = []
        for a, b in self.edges:
            if (length := float(np.linalg.norm(b - a))) > 0:
                found.append(np.array([b[1] - a[1], a[0] - b[0]]) / length)
        return found

    def moved(self, offset: np.ndarray) -> Rounded:
        return replace(self, x=self.x + float(offset[0]), y=self.y + float(offset[1]))

    def turned_about_origin(self, angle: float) -> Rounded:
        c, s = math.cos(angle), math.sin(angle)
        return replace(self, x=c * self.x - s * self.y, y=s * self.x + c * self.y, angle=self.angle + angle)


Edges = list[tuple[np.ndarray, np.ndarray]]


def distance_to_edges(point: np.ndarray, edges: Edges) -> float:
    """Of a point from the nearest of a core's edges [m]."""
    return min(distance_to_segment(point, a, b) for a, b in edges)


def distance_to_segment(point: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    nearest = a if np.array_equal(a, b) else nearest_on_segment(a, b, point)
    return math.hypot(*(point - nearest))


def signed_distance(first: Rounded, second: Rounded) -> float:
    """Of the two surfaces [m]: < 0 is the length of the shortest move that parts the shapes."""
    corners1, corners2 = first.corners, second.corners

    def gap_along(normal: np.ndarray) -> float:
        """How far the second core lies beyond the first along a normal [m]."""
        return float((corners2 @ normal).min() - (corners1 @ normal).max())

    apart = max([gap_along(n) for n in first.normals] + [gap_along(-n) for n in second.normals], default=0.0)
    if apart > -IN_ONE_LINE:
        edges1, edges2 = first.edges, second.edges
        apart = min(distance_to_edges(corner, edges2) for corner in corners1)
        apart = min([apart, *(distance_to_edges(corner, edges1) for corner in corners2)])
    return apart - first.radius - second.radius
