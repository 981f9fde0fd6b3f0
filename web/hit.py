"""Which body is under the mouse: every shape that has an area, all pieces at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine import BODY_KINDS, SHAPE_KINDS
from sandbox.frame import Frame

DYNAMIC_BODY = BODY_KINDS.index("dynamic")


def body_at(frame: Frame, x: float, y: float) -> int | None:
    """Index of the dynamic body that covers this point of the world; of several, the one created last."""
    owners = frame.owners[pieces_at(frame, x, y)]
    hits = owners[frame.body_kinds[owners] == DYNAMIC_BODY]
    return int(hits.max()) if len(hits) else None


def solid_at(frame: Frame, x: float, y: float) -> int | None:
    """The same for bodies of all kinds, dynamic ones first."""
    owners = frame.owners[pieces_at(frame, x, y)]
    if not len(owners):
        return None
    return int(max(owners, key=lambda owner: (frame.body_kinds[owner] == DYNAMIC_BODY, owner)))


def pieces_at(frame: Frame, x: float, y: float) -> np.ndarray:
    """(S,) which pieces cover this point of the world. Segments and chains have no area, and cover none."""
    local = _in_pieces(frame, x, y)
    covered = np.zeros(len(local), bool)
    for name, covers in COVERS.items():
        members = np.flatnonzero(frame.shape_kinds == SHAPE_KINDS.index(name))
        if len(members):
            covered[members] = covers(local[members], frame.sizes[members])
    members = np.flatnonzero(frame.corner_counts)
    if len(members):
        covered[members] = _in_polygons(frame, members, local[members])
    return covered


def in_body(frame: Frame, index: int, x: float, y: float) -> np.ndarray:
    """A point of the world in a body's own frame, (2,) [m]."""
    away_x, away_y = np.array([x, y]) - frame.positions[index]
    cosine, sine = np.cos(frame.angles[index]), np.sin(frame.angles[index])
    return np.array([cosine * away_x + sine * away_y, cosine * away_y - sine * away_x])


def in_world(frame: Frame, index: int, local: np.ndarray) -> tuple[float, float]:
    """A point of a body's own frame in the world [m]."""
    x, y = frame.positions[index]
    cosine, sine = np.cos(frame.angles[index]), np.sin(frame.angles[index])
    return float(x + cosine * local[0] - sine * local[1]), float(y + sine * local[0] + cosine * local[1])


def _in_pieces(frame: Frame, x: float, y: float) -> np.ndarray:
    """The point in each piece's own frame, (S, 2) [m]."""
    positions, angles = frame.shape_poses()
    away = np.array([x, y]) - positions
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.column_stack([cosine * away[:, 0] + sine * away[:, 1], cosine * away[:, 1] - sine * away[:, 0]])


def _in_box(local: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    return np.all(np.abs(local) <= sizes / 2.0, axis=1)


def _in_circle(local: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    return np.hypot(local[:, 0], local[:, 1]) <= sizes[:, 0]


def _in_capsule(local: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    beyond = np.maximum(np.abs(local[:, 0]) - sizes[:, 0] / 2.0, 0.0)
    return np.hypot(beyond, local[:, 1]) <= sizes[:, 1]


COVERS: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "box": _in_box,
    "circle": _in_circle,
    "capsule": _in_capsule,
}


def _in_polygons(frame: Frame, members: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Whether the points (K, 2) lie in the polygons, or as near as those are rounded. No others have corners."""
    counts = frame.corner_counts[members].astype(np.int64)
    firsts = np.cumsum(counts) - counts
    owner = np.repeat(np.arange(len(members)), counts)
    following = np.arange(len(owner)) + 1
    following[firsts + counts - 1] = firsts
    edges = frame.corners[following] - frame.corners
    away = local[owner] - frame.corners
    outside = away[:, 0] * edges[:, 1] - away[:, 1] * edges[:, 0]  # > 0: on the outer side of this edge's line
    along = np.clip(np.sum(away * edges, axis=1) / np.sum(edges * edges, axis=1), 0.0, 1.0)
    distance = np.hypot(*(away - along[:, None] * edges).T)
    inside = np.maximum.reduceat(outside, firsts) <= 0.0
    return np.asarray(inside | (np.minimum.reduceat(distance, firsts) <= frame.sizes[members, 0]))
