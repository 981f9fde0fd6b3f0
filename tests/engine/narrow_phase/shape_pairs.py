"""Any two shapes, drawn by hypothesis, handed to the collider of their pair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st

from engine.jit import kernel
from engine.narrow_phase.box_box import collide_boxes
from engine.narrow_phase.capsules import collide_capsules
from engine.narrow_phase.circles import collide_box_circle, collide_capsule_circle, collide_circles
from engine.narrow_phase.hull_circle import collide_hull_circle
from engine.narrow_phase.hull_hull import collide_hulls
from engine.narrow_phase.hulls import load_box, load_capsule, load_hull
from engine.narrow_phase.manifold_points import Manifold, mirrored
from engine.vec2 import Vec2
from tests.naive.convex import Rounded, signed_distance

HULL = np.dtype([("count", "i8"), ("x", "f8", 8), ("y", "f8", 8), ("nx", "f8", 8), ("ny", "f8", 8)])
KINDS = ("box", "circle", "capsule", "polygon", "segment")
PAIRS = [(a, b) for i, a in enumerate(KINDS) for b in KINDS[i:] if (a, b) != ("segment", "segment")]
REALS = (np.float32, np.float64)

sizes = st.floats(0.1, 1.5)
radii = st.floats(0.05, 1.0)
angles = st.one_of(st.floats(-4, 4), st.sampled_from([0.0, math.pi / 2, math.pi, 1e-6]))
places = {"x": st.floats(-2, 2), "y": st.floats(-2, 2), "angle": angles}


def box(half_x: float, half_y: float, **place: float) -> Rounded:
    return Rounded(((half_x, -half_y), (half_x, half_y), (-half_x, half_y), (-half_x, -half_y)), **place)


def polygon(steps: list[float], width: float, radius: float, shift: float, **place: float) -> Rounded:
    """Corners on an ellipse; its centre need not be the frame's."""
    turns = np.cumsum(steps) * (2 * math.pi / sum(steps))
    return Rounded(tuple((width * math.cos(t) + shift, 0.7 * math.sin(t)) for t in turns), radius, **place)


SHAPES: dict[str, st.SearchStrategy[Rounded]] = {
    "box": st.builds(box, sizes, sizes, **places),
    "circle": st.builds(lambda radius, **place: Rounded(((0.0, 0.0),), radius, **place), radii, **places),
    "capsule": st.builds(lambda half, radius, **place: capsule(half, radius, **place), sizes, radii, **places),
    "polygon": st.builds(
        polygon,
        st.lists(st.floats(0.5, 1.0), min_size=3, max_size=8),
        sizes,
        st.one_of(st.just(0.0), st.floats(0.01, 0.5)),
        st.sampled_from([0.0, 0.4]),
        **places,
    ),
    "segment": st.builds(lambda half, **place: capsule(half, 0.0, **place), sizes, **places),
}


def at_gap(first: Rounded, second: Rounded, gap: float | None) -> tuple[Rounded, Rounded]:
    """The second moved away from the first, or towards it, until they are about that far apart [m]."""
    away = second.center - first.center
    if gap is None or np.linalg.norm(away) < 1e-3:
        return first, second
    near, far = 0.0, 8.0 / float(np.linalg.norm(away))
    for _ in range(14):
        middle = 0.5 * (near + far)
        if signed_distance(first, second.moved((middle - 1.0) * away)) < gap:
            near = middle
        else:
            far = middle
    return first, second.moved((far - 1.0) * away)


def two(kinds: tuple[str, str]) -> st.SearchStrategy[tuple[Rounded, Rounded]]:
    """Two shapes, half of the time moved so that they nearly touch."""
    gaps = st.one_of(st.none(), st.floats(-0.05, 0.03))
    return st.builds(at_gap, SHAPES[kinds[0]], SHAPES[kinds[1]], gaps)


def capsule(half: float, radius: float, **place: float) -> Rounded:
    return Rounded(((-half, 0.0), (half, 0.0)), radius, **place)


