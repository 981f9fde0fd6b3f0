"""Clipping a segment: what is kept, and which edges the ends remember."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.narrow_phase.clip import EDGE1, EDGE2, EDGE3, EDGE4, NO_EDGE, ClipPoint, clip_segment, pack_feature
from engine.vec2 import Vec2, dot
from tests.naive.boxes import clip

pytestmark = pytest.mark.kernel

A = ClipPoint(Vec2(0.0, 0.0), NO_EDGE, NO_EDGE, EDGE2, EDGE3)
B = ClipPoint(Vec2(4.0, 0.0), NO_EDGE, NO_EDGE, EDGE3, EDGE4)


def test_inside_stays() -> None:
    assert clip_segment(A, B, Vec2(1.0, 0.0), 4.0, EDGE1) == (True, A, B)


def test_outside_goes() -> None:
    assert not clip_segment(A, B, Vec2(1.0, 0.0), -1.0, EDGE1)[0]


def test_cut_end_remembers_the_cutting_edge() -> None:
    whole, p, q = clip_segment(A, B, Vec2(1.0, 0.0), 1.0, EDGE1)
    assert whole
    assert p == A
    assert q == ClipPoint(Vec2(1.0, 0.0), NO_EDGE, EDGE1, EDGE3, NO_EDGE)  # leaves through it


def test_cut_start_comes_last() -> None:
    whole, p, q = clip_segment(A, B, Vec2(-1.0, 0.0), -1.0, EDGE4)
    assert whole
    assert p == B
    assert q == ClipPoint(Vec2(1.0, 0.0), EDGE4, NO_EDGE, NO_EDGE, EDGE3)  # enters through it


def test_an_end_on_the_line_counts_as_inside() -> None:
    assert clip_segment(A, B, Vec2(1.0, 0.0), 4.0, EDGE1)[0]
    assert not clip_segment(A, B, Vec2(1.0, 0.0), 0.0, EDGE1)[0]  # one point is no segment


coordinate = st.floats(-10, 10)


@settings(max_examples=200, deadline=None)
@given(a=st.builds(Vec2, coordinate, coordinate), b=st.builds(Vec2, coordinate, coordinate), offset=coordinate,
       angle=st.floats(0, 6.3))  # fmt: skip
def test_same_as_the_naive_half_plane(a: Vec2, b: Vec2, offset: float, angle: float) -> None:
    normal = Vec2(float(np.cos(angle)), float(np.sin(angle)))
    assume(min(abs(dot(normal, a) - offset), abs(dot(normal, b) - offset)) > 1e-6)
    expected = clip([np.array(a), np.array(b)], np.array(normal), offset)
    whole, p, q = clip_segment(A._replace(v=a), B._replace(v=b), normal, offset, EDGE1)
    assert whole == (len(expected) == 2)
    if whole:
        assert sorted([tuple(p.v), tuple(q.v)]) == [
            pytest.approx(tuple(point), abs=1e-9) for point in sorted(map(tuple, expected))
        ]


def test_feature_packs_four_edges_and_flips() -> None:
    point = ClipPoint(Vec2(0.0, 0.0), 1, 2, 3, 4)
    assert pack_feature(point, False) == 0x4321
    assert pack_feature(point, True) == 0x2143
