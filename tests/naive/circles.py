"""Where a circle touches a box or a circle, by looking at every edge."""

from __future__ import annotations

import numpy as np

from tests.naive.boxes import PlacedBox


def nearest_on_segment(a: np.ndarray, b: np.ndarray, point: np.ndarray) -> np.ndarray:
    """The point of the segment a b nearest to a point."""
    t = (point - a) @ (b - a) / ((b - a) @ (b - a))
    return a + min(max(t, 0.0), 1.0) * (b - a)


def box_circle(box: PlacedBox, center: np.ndarray, radius: float) -> tuple[np.ndarray, float, float]:
    """(point of the box's edges nearest to the circle's centre, separation, distance of the second nearest edge)."""
    corners = box.corners
    points = [nearest_on_segment(corners[k], corners[(k + 1) % 4], center) for k in range(4)]
    distances = [float(np.linalg.norm(point - center)) for point in points]
    first, second = np.argsort(distances)[:2]
    inside = box.distance_outside(center) < 0
    separation = (-distances[first] if inside else distances[first]) - radius
    return points[first], separation, distances[second] - distances[first]
