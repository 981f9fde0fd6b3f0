"""Box against box as in the talk, compared with tests/naive/boxes.py: corners on axes, then face clipped to face."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

from engine import Box, World
from engine.constants import FACE_ABSOLUTE_TOLERANCE, FACE_RELATIVE_TOLERANCE
from tests.engine.worlds import touching
from tests.naive.boxes import PlacedBox, contacts_on_face, overlaps

pytestmark = pytest.mark.kernel

TIE = 1e-9  # [m]: closer than this to touching, or to a corner, rounding decides

sizes = st.floats(0.2, 3.0)
angles = st.one_of(st.floats(-4, 4), st.sampled_from([0.0, math.pi / 4, math.pi / 2, 1e-7]))
boxes = st.builds(PlacedBox, st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), angles, sizes, sizes)
pairs = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])


def collide(box1: PlacedBox, box2: PlacedBox, precision: str = "double") -> World:
    first, second = (
        (Box(box.width, box.height), (box.x, box.y), box.angle) for box in (box1, box2)
    )  # fmt: skip
    return touching(first, second, precision)


def contacts_of(world: World) -> np.ndarray:
    records = world.contact_records()
    if len(records):
        assert (records["body1"] == 0).all()
        assert (records["body2"] == 1).all()
    return records


def tied(box1: PlacedBox, box2: PlacedBox) -> bool:
    """Whether rounding decides from which side the boxes meet, or which of two edges faces the other box most."""
    offset = box2.center - box1.center
    aligned = np.abs(box1.axes @ box2.axes.T)
    sides = min(np.abs(box1.axes @ offset).min(), np.abs(box2.axes @ offset).min())
    return sides < 1e-6 or abs(aligned[0, 0] - aligned[0, 1]) < 1e-6


def accepted_faces(depths: np.ndarray, halves: np.ndarray) -> list[int]:
    """Faces that the tolerances allow: none of the others is clearly better."""
    return [
        k
        for k in range(4)
        if (-depths <= FACE_RELATIVE_TOLERANCE * -depths[k] + FACE_ABSOLUTE_TOLERANCE * halves + TIE).all()
    ]


@pairs
@given(box1=boxes, box2=boxes)
@example(box1=PlacedBox(0, 0, 0, 1, 1), box2=PlacedBox(0, 0, 0, 1, 1))
@example(box1=PlacedBox(0, 0, 0, 2, 1), box2=PlacedBox(0, 0.9, math.pi / 4, 1, 1))
def test_touching_and_depth(box1: PlacedBox, box2: PlacedBox) -> None:
    depths = overlaps(box1, box2)
    assume(abs(depths.min()) > TIE)
    found = contacts_of(collide(box1, box2))
    if depths.min() < 0:
        assert len(found) == 0
        return
    assert 1 <= len(found) <= 2
    deepest = -found["separation"].min()
    # of an axis that is not the best by more than the face tolerances
    largest = max(depths[k] for k in accepted_faces(depths, np.concatenate([box1.half, box2.half])))
    assert 0 <= deepest <= largest + TIE
    assert FACE_RELATIVE_TOLERANCE * largest <= depths.min() + FACE_ABSOLUTE_TOLERANCE * 1.5 + TIE


@pairs
@given(box1=boxes, box2=boxes)
@example(box1=PlacedBox(0, 0, 0, 1, 1), box2=PlacedBox(0.2, 0.98, 0, 1, 1))
@example(box1=PlacedBox(0, 0, 0, 1, 1), box2=PlacedBox(0.7, 0.7, math.pi / 4, 0.2, 0.2))
def test_contacts_are_the_clipped_face(box1: PlacedBox, box2: PlacedBox) -> None:
    depths = overlaps(box1, box2)
    assume(depths.min() > TIE and not tied(box1, box2))
    found = contacts_of(collide(box1, box2))
    normal = np.array([found["nx"][0], found["ny"][0]])
    candidates = []
    for k in accepted_faces(depths, np.concatenate([box1.half, box2.half])):
        reference, other = (box1, box2) if k < 2 else (box2, box1)
        axis = reference.axes[k % 2]
        outward = normal if k < 2 else -normal
        if abs(axis @ outward) > 1 - 1e-12:
            candidates.append(contacts_on_face(reference, other, outward))
    assert any(same_contacts(found, expected) for expected in candidates), (found, candidates)


def same_contacts(found: np.ndarray, expected: list[tuple[np.ndarray, float]]) -> bool:
    """Whether every contact is among the others', but for ends that rounding may leave out or cut off."""
    points = [(np.array([record["x"], record["y"]]), float(record["separation"])) for record in found]

    def among(contact, others):
        return any(
            np.abs(contact[0] - other[0]).max() < 10 * TIE and abs(contact[1] - other[1]) < 10 * TIE for other in others
        )

    return all(among(point, expected) for point in points) and all(
        among(contact, points) or abs(contact[1]) < TIE for contact in expected
    )


