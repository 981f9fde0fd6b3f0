"""Every pair of shapes: the other order, the pair moved as one, and what a feature is worth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.narrow_phase.manifold_points import CORNER_GAP, FACE_TOLERANCE, Manifold, mirrored
from tests.engine.narrow_phase.shape_pairs import (
    PAIRS,
    REALS,
    SHAPES,
    at_gap,
    box,
    collide,
    collide_as_hulls,
    normal_of,
    points_of,
    two,
)
from tests.naive.convex import Rounded, signed_distance

pytestmark = pytest.mark.kernel

TOLERANCE = 1.5 * FACE_TOLERANCE  # [m]: a face that is as good as the best but for FACE_TOLERANCE may be taken
TIE = 1e-3  # two edges that face the other shape as well as that are equally good

every_pair = pytest.mark.parametrize("kinds", PAIRS, ids="-".join)
few = settings(max_examples=20, deadline=None)
margins = st.sampled_from([0.0, 0.02, 1.0, 5.0])
reals = st.sampled_from(REALS)


def deepest(manifold: Manifold) -> float:
    return min(separation for _, separation, _ in points_of(manifold))


def features(manifold: Manifold) -> set[int]:
    found = {feature for _, _, feature in points_of(manifold)}
    assert len(found) == manifold.count  # no two alike
    return found


def tied(first: Rounded, second: Rounded, normal: np.ndarray) -> bool:
    """Whether two edges of a shape face the other equally: rounding chooses the one that is clipped."""
    for shape, out in ((first, normal), (second, -normal)):
        facing = sorted(edge @ out for edge in shape.normals)
        if len(facing) > 1 and facing[-1] - facing[-2] < TIE:
            return True
    return False


def in_other_order(kinds: tuple[str, str], first: Rounded, second: Rounded, margin: float, real: type) -> Manifold:
    """The same pair handed over in the other order, to the collider itself and not through `mirrored`."""
    if kinds[0] == kinds[1]:
        return collide(kinds, second, first, margin, real)
    if set(kinds) == {"capsule", "segment"}:
        return collide(("capsule", "capsule"), second, first, margin, real)
    return collide_as_hulls(kinds[::-1], second, first, margin, real)


@pytest.mark.parametrize("kinds", [kinds for kinds in PAIRS if kinds[0] == kinds[1] or "circle" not in kinds])
@few
@given(data=st.data(), margin=margins, real=reals)
def test_other_order_is_the_mirror_image(kinds, data, margin, real) -> None:
    first, second = data.draw(two(kinds))
    here, there = collide(kinds, first, second, margin, real), in_other_order(kinds, first, second, margin, real)
    if here.count and there.count:
        assert deepest(here) == pytest.approx(deepest(there), abs=TOLERANCE)
    assume(normal_of(here) @ normal_of(there) < -0.999)  # else there are two ways out
    assume(not tied(first, second, normal_of(here)) and here.count == there.count)
    assert features(here) == features(mirrored(there))


def test_mirror_of_the_mirror_image() -> None:
    manifold = collide(("box", "box"), box(1.0, 0.5), box(0.5, 0.5, y=0.99, angle=0.01), 0.02, np.float64)
    assert mirrored(mirrored(manifold)) == manifold
    feature = int(manifold.feature1)
    assert mirrored(manifold).feature1 == (feature & 0xFF) << 8 | feature >> 8


@every_pair
@few
@given(data=st.data(), turn=st.floats(-3, 3), x=st.floats(-5, 5), y=st.floats(-5, 5), real=reals)
def test_the_pair_may_be_moved_and_turned_as_one(kinds, data, turn, x, y, real) -> None:
    first, second = data.draw(two(kinds))
    assume(first.radius + second.radius > 0 or abs(signed_distance(first, second)) > CORNER_GAP + TOLERANCE)
    here = collide(kinds, first, second, 5.0, real)
    moved = [shape.turned_about_origin(turn).moved(np.array([x, y])) for shape in (first, second)]
    there = collide(kinds, moved[0], moved[1], 5.0, real)
    assert deepest(here) == pytest.approx(deepest(there), abs=TOLERANCE)
    c, s = math.cos(turn), math.sin(turn)
    axes = np.array([[c, s], [-s, c]])
    assume(normal_of(here) @ axes @ normal_of(there) > 0.999)  # else there are two ways out
    assume(not tied(first, second, normal_of(here)) and here.count == there.count)
    ours = {feature: (*(point @ axes + [x, y]), separation) for point, separation, feature in points_of(here)}
    theirs = {feature: (*point, separation) for point, separation, feature in points_of(there)}
    assert ours.keys() == theirs.keys()
    for feature, values in ours.items():
        assert values == pytest.approx(theirs[feature], abs=2e-3)


@every_pair
@few
@given(data=st.data(), dx=st.floats(-1, 1), dy=st.floats(-1, 1), da=st.floats(-1, 1), real=reals)
def test_features_stay_through_tiny_motions(kinds, data, dx, dy, da, real) -> None:
    """What resting shapes do in a step."""
    first, second = data.draw(two(kinds))
    after = replace(second, x=second.x + 1e-6 * dx, y=second.y + 1e-6 * dy, angle=second.angle + 1e-6 * da)
    here, there = collide(kinds, first, second, 5.0, real), collide(kinds, first, after, 5.0, real)
    assume(normal_of(here) @ normal_of(there) > 0.999)
    assume(not tied(first, second, normal_of(here)) and here.count == there.count)
    assert features(here) == features(there)


@pytest.mark.parametrize("real", REALS)
def test_a_box_sliding_on_a_box_keeps_its_features(real) -> None:
    """Through turns that change the reference face, and over the places where its corners pass the other's."""
    for angle in (-2e-3, -1e-6, 0.0, 1e-6, 2e-3):
        for x in np.linspace(-0.9, 0.9, 19):
            found = collide(("box", "box"), box(1.0, 0.5), box(0.5, 0.5, x=x, y=0.995, angle=angle), 0.02, real)
            assert features(found) == {1 | 0 << 8, 2 | 3 << 8}


@few
@given(first=SHAPES["box"], second=SHAPES["box"], gap=st.floats(-0.05, 0.03), margin=margins, real=reals)
def test_two_boxes_as_hulls_are_the_same(first, second, gap, margin, real) -> None:
    first, second = at_gap(first, second, gap)
    here = collide(("box", "box"), first, second, margin, real)
    there = collide_as_hulls(("box", "box"), first, second, margin, real)
    if here.count and there.count:
        assert deepest(here) == pytest.approx(deepest(there), abs=TOLERANCE)
    assume(normal_of(here) @ normal_of(there) > 0.999)
    assume(not tied(first, second, normal_of(here)) and here.count == there.count)
    assert features(here) == features(there)


@every_pair
@settings(max_examples=10, deadline=None)
@given(data=st.data())
def test_both_precisions_agree(kinds, data) -> None:
    first, second = data.draw(two(kinds))
    assume(first.radius + second.radius > 0 or abs(signed_distance(first, second)) > CORNER_GAP + TOLERANCE)
    single, double = (collide(kinds, first, second, 5.0, real) for real in REALS)
    assert deepest(single) == pytest.approx(deepest(double), abs=TOLERANCE)
