"""Circle against circle: the line between the centres."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine import SOLVERS, Circle
from tests.engine.worlds import PRECISIONS, run, touching

pytestmark = pytest.mark.kernel


@settings(max_examples=300, deadline=None)
@given(
    x=st.floats(-2, 2),
    y=st.floats(-2, 2),
    radius1=st.floats(0.05, 2),
    radius2=st.floats(0.05, 2),
    precision=st.sampled_from(PRECISIONS),
    solver=st.sampled_from(tuple(SOLVERS)),
)
def test_line_between_the_centres(x, y, radius1, radius2, precision, solver) -> None:
    tolerance = 1e-12 if precision == "double" else 2e-6
    distance = math.hypot(x, y)
    separation = distance - radius1 - radius2
    assume(abs(separation) > tolerance)
    found = touching((Circle(radius1), (7, -3), 0.0), (Circle(radius2), (7 + x, y - 3), 1.0), precision, solver)
    records = found.contact_records()
    assert len(records) == (separation < 0)
    if separation > 0:
        return
    contact = records[0]
    assert contact["feature"] == 0
    assert contact["separation"] == pytest.approx(separation, abs=tolerance)
    assume(distance > 1e-3)
    assert (contact["nx"], contact["ny"]) == pytest.approx((x / distance, y / distance), abs=1e3 * tolerance)
    along = (contact["x"] - 7) * x / distance + (contact["y"] + 3) * y / distance
    assert along - radius1 == pytest.approx(distance - radius2 - along, abs=10 * tolerance)  # midway
    across = (contact["x"] - 7) * y / distance - (contact["y"] + 3) * x / distance
    assert across == pytest.approx(0.0, abs=1e3 * tolerance)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("offset", [0.0, 5e-324, 1e-170, 1e-40, 1e-20])
def test_coincident_circles_part_and_stay_finite(precision: str, offset: float) -> None:
    world = touching((Circle(1), (0, 0), 0.0), (Circle(0.5), (offset, 0), 0.0), precision)
    contact = world.contact_records()[0]
    assert math.hypot(contact["nx"], contact["ny"]) == pytest.approx(1.0, abs=1e-6)
    assert contact["separation"] == -1.5
    world.position_correction = True
    run(world, 120)
    assert np.isfinite(world.positions).all()
    assert world.diagnostics().max_penetration < 0.02


@pytest.mark.parametrize("precision", PRECISIONS)
def test_circles_that_just_touch(precision: str) -> None:
    assert len(touching((Circle(1), (0, 0), 0.0), (Circle(0.5), (1.5, 0), 0.0), precision).contact_records()) == 1
    assert len(touching((Circle(1), (0, 0), 0.0), (Circle(0.5), (1.500001, 0), 0.0), precision).contact_records()) == 0
