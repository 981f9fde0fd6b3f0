"""xpbd and avbd against slow references in plain numpy, step by step, on a heap of boxes and circles."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Box, Circle, World
from engine.constants import AVBD_ALPHA, AVBD_FRICTION_PENALTY, AVBD_GAMMA, AVBD_GROWTH, AVBD_PENALTY
from tests.engine.worlds import DT, floor
from tests.naive.positions import Body, Point, avbd_step, xpbd_step

GRAVITY = np.array([0.0, -10.0, 0.0])


def heap(**settings: object) -> World:
    """Boxes and circles that land on each other, slide, spin and come to rest; nothing overlaps at first."""
    world = World(precision="double", sleeping=False, push_out_speed=1e6, **settings)
    floor(world)
    world.create_body(Box(1, 0.6), position=(0, 0.35), velocity=(1, 0), friction=0.3)
    world.create_body(Box(0.8, 0.5), position=(0.1, 1.0), angle=0.1, friction=0.8, density=3)
    world.create_body(Circle(0.3), position=(-0.8, 0.35), angular_velocity=-9, friction=0.5)
    world.create_body(Circle(0.25), position=(0.2, 1.7), velocity=(0, -2))
    world.create_body(Box(0.4, 0.4), position=(0.9, 0.9), angle=0.6, angular_velocity=2)
    return world


def bodies_of(world: World) -> list[Body]:
    found = []
    for body in world.bodies:
        masses = np.array([body.mass, body.mass, body.inertia])
        centre = np.array([*body.position, body.angle])
        speed = np.array([*body.velocity, body.angular_velocity])
        found.append(Body(centre, speed, masses))
    return found


def pairs_of(world: World) -> list[tuple[tuple[int, int], list[Point]]]:
    """What the narrow phase found in the last step, in the solver's order: serials of the shapes, and the points."""
    table, found = world._state.arbiters, []
    rows_of_bodies = {row: k for k, row in enumerate(world._state.bodies.order)}
    for index in world._state.layout.slots[world._state.layout.slots != table.nothing]:
        row = table.rows[index]
        points = []
        for contact in table.contacts[index][: row["count"]]:
            arms = tuple(np.array([contact[f"{r}_x"], contact[f"{r}_y"]]) for r in ("r1", "r2"))
            points.append(
                Point(
                    rows_of_bodies[row["body1"]], rows_of_bodies[row["body2"]], np.array([row["nx"], row["ny"]]), arms,
                    float(contact["separation"]), float(row["friction"]),
                )
            )  # fmt: skip
        if points:
            found.append(((int(row["serial1"]), int(row["serial2"])), points))
    return found


def impulses_of(world: World) -> dict[tuple[int, int, int], np.ndarray]:
    """By serials of the shapes and feature."""
    table = world._state.arbiters
    found = {}
    for row, contacts in zip(table.rows[: table.count], table.contacts, strict=False):
        for contact in contacts[: row["count"]]:
            key = (int(row["serial1"]), int(row["serial2"]), int(contact["feature"]))
            found[key] = np.array([contact["normal_impulse"], contact["tangent_impulse"]])
    return found


def agree(world: World, bodies: list[Body]) -> None:
    for body, expected in zip(world.bodies, bodies, strict=True):
        assert (*body.position, body.angle) == pytest.approx(expected.place, abs=1e-9)
        assert (*body.velocity, body.angular_velocity) == pytest.approx(expected.speed, abs=1e-6)


@pytest.mark.parametrize("substeps", [1, 5])
def test_xpbd_does_as_the_reference(substeps: int) -> None:
    world = heap(solver="xpbd", substeps=substeps)
    met, slid = 0, 0
    for _ in range(50):
        bodies = bodies_of(world)
        world.step(DT)
        pairs = [points for _, points in pairs_of(world)]
        xpbd_step(bodies, pairs, GRAVITY, DT, substeps)
        agree(world, bodies)
        given = {key[:2]: 0.0 for key in impulses_of(world)}
        for (one, other, _), impulse in impulses_of(world).items():
            given[one, other] += impulse[0]
        for key, points in pairs_of(world):
            expected = next(mine for mine in pairs if mine[0].arms[0].tolist() == points[0].arms[0].tolist())
            assert given[key] == pytest.approx(sum(point.total[0] for point in expected), abs=1e-7)
            met += given[key] > 0
            slid += any(abs(point.total[1]) > 0.999 * point.friction * point.total[0] > 0 for point in expected)
    assert met > 50, "they touch"
    assert slid > 10, "and some slide"


@pytest.mark.parametrize("iterations", [1, 6])
def test_avbd_does_as_the_reference(iterations: int) -> None:
    world = heap(solver="avbd", iterations=iterations)
    met = 0
    for _ in range(50):
        bodies, before = bodies_of(world), impulses_of(world)
        world.step(DT)
        found = pairs_of(world)
        points = [point for _, pair in found for point in pair]
        after = impulses_of(world)
        keys = {key[:2]: [] for key in after}
        for key in after:
            keys[key[:2]].append(key)
        in_order = [key for serials, _ in found for key in keys[serials]]
        avbd_step(
            bodies, points, [before.get(key, np.zeros(2)) for key in in_order], GRAVITY, DT, iterations, AVBD_ALPHA,
            AVBD_GAMMA, (AVBD_PENALTY, AVBD_FRICTION_PENALTY), AVBD_GROWTH,
        )  # fmt: skip
        agree(world, bodies)
        for key, point in zip(in_order, points, strict=True):
            assert after[key] == pytest.approx(point.total, abs=1e-7)
            met += point.total[0] > 0
    assert met > 50
