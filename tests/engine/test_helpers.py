"""Several threads for one step: not a bit changes, nobody waits for one that does not come, nothing piles up."""

from __future__ import annotations

import os
import queue
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numba
import numpy as np
import pytest

from engine import Box, Circle, World, threads
from tests.engine.worlds import DT, run

STEPS = 60
compiled = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="without compilation there is one thread")


def heap(shared: int, **settings: Any) -> World:
    """Boxes and circles that fall into a pit, many enough to be shared: all stages are."""
    world = World(threads=shared, **settings)
    world.create_body(Box(60, 2), position=(0, -1), kind="static")
    places = np.column_stack([np.arange(400) % 40 - 20.0, 1.0 + np.arange(400) // 40 * 0.98])
    world.create_bodies(Box(0.98, 0.98), positions=places, restitution=0.2)
    world.create_bodies(Circle(0.45), positions=places + np.array([0.3, 12.0]), rolling_resistance=0.1)
    for first, second in zip(world.bodies[1:60], world.bodies[2:61], strict=True):
        world.create_joint_revolute(first, second, anchor=first.position, motor_speed=1.0, max_motor_torque=2.0)
    return world


def hashes(world: World) -> list[str]:
    return [run(world, 1).state_hash() for _ in range(STEPS)]


@compiled
@pytest.mark.parametrize("settings", [{}, {"precision": "double", "iterations": 2}])
def test_one_two_and_four_threads_give_the_same_bits(settings: dict[str, Any]) -> None:
    alone = hashes(heap(1, **settings))
    assert len(set(alone)) == STEPS
    for shared in (2, 4):
        world = heap(shared, **settings)
        assert hashes(world)[: STEPS // 2] == alone[: STEPS // 2]
        assert world.state_hash() == alone[-1]


@compiled
def test_the_same_bits_after_a_restore_with_other_threads() -> None:
    world = run(heap(1), 30)
    snapshot, later = world.snapshot(), run(world, 30).state_hash()
    for shared in (2, 4):
        other = World(threads=shared)
        other.restore(snapshot)
        assert run(other, 30).state_hash() == later


@compiled
def test_several_worlds_share_the_helpers_in_several_threads() -> None:
    alone = run(heap(1), STEPS).state_hash()
    with ThreadPoolExecutor(3) as pool:
        worlds = [pool.submit(lambda: run(heap(3), STEPS).state_hash()) for _ in range(3)]
        assert [world.result(timeout=300) for world in worlds] == [alone] * 3


@compiled
def test_jobs_do_not_pile_up() -> None:
    world = heap(2)
    most = 0
    for _ in range(STEPS):
        world.step(DT)
        most = max(most, threads._helpers.jobs.qsize())
    assert most <= threads.MOST_WAITING * threads._helpers.count


@compiled
def test_a_step_needs_no_helper_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    class Nobody:
        jobs: queue.SimpleQueue = queue.SimpleQueue()
        posted = np.zeros(1, np.int64)
        count = 3

    monkeypatch.setattr(threads, "_helpers", Nobody())
    assert run(heap(4), STEPS).state_hash() == run(heap(1), STEPS).state_hash()


@compiled
def test_a_helper_that_fails_is_not_missed() -> None:
    def work(leads: bool) -> None:
        if not leads:
            failed.set()
            raise OSError("no room on the disk")

    failed = threading.Event()
    threads.share(2, work)
    assert failed.wait(10)
    assert run(heap(2), 5).state_hash() == run(heap(1), 5).state_hash()


@compiled
@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks nothing")
def test_a_forked_process_has_helpers_of_its_own() -> None:
    world = run(heap(2), 3)
    snapshot, later = world.snapshot(), run(world, 3).state_hash()
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            other = World(threads=2)
            other.restore(snapshot)
            os.write(write, run(other, 3).state_hash().encode())
        finally:
            os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        assert pipe.read().decode() == later
    os.waitpid(child, 0)


@pytest.mark.parametrize("value", [0, -1, 65, 1.5, True, "2", None])
def test_other_numbers_of_threads_are_refused(value: Any) -> None:
    with pytest.raises(ValueError, match="threads"):
        World(threads=value)
    world = World(threads=3)
    with pytest.raises(ValueError, match="threads"):
        world.threads = value
    assert world.threads == 3
