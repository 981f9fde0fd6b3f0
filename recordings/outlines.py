"""Flat meshes of capsules and polygons: a bright rim around a darker face, as rerun draws boxes and discs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine import SHAPE_KINDS
from recordings.shot import Shot

_CAPSULE, _POLYGON = SHAPE_KINDS.index("capsule"), SHAPE_KINDS.index("polygon")
_ARC_POINTS = 9  # of a rounded corner
_RIM = 0.0015  # of the view's height
_RIM_SHARE = 0.2  # at most this part of the way to the middle
_RIM_DEPTH = 0.001  # how far the rim lies below the face [m]


class Outline(NamedTuple):
    """A flat mesh of V vertices, in its piece's own frame: the rim's first, then the face's."""

    vertices: np.ndarray  # (V, 3) float32 [m]
    is_face: np.ndarray  # (V,) bool
    triangles: np.ndarray  # (T, 3) uint32


def outlines(shot: Shot, view_height: float) -> dict[int, Outline]:
    """The meshes of all capsules and polygons by the pieces' indices; equal ones are one object."""
    known: dict[bytes, Outline] = {}
    found = {}
    ends = np.cumsum(shot.corner_counts, dtype=np.int64)
    for piece in np.flatnonzero((shot.shape_kinds == _CAPSULE) | (shot.corner_counts > 2)):
        if shot.shape_kinds[piece] == _POLYGON:
            corners = shot.corners[ends[piece] - shot.corner_counts[piece] : ends[piece]]
            radius = shot.sizes[piece, 0]
        else:
            half, radius = shot.sizes[piece, 0] / 2.0, shot.sizes[piece, 1]
            corners = np.array([(-half, 0.0), (half, 0.0)])
        key = corners.tobytes() + radius.tobytes()
        if key not in known:
            known[key] = _outline(corners, float(radius), _RIM * view_height)
        found[int(piece)] = known[key]
    return found


def _outline(corners: np.ndarray, radius: float, width: float) -> Outline:
    edges = np.roll(corners, -1, axis=0) - corners
    to_middle = np.sum(_normals(corners) * (corners - corners.mean(axis=0)), axis=1).min()
    thickness = radius + min(to_middle, np.hypot(edges[:, 0], edges[:, 1]).min())
    rim, face = grown(corners, radius), grown(corners, radius - min(width, _RIM_SHARE * thickness))
    vertices = np.zeros((len(rim) + len(face), 3), np.float32)
    vertices[:, :2] = np.vstack([rim, face])
    vertices[: len(rim), 2] = -_RIM_DEPTH
    triangles = np.vstack([_fan(len(rim)), _fan(len(face)) + len(rim)])
    return Outline(vertices, np.arange(len(vertices)) >= len(rim), triangles.astype(np.uint32))


def grown(corners: np.ndarray, distance: float) -> np.ndarray:
    """The outline (V, 2) of all points within a distance of a convex polygon, or drawn in if it is negative [m]."""
    after = _normals(corners)
    before = np.roll(after, 1, axis=0)
    if not distance > 0.0:
        return np.asarray(corners + distance * (after + before) / (1.0 + np.sum(after * before, axis=1))[:, None])
    first = np.arctan2(before[:, 1], before[:, 0])
    turn = np.remainder(np.arctan2(after[:, 1], after[:, 0]) - first, 2.0 * np.pi)
    angles = first[:, None] + turn[:, None] * np.linspace(0.0, 1.0, _ARC_POINTS)
    arcs = distance * np.stack([np.cos(angles), np.sin(angles)], axis=2)
    return np.asarray(corners[:, None] + arcs).reshape(-1, 2)


def _normals(corners: np.ndarray) -> np.ndarray:
    """(n, 2) outward unit normals of the edges from each corner to the next."""
    edges = np.roll(corners, -1, axis=0) - corners
    return np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(edges[:, 0], edges[:, 1])[:, None]


def _fan(count: int) -> np.ndarray:
    """The triangles of a convex outline with so many points."""
    second = np.arange(1, count - 1)
    return np.column_stack([np.zeros_like(second), second, second + 1])
