"""Where two boxes touch, the slow and obvious way: corners projected on axes, and a face clipped to a half plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class PlacedBox:
    """A rectangle of width and height about (x, y), turned by angle."""

    x: float
    y: float
    angle: float
    width: float
    height: float

    @property
    def center(self) -> np.ndarray:
        return np.array([self.x, self.y])

    @property
    def axes(self) -> np.ndarray:
        """Its two unit axes, one a row."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.array([[c, s], [-s, c]])

    @property
    def half(self) -> np.ndarray:
        return 0.5 * np.array([self.width, self.height])

    @property
    def corners(self) -> np.ndarray:
        """(4, 2), counter-clockwise."""
        signs = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
        return self.center + (signs * self.half) @ self.axes

    def distance_outside(self, point: np.ndarray) -> float:
        """How far a point lies beyond the box's faces, < 0 inside: the largest of the four."""
        return float(np.max(np.abs(self.axes @ (point - self.center)) - self.half))


def overlaps(box1: PlacedBox, box2: PlacedBox) -> np.ndarray:
    """(4,) depth to which the boxes overlap along the face normals x1, y1, x2, y2; < 0: the axis separates them."""
    depths = []
    for axis in np.concatenate([box1.axes, box2.axes]):
        along1, along2 = box1.corners @ axis, box2.corners @ axis
        depths.append(min(along1.max() - along2.min(), along2.max() - along1.min()))
    return np.array(depths)


def clip(points: list[np.ndarray], normal: np.ndarray, offset: float) -> list[np.ndarray]:
    """The part of a segment in the half plane normal . x <= offset."""
    kept = []
    for point, other in (points, points[::-1]):
        outside, other_outside = normal @ point - offset, normal @ other - offset
        if outside <= 0:
            kept.append(point)
        elif other_outside < 0:
            kept.append(point + (other - point) * outside / (outside - other_outside))
    return kept if len(kept) == 2 else []


def contacts_on_face(reference: PlacedBox, other: PlacedBox, normal: np.ndarray) -> list[tuple[np.ndarray, float]]:
    """The edge of `other` that faces `normal`, a face normal of `reference`, clipped to that face.

    Returns (point slid onto the face, separation) of each end that is not above the face.
    """
    corners = other.corners
    edges = [(corners[k], corners[(k + 1) % 4]) for k in range(4)]

    def facing(edge: tuple[np.ndarray, np.ndarray]) -> float:
        outward = 0.5 * (edge[0] + edge[1]) - other.center
        return float(outward @ normal / np.linalg.norm(outward))

    lowest = min(edges, key=facing)
    side = np.array([-normal[1], normal[0]])
    along_x = abs(reference.axes[0] @ side) > 0.5
    reach = reference.half[0] if along_x else reference.half[1]
    front = normal @ reference.center + (reference.half[1] if along_x else reference.half[0])
    points = clip(list(lowest), side, side @ reference.center + reach)
    if points:
        points = clip(points, -side, -side @ reference.center + reach)
    found = [(point - normal * (normal @ point - front), float(normal @ point - front)) for point in points]
    return [(point, separation) for point, separation in found if separation <= 0]
