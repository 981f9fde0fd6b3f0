"""Sweeps give the same bits with one thread or two, step by step or in one run, after a restore, and every time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import Box, Capsule, Chain, Circle, World
from tests.engine.worlds import DT, PRECISIONS, run, tables_of


def shooting(count: int = 24, **settings: object) -> World:
    """Bullets and others, fast, in a closed room with a kinematic paddle and boxes at rest."""
    world = World(**settings)
    half = 6.0 + 0.05 * count
    corners = ((-half, -half), (half, -half), (half, half), (-half, half))
    world.create_body(Chain(corners, closed=True), kind="static", restitution=0.9)
    world.create_body(Box(4, 0.1), kind="kinematic", angular_velocity=3.0, velocity=(0.5, 0))
    for k in range(5):
        world.create_body(Box(0.5, 0.5), position=(-3, -half + 0.25 + 0.5 * k))
    rng = np.random.default_rng(5)
    shapes = (Circle(0.08), Box(0.3, 0.1), Capsule(0.3, 0.02))
    for k in range(count):
        turn, speed = rng.uniform(0, 2 * math.pi), rng.uniform(20, 500)
        place = rng.uniform(-half + 1, half - 1, 2)
        world.create_body(
            shapes[k % 3], position=place, velocity=(speed * math.cos(turn), speed * math.sin(turn)),
            angular_velocity=rng.uniform(-40, 40), bullet=k % 2 == 0, restitution=0.7,
        )  # fmt: skip
    return world


@pytest.mark.parametrize("precision", PRECISIONS)
def test_run_is_as_many_steps(precision: str) -> None:
    stepped, ran = shooting(precision=precision), shooting(precision=precision)
    for steps in (1, 3, 40, 60):
        run(stepped, steps)
        ran.run(steps, DT)
        assert tables_of(ran) == tables_of(stepped)


def test_after_a_restore_in_full_flight() -> None:
    world = shooting()
    run(world, 7)
    saved = world.snapshot()
    run(world, 20)
    other = World()
    other.restore(saved)
    run(other, 20)
    assert other.state_hash() == world.state_hash()
    world.restore(saved)
    run(world, 20)
    assert other.state_hash() == world.state_hash()
    assert other.snapshot().tables["bodies.bullet"].dtype == np.bool_


def test_threads_change_no_bit() -> None:
    worlds = [shooting(300, threads=threads) for threads in (1, 2)]
    for _ in range(15):
        for world in worlds:
            world.step(DT)
    assert worlds[0].state_hash() == worlds[1].state_hash()


def test_the_broad_phase_changes_no_bit() -> None:
    worlds = [run(shooting(broad_phase=name), 30) for name in ("dynamic_tree", "all_pairs")]
    assert worlds[0].state_hash() == worlds[1].state_hash()


def test_where_nothing_is_fast_nothing_is_changed() -> None:
    hashes = []
    for continuous in (True, False):
        world = World(continuous=continuous)
        world.create_body(Box(40, 2), position=(0, -1), kind="static")
        for k in range(12):
            world.create_body(Box(1, 1), position=(0.1 * (k % 2), 0.5 + 1.05 * k))
        hashes.append(run(world, 60).state_hash())
    assert hashes[0] == hashes[1]
