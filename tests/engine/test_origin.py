"""Far from the origin: single precision keeps its digits for small differences."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Box, Circle, World
from tests.engine.worlds import PRECISIONS, run


def pile(precision: str, x: float, y: float) -> World:
    world = World(precision=precision)
    world.create_body(Box(100, 2), position=(x, y - 1), kind="static")
    for k in range(4):
        world.create_body(Box(1, 0.75), position=(x + 0.0625 * k, y + 0.375 + 0.75 * k))
    bob = world.create_body(Circle(0.5), position=(x + 3, y + 2))
    world.create_joint_revolute(world.bodies[0], bob, anchor=(x + 2, y + 3))
    return run(world, 120)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_million_metres_away_it_is_the_same(precision: str) -> None:
    here, there = pile(precision, 0, 0), pile(precision, 1e6, -5e5)
    assert np.abs(there.positions - here.positions - (1e6, -5e5)).max() < 1e-5
    assert np.abs(there.angles - here.angles).max() < 1e-5
    assert len(here.contact_records()) == len(there.contact_records())
