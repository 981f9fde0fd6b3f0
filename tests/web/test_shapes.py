"""What each kind of shape is drawn from: areas, outlines, and a chain's solid side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import SHAPE_KINDS, Capsule, Polygon
from sandbox.frame import Frame
from tests.web.fake_session import BODY, make_frame
from web.batches import Poses
from web.chains import BAND_WIDTH, joint_turns
from web.outlines import grown, reach
from web.parts import RIM_SHARE, Loose, Part, Pieces
from web.polygons import MOST_OUTLINES, outlines_of
from web.shapes import SHAPE_LOOKS
from web.stage import Layer

VIEW = 20.0  # height of the view [m]


def drawn(frame: Frame, layer: Layer) -> list[np.ndarray]:
    """All triangles of a layer in the world, each (3, 2)."""
    triangles: list[np.ndarray] = []
    poses = Poses.of(frame)
    for part in parts_of(frame):
        if part.layer != layer:
            continue
        if isinstance(part, Loose):
            triangles += list(poses.to_world(part.pieces, part.vertices)[part.faces])
            continue
        flat = part.mesh.faces[np.all(part.mesh.vertices[part.mesh.faces][:, :, 2] == 0.0, axis=1)]  # without marks
        for piece, scale, offset in zip(part.pieces, part.scales, part.offsets, strict=True):
            corners = part.mesh.vertices[:, :2] * scale + offset
            triangles += list(poses.to_world(np.full(len(corners), piece), corners)[flat])
    return triangles


def parts_of(frame: Frame) -> list[Part | Loose]:
    found: list[Part | Loose] = []
    for kind, name in enumerate(SHAPE_KINDS):
        members = np.flatnonzero(frame.shape_kinds == kind)
        if len(members):
            found += SHAPE_LOOKS[name](Pieces(frame, members, VIEW))
    return found


def covers(triangles: list[np.ndarray], x: float, y: float) -> bool:
    """Whether a point lies in one of them, whichever way round they are."""
    for a, b, c in triangles:
        sides = [
            (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))
        ]  # fmt: skip
        if (min(sides) >= -1e-9 or max(sides) <= 1e-9) and max(map(abs, sides)) > 0.0:
            return True
    return False


def area(outline: np.ndarray) -> float:
    x, y = outline.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def test_every_kind_has_a_look() -> None:
    assert set(SHAPE_LOOKS) == set(SHAPE_KINDS)


@pytest.mark.parametrize(
    ("body", "inside", "outside"),
    [
        (("dynamic", "box", 4.0, 2.0, 1.0, 1.0, 0.5), [(1.0, 1.0), (2.6, 1.9)], [(3.2, 0.0), (1.0, 2.4)]),
        (("dynamic", "circle", 1.0, 0.0, 1.0, 1.0, 0.5), [(1.68, 1.68), (0.1, 1.0)], [(1.75, 1.75)]),
        (("dynamic", "capsule", 2.0, 0.5, 0.0, 0.0, np.pi / 2), [(0, 1.45), (0.45, 1), (0.3, 1.3)], [(0.4, 1.4)]),
        (("dynamic", "polygon", 0.0, 0.0, 0.0, 0.0, 0.0), [(0.9, 0.0), (-0.8, 0.0)], [(-0.83, 0.0), (1.01, 0.0)]),
        (("dynamic", "polygon", 0.3, 0.0, 0.0, 0.0, 0.0), [(1.29, 0.0), (-1.1, 0.0)], [(-1.12, 0.0), (1.31, 0.0)]),
        (("static", "segment", 4.0, 0.0, 0.0, 2.0, 0.0), [(1.9, 2.04), (-1.9, 1.96)], [(0, 2.06), (0, 1.94), (2.1, 2)]),
    ],
)  # fmt: skip
def test_it_is_drawn_where_it_is(body: BODY, inside: list[tuple], outside: list[tuple]) -> None:
    frame = make_frame([body])
    layer = Layer.FACE if body[1] == "segment" else Layer.RIM
    assert all(covers(drawn(frame, layer), *point) for point in inside)
    assert not any(covers(drawn(frame, layer), *point) for point in outside)
    edge = np.array(inside[0])
    if layer == Layer.RIM and body[1] != "box" and body[1] != "circle":
        assert not covers(drawn(frame, Layer.FACE), *(edge * 1.0 + 0.02 * np.sign(edge))), "a rim is left around it"


def test_pieces_are_drawn_in_the_frames_of_their_bodies() -> None:
    frame = make_frame([("dynamic", "box", 1.0, 1.0, 3.0, 0.0, np.pi / 2), ("dynamic", "circle", 0.2, 0.0, 0, 0, 0)])
    frame = replace(frame, owners=np.array([0, 0]), places=np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0)]))
    assert covers(drawn(frame, Layer.RIM), 3.1, 2.0)
    assert not covers(drawn(frame, Layer.RIM), 5.0, 0.0)


# --- polygons ---------------------------------------------------------------------------------------------------------


def regular(corners: int, size: float = 1.0, turn: float = 0.0) -> np.ndarray:
    turns = turn + 2.0 * np.pi * np.arange(corners) / corners
    return size * np.column_stack([np.cos(turns), np.sin(turns)])


def test_equal_polygons_are_one_mesh_whatever_their_number() -> None:
    frame = make_frame([("dynamic", "polygon", 0.1, 0.0, k, 0.0, 0.0) for k in range(1000)])
    rim, face = parts_of(frame)
    assert isinstance(rim, Part)
    assert isinstance(face, Part)
    assert rim.mesh.name == face.mesh.name
    assert len(rim.pieces) == len(face.pieces) == 1000


def test_polygons_of_many_kinds_take_few_meshes() -> None:
    corners = [regular(3 + k % 6, 0.3 + 0.01 * k) for k in range(50)] + [regular(5)] * 9
    bodies: list[BODY] = [("dynamic", "polygon", 0.05 * (k % 3), 0.0, 3.0 * k, 0.0, 0.3) for k in range(50)]
    bodies += [("dynamic", "polygon", 0.1, 0.0, 3.0 * (50 + k), 0.0, 0.0) for k in range(9)]
    frame = make_frame(bodies, corners)
    parts = parts_of(frame)
    assert len(parts) == 2 * MOST_OUTLINES + 2
    assert len(next(part for part in parts if isinstance(part, Part)).pieces) == 9, "the most frequent come first"
    rims, faces = drawn(frame, Layer.RIM), drawn(frame, Layer.FACE)
    for k, (own, body) in enumerate(zip(corners, bodies, strict=True)):
        c, s = np.cos(body[6]), np.sin(body[6])
        for share, radius in ((0.9, 0.0), (1.02, body[2])):
            x, y = own[1] * share
            x, y = 3.0 * k + c * x - s * y, s * x + c * y
            assert covers(rims, x, y) == (share < 1.0 or radius > 0.03)
        assert covers(faces, 3.0 * k, 0.0)


@given(st.integers(3, 8), st.floats(0.0, 0.5), st.floats(0.0, 6.0))
def test_a_rounded_outline_has_the_polygons_own_area(corners: int, radius: float, turn: float) -> None:
    points = regular(corners, 1.0, turn)
    outline = grown(points, radius)
    assert area(outline) == pytest.approx(Polygon(points.tolist(), radius).area, rel=0.01)
    assert area(outline) <= Polygon(points.tolist(), radius).area + 1e-9


def test_two_corners_grow_into_a_capsule() -> None:
    outline = grown(np.array([(-1.0, 0.0), (1.0, 0.0)]), 0.5)
    assert area(outline) == pytest.approx(Capsule(2.0, 0.5).area, rel=0.01)


@given(st.lists(st.floats(0.02, 2.0), min_size=3, max_size=8), st.floats(0.0, 0.3), st.floats(0.2, 5.0))
def test_a_face_lies_within_its_rim_and_goes_round_once(gaps: list[float], radius: float, stretch: float) -> None:
    """However thin the polygon, and however near its corners are to each other."""
    turns = np.cumsum(gaps) / sum(gaps) * 2.0 * np.pi
    if max(np.diff(turns, append=turns[0] + 2.0 * np.pi)) > 3.0:
        return  # no polygon around its middle
    corners = np.column_stack([stretch * np.cos(turns), np.sin(turns)])
    rim, face = outlines_of(corners, radius, 0.09)
    assert 0.0 < area(face) < area(rim)
    edges = np.roll(face, -1, axis=0) - face
    following = np.roll(edges, -1, axis=0)
    assert np.all(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > -1e-9), (
        "convex, and the same way round"
    )
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    assert RIM_SHARE < 1.0
    assert reach(corners) > 0.0
    assert np.all(np.isfinite(normals))


# --- chains -----------------------------------------------------------------------------------------------------------


def chain(points: list[tuple[float, float]], closed: bool = False) -> Frame:
    """A static body with this chain."""
    following = [*points[1:], points[0]] if closed else points[1:]
    pairs = [(np.array(a), np.array(b)) for a, b in zip(points, following, strict=False)]
    frame = make_frame([("static", "chain", float(np.hypot(*(b - a))), 0.0, 0.0, 0.0, 0.0) for a, b in pairs])
    places = [(*(0.5 * (a + b)), np.arctan2(*(b - a)[::-1])) for a, b in pairs]
    return replace(frame, owners=np.zeros(len(pairs), np.int64), places=np.array(places))


def test_a_chain_is_drawn_on_its_solid_side() -> None:
    """A floor from left to right: its normal is up, so below it all is solid."""
    frame = chain([(-2.0, 1.0), (0.0, 1.0), (2.0, 1.0)])
    bands, lines = drawn(frame, Layer.RIM), drawn(frame, Layer.FACE)
    depth = BAND_WIDTH * VIEW
    for x in (-1.9, 0.0, 1.9):
        assert covers(bands, x, 1.0 - 0.9 * depth)
        assert covers(lines, x, 0.99)
        assert not covers(bands, x, 1.01)
        assert not covers(bands, x, 1.0 - 1.1 * depth)


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_closed_chain_is_solid_within_or_without_and_its_corners_are_whole(clockwise: bool) -> None:
    points = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
    frame = chain(points[::-1] if clockwise else points, closed=True)
    assert joint_turns(frame, np.arange(4)) == pytest.approx(np.full((4, 2), np.pi / 2 * (-1 if clockwise else 1)))
    bands = drawn(frame, Layer.RIM)
    for x, y in points:
        outward = np.sign([x - 2.0, y - 1.5])
        for away in (0.05, 0.15, 0.25):
            inner, outer = np.array([x, y]) - away * outward, np.array([x, y]) + away * outward
            assert covers(bands, *inner) == clockwise
            assert covers(bands, *outer) == (not clockwise)


def test_the_ends_of_an_open_chain_and_of_others_do_not_turn() -> None:
    frame = chain([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0)])
    turns = joint_turns(frame, np.arange(2))
    assert turns == pytest.approx(np.array([(0.0, np.pi / 4), (np.pi / 4, 0.0)]))
    apart = replace(frame, owners=np.array([0, 1]))
    assert not joint_turns(apart, np.arange(2)).any()
    assert joint_turns(frame, np.zeros(0, np.int64)).shape == (0, 2)


def test_a_spike_does_not_stick_out_of_its_chain() -> None:
    """Where the solid is sharp, both bands end where they meet."""
    frame = chain([(-1.0, 0.0), (0.0, 2.0), (1.0, 0.0)])
    bands = drawn(frame, Layer.RIM)
    assert covers(bands, 0.0, 1.95)
    assert covers(bands, 0.3, 1.3)
    for side in (-1.0, 1.0):
        assert not covers(bands, side * 0.2, 1.85)
