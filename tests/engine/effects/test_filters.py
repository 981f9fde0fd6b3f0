"""Filters: who passes through whom."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import SOLVERS, Box, Circle, World
from engine.effects.filters import ALL, drop_filtered
from tests.engine.worlds import DT, floor, run

pytestmark = pytest.mark.kernel

bits = st.sampled_from([0, 1, 2, 3, 6, 1 << 40, ALL])
shape = st.tuples(bits, bits, st.sampled_from([0, 0, 1, -1, 2, -2]))


def meet(a: tuple[int, int, int], b: tuple[int, int, int]) -> bool:
    """Of (category, mask, group): a group of both decides, else each must be in the other's mask."""
    if a[2] == b[2] != 0:
        return a[2] > 0
    return bool(a[1] & b[0]) and bool(b[1] & a[0])


@settings(max_examples=150, deadline=None)
@given(
    shapes=st.lists(shape, min_size=5, max_size=5),
    pairs=st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), max_size=12),
)
def test_same_as_asking_each_pair(shapes: list, pairs: list) -> None:
    table = np.array([*pairs, (0, 0)], np.int64)
    category, mask, group = (np.array([one[k] for one in shapes], np.int64) for k in range(3))
    kept = drop_filtered(table, len(pairs), category, mask, group)
    assert table[:kept].tolist() == [[a, b] for a, b in pairs if meet(shapes[a], shapes[b])]


@pytest.mark.parametrize("solver", SOLVERS)
@settings(max_examples=25, deadline=None)
@given(a=shape, b=shape)
def test_a_ball_lands_on_what_it_meets(solver: str, a: tuple, b: tuple) -> None:
    world = World(solver=solver)
    floor(world, category=a[0], mask=a[1], group=a[2])
    ball = world.create_body(Circle(0.5), position=(0, 0.6), category=b[0], mask=b[1], group=b[2])
    run(world, 60)
    assert (ball.position.y > 0.4) == meet(a, b)


def test_shapes_of_one_body_have_their_own() -> None:
    world = World()
    floor(world)
    body = world.create_body(Box(1, 0.2), position=(0, 1), category=2, mask=0)
    foot = body.add_shape(Circle(0.2), offset=(0, -0.4))
    run(world, 60)
    assert body.position.y == pytest.approx(0.6, abs=0.05), "it stands on its foot"
    foot.mask = 0
    run(world, 60)
    assert body.position.y < -1


def test_who_touches_may_be_let_go_and_caught_again() -> None:
    world = World()
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 0.5))
    run(world, 30)
    handle = ball.shapes[0]
    handle.group = -1
    world.bodies[0].shapes[0].group = -1
    world.step(DT)
    assert world.arbiters == []
    run(world, 3)
    assert ball.position.y < 0.5
    handle.group = 0
    run(world, 60)
    assert ball.position.y == pytest.approx(0.5, abs=0.01)
    assert (handle.category, handle.mask, handle.group) == (1, ALL, 0)


def test_the_order_of_the_others_does_not_change() -> None:
    # filtered pairs leave the rest as it is: the same bits as if they had never been near
    def heap(extra: bool) -> str:
        world = World(precision="double")
        floor(world)
        for k in range(4):
            world.create_body(Box(1, 1), position=(0.1 * k, 0.5 + k))
        if extra:
            for k in range(3):
                world.create_body(Circle(0.3), position=(0.1 * k, 0.7 + k), mask=0, kind="static")
        run(world, 60)
        return str(world.positions[:5].tobytes())

    assert heap(True) == heap(False)
