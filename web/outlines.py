"""The outline of a convex polygon, rounded or drawn in by a distance."""

from __future__ import annotations

import numpy as np

ARC_POINTS = 9  # of a rounded corner


def grown(corners: np.ndarray, distance: float, arc_points: int = ARC_POINTS) -> np.ndarray:
    """All points within a distance of a polygon (n, 2), or those no nearer than that to its edge if it is negative [m].

    Counter-clockwise as the corners are, (V, 2). Drawn in, no edge may vanish: see `reach`.
    """
    after = _normals(corners)
    before = np.roll(after, 1, axis=0)
    if distance <= 0.0:
        mitre = (after + before) / (1.0 + np.sum(after * before, axis=1))[:, None]
        return np.asarray(corners + distance * mitre)
    first = np.arctan2(before[:, 1], before[:, 0])
    turn = np.remainder(np.arctan2(after[:, 1], after[:, 0]) - first, 2.0 * np.pi)
    angles = first[:, None] + turn[:, None] * np.linspace(0.0, 1.0, arc_points)
    arcs = distance * np.stack([np.cos(angles), np.sin(angles)], axis=2)
    return np.asarray(corners[:, None] + arcs).reshape(-1, 2)


def reach(corners: np.ndarray) -> float:
    """How far a polygon (n, 2) can be drawn in before its shortest edge or its middle vanishes [m]."""
    normals = _normals(corners)
    edges = np.roll(corners, -1, axis=0) - corners
    cosine = np.clip(np.sum(normals * np.roll(normals, 1, axis=0), axis=1), -1.0, 1.0)
    lost = np.tan(np.arccos(cosine) / 2.0)  # of an edge at this corner, per distance
    lengths = np.hypot(edges[:, 0], edges[:, 1]) / (lost + np.roll(lost, -1))
    heights = np.sum(normals * (corners - corners.mean(axis=0)), axis=1)
    return float(min(lengths.min(), heights.min()))


def _normals(corners: np.ndarray) -> np.ndarray:
    """(n, 2) outward unit normals of the edges from each corner to the next."""
    edges = np.roll(corners, -1, axis=0) - corners
    return np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(edges[:, 0], edges[:, 1])[:, None]
