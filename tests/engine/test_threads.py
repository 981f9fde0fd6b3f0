"""Worlds in several threads at once: kernels release the GIL, and no world sees another."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

from engine import World
from tests.engine.trajectories import build, load
from tests.engine.worlds import DT, busy, run

STEPS = 120
KINDS = [("pyramid", "single"), ("pyramid", "double"), ("busy", "single"), ("busy", "double")]


def make(kind: str, precision: str) -> World:
    return build(load("demo5_pyramid").start, precision) if kind == "pyramid" else busy(precision)


def test_worlds_in_threads_do_as_they_do_alone() -> None:
    alone = [run(make(*kind), STEPS).state_hash() for kind in KINDS]
    assert len(set(alone)) == len(KINDS)
    start = threading.Barrier(len(KINDS))

    def together(kind: tuple[str, str]) -> str:
        world = make(*kind)
        start.wait()
        return run(world, STEPS).state_hash()

    with ThreadPoolExecutor(len(KINDS)) as pool:
        assert list(pool.map(together, KINDS)) == alone


def test_another_thread_may_read_snapshots_of_its_own() -> None:
    world = busy()
    snapshots = []
    for _ in range(40):
        world.step(DT)
        snapshots.append(world.snapshot())

    def replay(index: int) -> str:
        other = World(precision="double")
        other.restore(snapshots[index])
        return run(other, 39 - index).state_hash()

    with ThreadPoolExecutor(2) as pool:
        assert set(pool.map(replay, range(0, 40, 3))) == {world.state_hash()}
