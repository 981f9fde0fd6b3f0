"""How much of a convex polygon is in a rectangle, slowly: corners of either in the other, and where edges cross."""

from __future__ import annotations

import math
from itertools import pairwise

Point = tuple[float, float]


def overlap(polygon: list[Point], low: Point, high: Point) -> tuple[float, Point]:
    """(area, centroid) of what a convex polygon, counter-clockwise, shares with a rectangle."""
    corners = [low, (high[0], low[1]), high, (low[0], high[1])]
    points = [p for p in polygon if in_convex(p, corners)] + [p for p in corners if in_convex(p, polygon)]
    for a in edges(polygon):
        for b in edges(corners):
            points += crossing(a, b)
    if len(points) < 3:
        return 0.0, (0.0, 0.0)
    x, y = (math.fsum(p[i] for p in points) / len(points) for i in (0, 1))
    points.sort(key=lambda p: math.atan2(p[1] - y, p[0] - x))
    area, moment_x, moment_y = 0.0, 0.0, 0.0
    for (ax, ay), (bx, by) in edges(points):  # triangles with the mean of the points
        twice = (ax - x) * (by - y) - (ay - y) * (bx - x)
        area += twice / 2.0
        moment_x += twice / 2.0 * (ax + bx + x) / 3.0
        moment_y += twice / 2.0 * (ay + by + y) / 3.0
    return (area, (moment_x / area, moment_y / area)) if area > 0.0 else (0.0, (0.0, 0.0))


def edges(polygon: list[Point]) -> list[tuple[Point, Point]]:
    return list(pairwise([*polygon, polygon[0]]))


def in_convex(p: Point, polygon: list[Point]) -> bool:
    return all((bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) >= 0.0 for (ax, ay), (bx, by) in edges(polygon))


def crossing(first: tuple[Point, Point], second: tuple[Point, Point]) -> list[Point]:
    """Where two lines between points cross."""
    (ax, ay), (bx, by) = first
    (cx, cy), (dx, dy) = second
    rx, ry, sx, sy = bx - ax, by - ay, dx - cx, dy - cy
    across = rx * sy - ry * sx
    if across == 0.0:
        return []
    t = ((cx - ax) * sy - (cy - ay) * sx) / across
    u = ((cx - ax) * ry - (cy - ay) * rx) / across
    return [(ax + t * rx, ay + t * ry)] if 0.0 <= t <= 1.0 and 0.0 <= u <= 1.0 else []