@pairs
@given(box1=boxes, box2=boxes, precision=st.sampled_from(["single", "double"]))
def test_contacts_lie_in_both_boxes_and_the_normal_leaves_the_first(box1, box2, precision) -> None:
    found = contacts_of(collide(box1, box2, precision))
    rounding = 1e-5 if precision == "single" else TIE
    for record in found:
        point, normal = np.array([record["x"], record["y"]]), np.array([record["nx"], record["ny"]])
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-6)
        assert normal @ (box2.center - box1.center) >= -rounding
        assert record["separation"] <= 0
        # slid onto the reference face: on the surface of one box, at most the overlap outside the other
        outside = sorted(box.distance_outside(point) for box in (box1, box2))
        assert min(abs(value) for value in outside) < rounding
        assert outside[1] <= -record["separation"] + rounding


@pairs
@given(box1=boxes, box2=boxes)
@example(box1=PlacedBox(0, 0, 0, 2, 1), box2=PlacedBox(0.3, 0.9, 0.1, 1, 1))
@example(box1=PlacedBox(0, 0, 0.3, 3, 1), box2=PlacedBox(0.3, 0.9, 0.2, 1, 1))
def test_swapping_the_boxes_swaps_normal_and_features(box1: PlacedBox, box2: PlacedBox) -> None:
    depths = overlaps(box1, box2)
    assume(depths.min() > TIE and not tied(box1, box2))
    margin = FACE_ABSOLUTE_TOLERANCE * 1.5
    best = int(np.argmin(depths))
    # one face is clearly the best, so that the order of looking does not matter
    assume(all(-depths[best] > FACE_RELATIVE_TOLERANCE * -depths[k] + margin for k in range(4) if k != best))
    here, there = contacts_of(collide(box1, box2)), contacts_of(collide(box2, box1))
    assert len(here) == len(there)
    for field in ("x", "y", "separation"):
        assert here[field] == pytest.approx(there[field], abs=TIE)
    for field in ("nx", "ny"):
        assert here[field] == pytest.approx(-there[field], abs=TIE)
    assert (here["feature"] == (there["feature"] >> 8 | (there["feature"] & 0xFF) << 8)).all()


@pairs
@given(box1=boxes, box2=boxes)
def test_two_contacts_have_two_features(box1: PlacedBox, box2: PlacedBox) -> None:
    found = contacts_of(collide(box1, box2))
    assert len(set(found["feature"].tolist())) == len(found)


@pairs
@given(box1=boxes, box2=boxes, turn=st.floats(-3, 3), x=st.floats(-50, 50), y=st.floats(-50, 50))
def test_the_pair_may_be_moved_and_turned_as_one(box1, box2, turn, x, y) -> None:
    depths = overlaps(box1, box2)
    assume(abs(depths.min()) > TIE and not tied(box1, box2))

    def moved(box: PlacedBox) -> PlacedBox:
        c, s = math.cos(turn), math.sin(turn)
        return PlacedBox(c * box.x - s * box.y + x, s * box.x + c * box.y + y, box.angle + turn, box.width, box.height)

    here, there = contacts_of(collide(box1, box2)), contacts_of(collide(moved(box1), moved(box2)))
    ends = np.abs(here["separation"]).min(initial=1.0) > 1e-7
    faces = accepted_faces(depths, np.concatenate([box1.half, box2.half]))
    assume(ends and len(faces) < 2)
    assert sorted(here["separation"]) == pytest.approx(sorted(there["separation"]), abs=1e-7)
    assert sorted(here["feature"]) == sorted(there["feature"])


def test_face_on_face() -> None:
    found = contacts_of(collide(PlacedBox(0, 0, 0, 2, 2), PlacedBox(0.5, 1.75, 0, 2, 2)))
    assert found["ny"].tolist() == [1.0, 1.0]
    assert found["separation"].tolist() == [-0.25, -0.25]
    assert sorted(zip(found["x"].tolist(), found["y"].tolist(), strict=True)) == [(-0.5, 1.0), (1.0, 1.0)]


def test_corner_on_face() -> None:
    found = contacts_of(collide(PlacedBox(0, 0, 0, 4, 2), PlacedBox(0.5, 1 + math.sqrt(0.5) - 0.01, math.pi / 4, 1, 1)))
    assert len(found) == 1
    assert found["x"][0] == pytest.approx(0.5, abs=1e-12)
    assert found["y"][0] == pytest.approx(1.0, abs=1e-12)
    assert found["separation"][0] == pytest.approx(-0.01, abs=1e-12)


def test_of_two_equal_faces_the_first_bodys_x_face_stays() -> None:
    found = contacts_of(collide(PlacedBox(0, 0, 0, 1, 1), PlacedBox(0.9, 0.9, 0, 1, 1)))
    assert found["nx"].tolist() == [1.0, 1.0]
