"""Every pair of shapes, compared with tests/naive/convex.py: every corner against every edge."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.narrow_phase.manifold_points import CORNER_GAP, FACE_TOLERANCE
from tests.engine.narrow_phase.shape_pairs import (
    PAIRS,
    REALS,
    box,
    capsule,
    collide,
    normal_of,
    points_of,
    two,
)
from tests.naive.convex import Rounded, distance_to_edges, signed_distance

pytestmark = pytest.mark.kernel

TOLERANCE = 1.5 * FACE_TOLERANCE  # [m]: a face that is as good as the best but for FACE_TOLERANCE may be taken

every_pair = pytest.mark.parametrize("kinds", PAIRS, ids="-".join)
few = settings(max_examples=50, deadline=None)
margins = st.sampled_from([0.0, 0.02, 1.0, 5.0])
reals = st.sampled_from(REALS)


@every_pair
@few
@given(data=st.data(), margin=margins, real=reals)
def test_deepest_point_is_the_signed_distance(kinds, data, margin, real) -> None:
    first, second = data.draw(two(kinds))
    expected = signed_distance(first, second)
    assume(abs(expected - margin) > TOLERANCE)
    manifold = collide(kinds, first, second, margin, real)
    found = points_of(manifold)
    normal = normal_of(manifold)
    assert normal @ normal == pytest.approx(1.0, abs=1e-6)
    if expected > margin:
        assert not found
    elif first.radius + second.radius == 0 and abs(expected) < CORNER_GAP + TOLERANCE:
        # sharp corners that all but coincide need no contact
        assert all(separation > expected - TOLERANCE for _, separation, _ in found)
    else:
        deepest = min(separation for _, separation, _ in found)
        assert deepest == pytest.approx(expected, abs=TOLERANCE)
        # and that is the move that parts them, from 1 to 2
        assert signed_distance(first, second.moved(-deepest * normal)) == pytest.approx(0.0, abs=2 * TOLERANCE)


@every_pair
@few
@given(data=st.data(), margin=margins, real=reals)
def test_points_lie_midway_between_the_surfaces(kinds, data, margin, real) -> None:
    first, second = data.draw(two(kinds))
    manifold = collide(kinds, first, second, margin, real)
    normal = normal_of(manifold)
    for point, separation, _ in points_of(manifold):
        assert separation <= margin
        for shape, side in ((first, -1), (second, 1)):
            on_core = point + side * normal * (0.5 * separation + shape.radius)
            assert distance_to_edges(on_core, shape.edges) < TOLERANCE


@every_pair
@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("offset", [0.0, 5e-324, 1e-170, 1e-40, 1e-20, 1e-9])
def test_centre_on_centre_is_finite(kinds, real, offset) -> None:
    shapes = {
        "box": box(1.0, 0.5),
        "circle": Rounded(((0.0, 0.0),), 0.7),
        "capsule": capsule(1.0, 0.3),
        "polygon": Rounded(((0.5, -0.5), (0.6, 0.5), (-0.5, 0.5)), 0.1),
        "segment": capsule(1.0, 0.0),
    }
    for angle in (0.0, math.pi / 4, math.pi / 2, math.pi):
        first, second = shapes[kinds[0]], replace(shapes[kinds[1]], x=offset, angle=angle)
        manifold = collide(kinds, first, second, 0.02, real)
        normal = normal_of(manifold)
        assert normal @ normal == pytest.approx(1.0, abs=1e-6)
        found = points_of(manifold)
        assert np.isfinite([point for point, _, _ in found]).all()
        assert min(s for _, s, _ in found) == pytest.approx(signed_distance(first, second), abs=TOLERANCE)


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("gap", [-0.3, 0.0, 1e-8, 1e-3, 0.019])
@pytest.mark.parametrize("turn", [0.0, 0.3, 2.0])
@pytest.mark.parametrize("tilt", [0.0, 1e-6, -1e-5])
def test_capsules_end_to_end_touch_by_their_ends(real, gap, turn, tilt) -> None:
    """Their normals separate them hardly or not at all: both lie in one line."""
    first, second = capsule(1.0, 0.25), capsule(0.5, 0.25, x=2.0 + gap, angle=tilt)
    manifold = collide(
        ("capsule", "capsule"), first.turned_about_origin(turn), second.turned_about_origin(turn), 0.02, real
    )
    assert manifold.count == 1
    assert manifold.separation1 == pytest.approx(gap, abs=1e-5)
    assert normal_of(manifold) == pytest.approx([math.cos(turn), math.sin(turn)], abs=1e-4)


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize("tilt", [0.0, 1e-3, -0.01])
def test_capsules_side_by_side_touch_in_two_points(real, tilt) -> None:
    manifold = collide(("capsule", "capsule"), capsule(1.0, 0.25), capsule(0.5, 0.25, y=0.499, angle=tilt), 0.02, real)
    assert sorted(point[0] for point, _, _ in points_of(manifold)) == pytest.approx([-0.5, 0.5], abs=0.01)


@pytest.mark.parametrize("real", REALS)
def test_boxes_corner_to_corner(real) -> None:
    away = 1.0 + 0.01 / math.sqrt(2)
    manifold = collide(("box", "box"), box(0.5, 0.5), box(0.5, 0.5, x=away, y=away), 0.02, real)
    assert manifold.count == 1
    assert manifold.separation1 == pytest.approx(0.01, abs=1e-6)
    assert normal_of(manifold) == pytest.approx([math.sqrt(0.5)] * 2, abs=1e-4)
    assert collide(("box", "box"), box(0.5, 0.5), box(0.5, 0.5, x=1.0, y=1.0), 0.02, real).count == 0


@pytest.mark.parametrize("real", REALS)
def test_rounded_corners_touch_along_the_line_between_them(real) -> None:
    triangle = ((0.5, 0.0), (-0.5, 0.5), (-0.5, -0.5))
    first = Rounded(triangle, 0.1)
    second = Rounded(triangle, 0.2, x=0.5 + 0.3 * math.cos(0.4) + 0.5, y=0.3 * math.sin(0.4), angle=math.pi)
    manifold = collide(("polygon", "polygon"), first, second, 0.02, real)
    assert manifold.count == 1
    assert manifold.separation1 == pytest.approx(0.0, abs=1e-6)
    assert normal_of(manifold) == pytest.approx([math.cos(0.4), math.sin(0.4)], abs=1e-5)
