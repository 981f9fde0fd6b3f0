"""Many bodies at once: the same world as one by one."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

from engine import Box, Capsule, Chain, Circle, Polygon, Shape, World
from tests.engine.worlds import DT, OF_ANY_SIZE, POINTS, PRECISIONS, floor, run, tables_of

SHAPES = [Box(0.4, 0.3), Circle(0.2), Capsule(0.3, 0.1), Polygon(POINTS, 0.05)]


def rows(count: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(4)
    return {
        "positions": np.column_stack([np.arange(count) % 20 * 0.9, 0.6 + np.arange(count) // 20 * 1.1]),
        "angles": rng.uniform(-3, 3, count),
        "velocities": rng.uniform(-1, 1, (count, 2)),
        "angular_velocities": rng.uniform(-2, 2, count),
    }


def one_by_one(world: World, shape: Shape, content: dict[str, np.ndarray], **others: Any) -> None:
    for position, angle, velocity, spin in zip(*content.values(), strict=True):
        world.create_body(
            shape, position=tuple(position), angle=angle, velocity=tuple(velocity), angular_velocity=spin, **others
        )


@pytest.mark.parametrize("solver", OF_ANY_SIZE)
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
def test_at_once_is_one_by_one(shape: Shape, precision: str, solver: str) -> None:
    others = {"density": 2.5, "friction": 0.7, "offset": (0.1, -0.05), "shape_angle": 0.3, "linear_damping": 0.1,
              "category": 3}  # fmt: skip
    worlds = [World(precision=precision, solver=solver) for _ in range(2)]
    for world in worlds:
        floor(world)
        world.create_body(Circle(0.1), position=(-5, 5)).destroy()  # a free row is used first
    content = rows(60)
    one_by_one(worlds[0], shape, content, **others)
    bodies = worlds[1].create_bodies(shape, **content, **others)
    assert worlds[0].state_hash() == worlds[1].state_hash()
    assert tables_of(worlds[0]) == tables_of(worlds[1])
    assert worlds[1].bodies[1:] == bodies
    assert [body.serial for body in bodies] == list(range(2, 62))
    for world in worlds:
        run(world, 60)
    assert tables_of(worlds[0]) == tables_of(worlds[1])


def test_one_value_for_all() -> None:
    world = World(precision="double", gravity=(0, 0))
    positions = [(0, 0), (5, 0), (10, 0)]
    bodies = world.create_bodies(Box(1, 1), positions=positions, angles=0.5, velocities=(1, 2), angular_velocities=-3)
    for body, position in zip(bodies, positions, strict=True):
        assert tuple(body.position) == position
        assert (body.angle, tuple(body.velocity), body.angular_velocity) == (0.5, (1, 2), -3)
    assert [body.mass for body in bodies] == [1.0] * 3


def test_walls_and_platforms() -> None:
    world = World()
    walls = world.create_bodies(Chain(((0, 0), (1, 0), (2, 1))), positions=[(0, 0), (5, 0)], kind="static")
    assert [len(body.shapes[0].rows) for body in walls] == [2, 2]
    assert walls[0].shape == walls[1].shape
    lifts = world.create_bodies(Box(1, 0.2), positions=np.array([(0, 5), (5, 5)]), kind="kinematic", velocities=(0, 1))
    run(world, 60)
    assert [body.position.y for body in lifts] == pytest.approx([6.0, 6.0], abs=1e-4)


def test_none_at_all() -> None:
    world = World()
    before = world.snapshot().to_bytes()
    assert world.create_bodies(Box(1, 1), positions=np.empty((0, 2))) == []
    assert world.create_bodies(Box(1, 1), positions=[]) == []
    assert world.snapshot().to_bytes() == before


@pytest.mark.parametrize(
    "bad",
    [{"positions": [(0, 0), (0, np.nan)]}, {"velocities": [(0, 0), (1e39, 0)]}, {"mass": -1}, {"angles": [1, 2, 3]}],
    ids=lambda bad: next(iter(bad)),
)
def test_a_refusal_makes_none(bad: dict[str, Any]) -> None:
    world = World()
    before = world.snapshot().to_bytes()
    with pytest.raises(ValueError, match="must be"):
        world.create_bodies(Box(1, 1), **{"positions": [(0, 0), (1, 0)], **bad})
    assert world.snapshot().to_bytes() == before


@pytest.mark.parametrize("shape", [Box(1, 1), Polygon(POINTS)], ids=lambda shape: shape.name)
def test_ten_thousand(shape: Shape) -> None:
    world = World()
    positions = np.column_stack([np.arange(10_000) % 100 * 2.0, np.arange(10_000) // 100 * 2.0])
    start = time.perf_counter()
    bodies = world.create_bodies(shape, positions=positions, density=1.0)
    seconds = time.perf_counter() - start
    assert len(bodies) == world.body_count == 10_000
    assert np.array_equal(world.positions, positions)
    assert np.shares_memory(world.positions, world._state.bodies.tables["bodies"]), "a view"
    assert world.body_records()["mass"] == pytest.approx(np.full(10_000, shape.area))
    world.step(DT)
    assert world.velocities[:, 1] == pytest.approx(np.full(10_000, -10 * DT), rel=1e-5)
    assert seconds < 1.0  # it takes a twentieth; bodies made one by one take thirty times as long