def hull_record(points: tuple[tuple[float, float], ...]) -> np.recarray:
    """A row of a hull table. A recarray, so that it has fields without compilation too."""
    table = np.zeros(1, HULL).view(np.recarray)
    p = np.array(points)
    edges = np.roll(p, -1, axis=0) - p
    lengths = np.linalg.norm(edges, axis=1)
    n = len(p)
    table.count[0] = n
    table.x[0, :n], table.y[0, :n] = p.T
    table.nx[0, :n], table.ny[0, :n] = edges[:, 1] / lengths, -edges[:, 0] / lengths
    return table


@kernel
def load_row(table, row, scratch):
    return load_hull(table[row], scratch)


def load(kind: str, shape: Rounded, real: Any, scratch: np.ndarray) -> int:
    points = shape.points
    if kind == "box":
        return load_box(Vec2(real(points[1][0]), real(points[1][1])), scratch)
    if kind == "polygon":
        return load_row(hull_record(points), 0, scratch)
    return load_capsule(real(points[1][0]), scratch)


def place(shape: Rounded, real: Any) -> tuple[Vec2, Vec2]:
    return Vec2(real(shape.x), real(shape.y)), Vec2(real(math.cos(shape.angle)), real(math.sin(shape.angle)))


def collide(kinds: tuple[str, str], first: Rounded, second: Rounded, margin: float, real: Any) -> Manifold:
    """By the pair's own collider, in the order of KINDS or the other."""
    if KINDS.index(kinds[0]) > KINDS.index(kinds[1]):
        return mirrored(collide(kinds[::-1], second, first, margin, real))
    (center1, q1), (center2, q2) = place(first, real), place(second, real)
    radius1, radius2, near = real(first.radius), real(second.radius), real(margin)
    half1, half2 = (Vec2(*map(real, shape.points[1])) if len(shape.points) > 1 else None for shape in (first, second))
    round_ones = {"capsule", "segment"}
    if kinds == ("box", "box"):
        return collide_boxes(half1, center1, q1, half2, center2, q2, near)
    if kinds == ("box", "circle"):
        return collide_box_circle(half1, center1, q1, radius2, center2, near)
    if kinds == ("circle", "circle"):
        return collide_circles(radius1, center1, radius2, center2, near)
    if kinds == ("circle", "polygon"):
        scratch = np.zeros((8, 4), real)
        count = load("polygon", second, real, scratch)
        return mirrored(collide_hull_circle(scratch, count, radius2, center2, q2, radius1, center1, near))
    if kinds[0] == "circle":
        assert half2 is not None
        return mirrored(collide_capsule_circle(half2.x, radius2, center2, q2, radius1, center1, near))
    if set(kinds) <= round_ones:
        assert half1 is not None
        assert half2 is not None
        return collide_capsules(half1.x, radius1, center1, q1, half2.x, radius2, center2, q2, near)
    return collide_as_hulls(kinds, first, second, margin, real)


def collide_as_hulls(kinds: tuple[str, str], first: Rounded, second: Rounded, margin: float, real: Any) -> Manifold:
    """By the general collider, which takes every pair without a circle."""
    (center1, q1), (center2, q2) = place(first, real), place(second, real)
    scratch1, scratch2 = np.zeros((2, 8, 4), real)
    count1, count2 = load(kinds[0], first, real, scratch1), load(kinds[1], second, real, scratch2)
    radius1, radius2 = real(first.radius), real(second.radius)
    return collide_hulls(
        scratch1, count1, radius1, center1, q1, scratch2, count2, radius2, center2, q2, real(margin)
    )  # fmt: skip


def points_of(manifold: Manifold) -> list[tuple[np.ndarray, float, int]]:
    """(point, separation, feature) of each."""
    both = [
        (manifold.point1, manifold.separation1, manifold.feature1),
        (manifold.point2, manifold.separation2, manifold.feature2),
    ]
    return [(np.array([p.x, p.y], float), float(s), int(f)) for p, s, f in both[: int(manifold.count)]]


def normal_of(manifold: Manifold) -> np.ndarray:
    return np.array([manifold.normal.x, manifold.normal.y], float)
