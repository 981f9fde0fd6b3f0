"""What an impulse does to a body: Newton's second law, and the third."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.impulses import pull, push
from engine.tables import empty, motion_dtype
from engine.vec2 import Vec2

pytestmark = pytest.mark.kernel

vector = st.builds(Vec2, st.floats(-10, 10), st.floats(-10, 10))


@settings(max_examples=50, deadline=None)
@given(r=vector, impulse=vector, mass=st.floats(0.1, 10), inertia=st.floats(0.1, 10))
def test_push_and_pull(r: Vec2, impulse: Vec2, mass: float, inertia: float) -> None:
    rows = empty(2, motion_dtype("double"))
    rows["inverse_mass"], rows["inverse_inertia"] = 1 / mass, 1 / inertia
    rows["vx"], rows["vy"], rows["w"] = 1.0, 2.0, 3.0
    push(rows[0], r, impulse)
    pull(rows[1], r, impulse)
    change = np.array([impulse.x / mass, impulse.y / mass, (r.x * impulse.y - r.y * impulse.x) / inertia])
    start = np.array([1.0, 2.0, 3.0])
    for row, expected in zip(rows, (start + change, start - change), strict=True):
        assert [row["vx"], row["vy"], row["w"]] == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_what_cannot_move_does_not() -> None:
    rows = empty(1, motion_dtype("single"))
    push(rows[0], Vec2(np.float32(1), np.float32(2)), Vec2(np.float32(3), np.float32(4)))
    assert (rows["vx"][0], rows["vy"][0], rows["w"][0]) == (0, 0, 0)
