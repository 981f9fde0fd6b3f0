"""Pieces of a chain: together like one solid with one surface, and nothing from behind."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.narrow_phase.manifold_points import CORNER_GAP, FACE_TOLERANCE
from tests.engine.narrow_phase.chains import SOLID_KINDS, collide_chain, pieces
from tests.engine.narrow_phase.shape_pairs import REALS, SHAPES, at_gap, box, capsule
from tests.naive.convex import Rounded, signed_distance

pytestmark = pytest.mark.kernel

TOLERANCE = 1.5 * FACE_TOLERANCE  # [m], as in test_pairs.py
MARGIN = 0.02

every_kind = pytest.mark.parametrize("kind", SOLID_KINDS)
few = settings(max_examples=40, deadline=None)
reals = st.sampled_from(REALS)
turns = st.sampled_from([0.0, 0.3, -2.0])

FLAT = [(x, 0.0) for x in (-6.0, -3.0, -2.9, -1.0, 0.0, 0.05, 0.1, 0.7, 2.0, 6.0)]


def lowest(shape: Rounded) -> float:
    return float(shape.corners[:, 1].min()) - shape.radius


def turned(points: list[tuple[float, float]], angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array(points) @ np.array([[c, s], [-s, c]])


def ellipse(steps: list[float], height: float) -> np.ndarray:
    """Clockwise: the solid is inside."""
    angles = -np.cumsum(steps) * (2 * math.pi / sum(steps))
    return np.stack([1.5 * np.cos(angles), height * np.sin(angles)], axis=1)


islands = st.builds(ellipse, st.lists(st.floats(0.5, 1.0), min_size=3, max_size=24), st.sampled_from([0.3, 0.8, 1.5]))


@every_kind
@few
@given(data=st.data(), depth=st.floats(0, 0.03), turn=turns, real=reals)
def test_no_edge_is_felt_on_a_flat_chain(kind, data, depth, turn, real) -> None:
    shape = data.draw(SHAPES[kind])
    shape = shape.moved(np.array([0.0, -lowest(shape) - depth]))
    found = collide_chain(pieces(turned(FLAT, turn)), kind, shape.turned_about_origin(turn), MARGIN, real)
    for contact in found:
        assert contact.normal == pytest.approx([-math.sin(turn), math.cos(turn)], abs=1e-6)
    assert min(contact.separation for contact in found) == pytest.approx(-depth, abs=1e-5)


@every_kind
@few
@given(data=st.data(), angle=st.floats(0, 6.3), points=islands, gap=st.floats(-0.01, 0.015), real=reals)
def test_a_clockwise_chain_is_a_convex_island(kind, data, angle, points, gap, real) -> None:
    """Pieces only know their neighbours, and yet agree with the whole."""
    island = Rounded(tuple(map(tuple, points[::-1])))
    shape = data.draw(SHAPES[kind])
    shape = shape.moved(np.array([math.cos(angle), math.sin(angle)]) - shape.center)
    _, shape = at_gap(island, shape, gap)
    expected = signed_distance(island, shape)
    assume(shape.radius > 0 or abs(expected) > CORNER_GAP + TOLERANCE)
    assume(gap - TOLERANCE < expected < MARGIN - TOLERANCE)
    found = collide_chain(pieces(points, closed=True), kind, shape, MARGIN, real)
    deepest = min(found, key=lambda contact: contact.separation)
    assert deepest.separation == pytest.approx(expected, abs=TOLERANCE)
    away = shape.moved(-deepest.separation * deepest.normal)
    assert signed_distance(island, away) == pytest.approx(0.0, abs=2 * TOLERANCE)


@every_kind
@few
@given(data=st.data(), angle=st.floats(0, 6.3), points=islands, gap=st.floats(-0.01, 0.015), real=reals)
def test_a_corner_belongs_to_one_piece(kind, data, angle, points, gap, real) -> None:
    """No normal but the pieces' own is found at one place by two."""
    island = Rounded(tuple(map(tuple, points[::-1])))
    shape = data.draw(SHAPES[kind])
    shape = shape.moved(np.array([math.cos(angle), math.sin(angle)]) - shape.center)
    _, shape = at_gap(island, shape, gap)
    found = collide_chain(pieces(points, closed=True), kind, shape, MARGIN, real)
    edges = np.roll(points, -1, axis=0) - points
    own = np.stack([-edges[:, 1], edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1)[:, None]
    at_corners = [c for c in found if c.normal @ own[c.piece] < 1 - 1e-4]
    for i, contact in enumerate(at_corners):
        for other in at_corners[:i]:
            assert contact.piece == other.piece or np.linalg.norm(contact.point - other.point) > 1e-4


@every_kind
@few
@given(data=st.data(), angle=st.floats(0, 6.3), points=islands, gap=st.floats(-0.01, 0.015), real=reals)
def test_no_normal_leads_into_a_neighbour(kind, data, angle, points, gap, real) -> None:
    """The whole island lies behind every contact; but for the far end of a piece under a face that is hardly tilted."""
    island = Rounded(tuple(map(tuple, points[::-1])))
    shape = data.draw(SHAPES[kind])
    shape = shape.moved(np.array([math.cos(angle), math.sin(angle)]) - shape.center)
    _, shape = at_gap(island, shape, gap)
    slack = TOLERANCE if kind == "circle" else 2 * MARGIN
    for contact in collide_chain(pieces(points, closed=True), kind, shape, MARGIN, real):
        surface = contact.point - 0.5 * contact.separation * contact.normal
        assert ((points - surface) @ contact.normal).max() < slack


@every_kind
@few
@given(data=st.data(), slope=st.floats(0.1, 1.2), x=st.floats(-1, 1), y=st.floats(0, 1.5), real=reals)
def test_a_valley_has_the_normals_of_its_slopes(kind, data, slope, x, y, real) -> None:
    rise = 6 * math.tan(slope)
    shape = data.draw(SHAPES[kind])
    shape = shape.moved(np.array([x, y]) - shape.center)
    points = [(-6.0, rise), (-3.0, rise / 2), (0.0, 0.0), (3.0, rise / 2), (6.0, rise)]
    for contact in collide_chain(pieces(points), kind, shape, MARGIN, real):
        side = math.sin(slope) if contact.piece < 2 else -math.sin(slope)
        assert contact.normal == pytest.approx([side, math.cos(slope)], abs=1e-6)


@every_kind
@few
@given(data=st.data(), x=st.floats(-5.9, 5.9), below=st.floats(0.01, 1.0), real=reals)
def test_nothing_touches_from_behind(kind, data, x, below, real) -> None:
    """Behind is below, between the ends."""
    shape = data.draw(SHAPES[kind])
    middle = shape.corners.mean(axis=0)
    shape = shape.moved(np.array([x, -below]) - middle)
    assert not collide_chain(pieces(FLAT), kind, shape, MARGIN, real)


@pytest.mark.parametrize("real", REALS)
def test_a_plank_under_a_thin_island_does_not_touch_its_top(real) -> None:
    """Its middle lies before the island's short side, and it reaches far behind the top."""
    points = [(0.9, -0.25), (-1.3, -0.13), (-1.2, 0.17), (0.5, 0.28), (1.5, 0.0)]
    found = collide_chain(pieces(points, closed=True), "box", box(0.8, 0.13, x=-1.52, y=-0.29), MARGIN, real)
    assert {contact.piece for contact in found} <= {0, 1}


@pytest.mark.parametrize("real", REALS)
def test_what_stands_exactly_over_a_joint_stands(real) -> None:
    for turn in np.linspace(0, 3, 101):
        chain = pieces(turned([(-1.7, 0.0), (0.0, 0.0), (1.3, 0.0)], turn))
        upright = capsule(0.5, 0.2, y=0.69, angle=math.pi / 2).turned_about_origin(turn)
        corner = box(0.5, 0.5, y=0.5 * math.sqrt(2) - 0.01, angle=math.pi / 4).turned_about_origin(turn)
        ball = Rounded(((0.0, 0.0),), 0.2, y=0.19).turned_about_origin(turn)
        for kind, shape in (("capsule", upright), ("box", corner), ("circle", ball)):
            found = collide_chain(chain, kind, shape, 0.0, real)
            assert min(contact.separation for contact in found) == pytest.approx(-0.01, abs=1e-5)


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("tilt", [-1e-5, 0.0, 1e-5, 1e-4])
def test_a_box_that_overhangs_a_table_rests_on_two_points(real, tilt) -> None:
    table = pieces([(-3.0, -1.0), (-3.0, 0.0), (0.0, 0.0), (0.0, -1.0)])
    found = collide_chain(table, "box", box(0.5, 0.5, x=-0.2, y=0.499, angle=tilt), MARGIN, real)
    assert sorted(contact.point[0] for contact in found) == pytest.approx([-0.7, 0.0], abs=1e-3)
    assert {contact.piece for contact in found} == {1}


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("x", [-0.1, -1e-3])
def test_what_stands_on_a_table_near_its_edge_touches_the_top_alone(real, x) -> None:
    table = pieces([(-3.0, -1.0), (-3.0, 0.0), (0.0, 0.0), (0.0, -1.0)])
    ball = Rounded(((0.0, 0.0),), 0.5, x=x, y=0.5)
    upright = capsule(0.5, 0.3, x=x, y=0.8, angle=math.pi / 2)
    for kind, shape in (("circle", ball), ("capsule", upright)):
        (contact,) = collide_chain(table, kind, shape, MARGIN, real)
        assert contact.piece == 1
        assert contact.normal == pytest.approx([0.0, 1.0], abs=1e-6)


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("tilt", [-0.2, 0.0, 0.2])
def test_a_see_saw_rests_on_the_tip(real, tilt) -> None:
    roof = pieces([(-1.0, -0.5), (0.0, 0.0), (1.0, -0.5)])
    plank = box(1.0, 0.1, y=0.099, angle=tilt)
    (contact,) = collide_chain(roof, "box", plank.moved(np.array([0.0, 0.1 / math.cos(tilt) - 0.1])), MARGIN, real)
    assert contact.point == pytest.approx([0.0, 0.0], abs=1e-3)
    assert contact.normal == pytest.approx([-math.sin(tilt), math.cos(tilt)], abs=1e-6)
    assert contact.piece == 1


@pytest.mark.parametrize("real", REALS)
def test_a_ball_rolls_off_a_free_end(real) -> None:
    points = [(-2.0, 0.0), (0.0, 0.0)]
    for angle in (0.1, 0.8, 1.5):
        ball = Rounded(((0.0, 0.0),), 0.5, x=0.49 * math.sin(angle), y=0.49 * math.cos(angle))
        (contact,) = collide_chain(pieces(points), "circle", ball, MARGIN, real)
        assert contact.normal == pytest.approx([math.sin(angle), math.cos(angle)], abs=1e-5)
        assert contact.point == pytest.approx([0.0, 0.0], abs=6e-3)
        # where the chain is said to go on, its end is no corner
        assert not collide_chain(pieces(points, go_on=True), "circle", ball, MARGIN, real)


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("tilt", [-0.5, -1.2])
def test_a_box_tips_over_a_free_end(real, tilt) -> None:
    middle = np.array([-math.sin(tilt), math.cos(tilt)]) * 0.499
    tipping = box(0.5, 0.5, angle=tilt).moved(middle)
    (contact,) = collide_chain(pieces([(-2.0, 0.0), (-1.0, 0.0), (0.0, 0.0)]), "box", tipping, MARGIN, real)
    assert contact.normal == pytest.approx([-math.sin(tilt), math.cos(tilt)], abs=1e-6)
    assert contact.point == pytest.approx([0.0, 0.0], abs=1e-3)
