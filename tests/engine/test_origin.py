"""Far from the origin: single precision keeps its digits for small differences."""

from __future__ import annotations

import numpy as np
import pytest

from engine import SOLVERS, Box, Capsule, Chain, Circle, Polygon, Segment, World
from tests.engine.worlds import POINTS, PRECISIONS, run


def pile(precision: str, x: float, y: float, solver: str) -> World:
    world = World(precision=precision, solver=solver)
    world.create_body(Box(100, 2), position=(x, y - 1), kind="static")
    for k in range(4):
        world.create_body(Box(1, 0.75), position=(x + 0.0625 * k, y + 0.375 + 0.75 * k))
    bob = world.create_body(Circle(0.5), position=(x + 3, y + 2))
    world.create_joint_revolute(world.bodies[0], bob, anchor=(x + 2, y + 3))
    return run(world, 120)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_million_metres_away_it_is_the_same(precision: str, solver: str) -> None:
    here, there = pile(precision, 0, 0, solver), pile(precision, 1e6, -5e5, solver)
    assert np.abs(there.positions - here.positions - (1e6, -5e5)).max() < 1e-5
    assert np.abs(there.angles - here.angles).max() < 1e-5
    assert len(here.contact_records()) == len(there.contact_records())


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("place", [(10_000.0, 0.0), (-7_071.3, 7_071.1)])
def test_a_stack_of_eight_ten_kilometres_away(place: tuple[float, float], precision: str, solver: str) -> None:
    def stack(x: float, y: float) -> World:
        world = World(precision=precision, solver=solver)
        world.create_body(Box(20, 1), position=(x, y - 0.5), kind="static", friction=0.6)
        for k in range(8):
            world.create_body(Box(1, 1), position=(x + 0.03 * (k % 3), y + 0.5 + 1.01 * k), friction=0.6)
        return run(world, 600)

    here, there = stack(0.0, 0.0), stack(*place)
    assert np.abs(here.velocities).max() < 5e-3, "settled"
    assert here.positions[8, 1] > 7.4, "standing"
    assert np.abs(there.positions - here.positions - place).max() < 1e-3
    assert np.abs(there.angles - here.angles).max() < 1e-3


@pytest.mark.parametrize("precision", PRECISIONS)
def test_every_shape_far_away(precision: str) -> None:
    def settle(x: float, y: float) -> World:
        world = World(precision=precision)
        ground = world.create_body(position=(x, y), kind="static")
        ground.add_shape(Chain(((-9, 1), (-8, 0), (0, 0), (0.5, 0))), friction=1)
        ground.add_shape(Segment((0.5, 0), (9, 0)), friction=1)
        for k, shape in enumerate([Box(1, 0.5), Circle(0.4), Capsule(0.6, 0.2), Polygon(POINTS), Polygon(POINTS, 0.1)]):
            for side in (-1, 1):
                place = (x + side * (1.5 + 1.4 * k), y + 0.6)
                world.create_body(shape, position=place, angle=0.3, rolling_resistance=0.2, angular_damping=1)
        return run(world, 300)

    here, there = settle(0.0, 0.0), settle(20_000.0, -10_000.0)
    assert np.abs(there.positions - here.positions - (20_000, -10_000)).max() < 1e-3
    assert len(here.contact_records()) == len(there.contact_records()) > 12
