"""Area, centroid and second moment of plane figures, by counting the small squares that lie in them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

Inside = Callable[[np.ndarray, np.ndarray], np.ndarray]


class Plate(NamedTuple):
    """A thin plate: area [m^2], centroid [m], second moment of area about the centroid [m^4]."""

    area: float
    x: float
    y: float
    moment: float


def integrate(inside: Inside, reach: float, squares: int = 1000) -> Plate:
    """Of the figure that holds the points for which `inside` says so, all within `reach` of the origin."""
    middles = ((np.arange(squares) + 0.5) / squares * 2.0 - 1.0) * reach
    a, b = np.meshgrid(middles, middles)
    x, y = 0.8 * a - 0.6 * b, 0.6 * a + 0.8 * b  # turned, so that no edge of a figure runs along the squares
    held = inside(x, y)
    x, y, part = x[held], y[held], (2.0 * reach / squares) ** 2
    center_x, center_y = float(x.mean()), float(y.mean())
    moment = float(((x - center_x) ** 2 + (y - center_y) ** 2).sum()) * part
    return Plate(float(held.sum()) * part, center_x, center_y, moment)


def joined(plates: list[Plate]) -> Plate:
    """Plates as one, as if each were a heavy point with a moment of its own."""
    area = sum(plate.area for plate in plates)
    x = sum(plate.area * plate.x for plate in plates) / area
    y = sum(plate.area * plate.y for plate in plates) / area
    about_origin = sum(p.moment + p.area * (p.x * p.x + p.y * p.y) for p in plates)
    return Plate(area, x, y, about_origin - area * (x * x + y * y))


def near_polygon(corners: np.ndarray, radius: float) -> Inside:
    """All points within `radius` of a convex polygon of counter-clockwise corners (n, 2); of two corners, a capsule."""

    def inside(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        within = np.ones(x.shape, bool) if len(corners) > 2 else np.zeros(x.shape, bool)
        near = np.zeros(x.shape, bool)
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            along = b - a
            px, py = x - a[0], y - a[1]
            within &= along[0] * py - along[1] * px >= 0.0
            t = np.clip((px * along[0] + py * along[1]) / (along @ along), 0.0, 1.0)
            near |= (px - t * along[0]) ** 2 + (py - t * along[1]) ** 2 <= radius * radius
        return within | near

    return inside


def turned(inside: Inside, x0: float, y0: float, angle: float) -> Inside:
    """The figure turned by an angle [rad] and moved to (x0, y0)."""
    c, s = np.cos(angle), np.sin(angle)
    return lambda x, y: inside(c * (x - x0) + s * (y - y0), c * (y - y0) - s * (x - x0))
