"""A chain of pieces, each handed with its ghosts to the collider of a piece and a shape."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from engine.narrow_phase.chain_circle import collide_chain_circle
from engine.narrow_phase.chain_hull import collide_chain_hull
from engine.vec2 import Vec2
from tests.engine.narrow_phase.shape_pairs import load, normal_of, place, points_of
from tests.naive.convex import Rounded

SOLID_KINDS = ("circle", "box", "capsule", "polygon")


class Piece(NamedTuple):
    """One piece of a chain, in the world, and its ghosts in its own frame [m]."""

    segment: Rounded
    ghost1: tuple[float, float]
    ghost2: tuple[float, float]


class Contact(NamedTuple):
    """One point of one piece's manifold."""

    piece: int
    normal: np.ndarray
    point: np.ndarray
    separation: float
    feature: int


def pieces(points: Any, *, closed: bool = False, go_on: bool = False) -> list[Piece]:
    """All pieces. The ghost of an open end is that end itself, or with `go_on` a continuation of the last piece."""
    p = np.asarray(points, float)
    n = len(p)
    found = []
    for k in range(n if closed else n - 1):
        a, b = p[k], p[(k + 1) % n]
        (dx, dy), middle = b - a, 0.5 * (a + b)
        half = 0.5 * math.hypot(dx, dy)
        axes = np.array([[dx, dy], [-dy, dx]]) / (2 * half)
        end = 3 * half if go_on else half
        ghost1, ghost2 = (-end, 0.0), (end, 0.0)
        if closed or k > 0:
            ghost1 = tuple(axes @ (p[(k - 1) % n] - middle))
        if closed or k + 2 < n:
            ghost2 = tuple(axes @ (p[(k + 2) % n] - middle))
        segment = Rounded(((-half, 0.0), (half, 0.0)), 0.0, float(middle[0]), float(middle[1]), math.atan2(dy, dx))
        found.append(Piece(segment, ghost1, ghost2))
    return found


def collide_chain(chain: list[Piece], kind: str, shape: Rounded, margin: float, real: Any) -> list[Contact]:
    """All contacts of a shape with all pieces."""
    found = []
    for k, piece in enumerate(chain):
        # reckoned from the piece, as the engine reckons from near the pair
        here = piece.segment.center
        (center1, q1), (center2, q2) = place(piece.segment.moved(-here), real), place(shape.moved(-here), real)
        half, radius, near = real(piece.segment.points[1][0]), real(shape.radius), real(margin)
        ghosts = Vec2(*map(real, piece.ghost1)), Vec2(*map(real, piece.ghost2))
        if kind == "circle":
            manifold = collide_chain_circle(half, *ghosts, center1, q1, radius, center2, near)
        else:
            scratch = np.zeros((8, 4), real)
            count = load(kind, shape, real, scratch)
            manifold = collide_chain_hull(half, *ghosts, center1, q1, scratch, count, radius, center2, q2, near)
        found += [Contact(k, normal_of(manifold), point + here, s, f) for point, s, f in points_of(manifold)]
    return found
