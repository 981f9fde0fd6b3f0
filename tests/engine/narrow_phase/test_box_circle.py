"""Box against circle: the nearest point of the four edges; the contact lies midway between there and the circle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine import SOLVERS, Box, Circle
from tests.engine.worlds import PRECISIONS, run, touching
from tests.naive.boxes import PlacedBox
from tests.naive.circles import box_circle

pytestmark = pytest.mark.kernel

sizes = st.floats(0.2, 3.0)
boxes = st.builds(PlacedBox, st.floats(-1, 1), st.floats(-1, 1), st.floats(-4, 4), sizes, sizes)


@settings(max_examples=400, deadline=None)
@given(
    box=boxes,
    x=st.floats(-2.5, 2.5),
    y=st.floats(-2.5, 2.5),
    radius=st.floats(0.05, 2),
    flip=st.booleans(),
    precision=st.sampled_from(PRECISIONS),
    solver=st.sampled_from(tuple(SOLVERS)),
)
def test_nearest_point(box, x, y, radius, flip, precision, solver) -> None:
    tolerance = 1e-9 if precision == "double" else 1e-5
    center = np.array([x, y])
    point, separation, lead = box_circle(box, center, radius)
    assume(abs(separation) > tolerance)
    bodies = [
        (Box(box.width, box.height), (box.x, box.y), box.angle),
        (Circle(radius), (x, y), 0.0),
    ]
    found = touching(*(bodies[::-1] if flip else bodies), precision, solver).contact_records()
    assert len(found) == (separation < 0)
    if separation > 0:
        return
    contact = found[0]
    assert contact["separation"] == pytest.approx(separation, abs=tolerance)
    assume(abs(separation + radius) > 10 * tolerance)  # a centre on the edge has either normal
    inside = separation < -radius
    if inside:
        assume(lead > 10 * tolerance)  # else either of two edges is the nearest
    out = (point - center if inside else center - point) / abs(separation + radius)
    middle = point + 0.5 * separation * out
    assert (contact["x"], contact["y"]) == pytest.approx(tuple(middle), abs=max(10 * tolerance, 1e-3 * -separation))
    normal = np.array([contact["nx"], contact["ny"]]) * (-1 if flip else 1)
    assert normal @ normal == pytest.approx(1.0, abs=1e-6)
    assert normal @ out == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_centre_on_centre_leaves_through_the_nearest_face(precision: str) -> None:
    contact = touching((Box(4, 2), (0, 0), 0.0), (Circle(0.5), (0, 0), 0.0), precision).contact_records()[0]
    assert abs(contact["ny"]) == 1.0
    assert contact["separation"] == -1.5
    assert (contact["x"], contact["y"]) == (0.0, 0.25 * contact["ny"])  # midway from the face to the far side


@pytest.mark.parametrize("precision", PRECISIONS)
def test_deep_circle_is_pushed_out_and_stays_finite(precision: str) -> None:
    world = touching((Box(4, 2), (0, 0), 0.3), (Circle(0.5), (0, 0), 0.0), precision)
    world.position_correction = True
    run(world, 120)
    assert np.isfinite(world.positions).all()
    assert world.diagnostics().max_penetration < 0.02


def test_corner() -> None:
    contact = touching((Box(2, 2), (0, 0), 0.0), (Circle(1), (1.6, 1.6), 0.0)).contact_records()[0]
    overlap = 1 - 0.6 * math.sqrt(2)
    assert (contact["x"], contact["y"]) == pytest.approx((1 - 0.5 * overlap * math.sqrt(0.5),) * 2)
    assert contact["nx"] == pytest.approx(math.sqrt(0.5))
    assert contact["separation"] == pytest.approx(-overlap)
