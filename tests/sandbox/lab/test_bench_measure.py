"""Steps are timed one by one, engines take turns, and a ratio compares the same steps."""

from __future__ import annotations

import time

import numpy as np
import pytest

from engine import Box, World
from sandbox.lab.bench import BLOCK, bench, take_turns
from sandbox.lab.peers import CannotMirror, PeerError
from sandbox.lab.timing import Ratio, Times, time_steps
from sandbox.scenes import Scene, find_scene

STEP = 100.0  # what a step of the fake peer takes [ms]


def constant(cpu: float, count: int = 1) -> Times:
    return Times(np.full(count, cpu), np.full(count, cpu))


class FakePeer:
    """Copies positions, and refuses or misplaces what it is told to."""

    def __init__(self, *, shift: float = 0.0, refuse: str = "") -> None:
        self.name = "fake"
        self.shift = shift
        self.refuse = refuse
        self.worlds: list[FakeWorld] = []

    def mirror(self, world: World, dt: float) -> FakeWorld:
        if self.refuse:
            raise CannotMirror(self.refuse)
        self.worlds.append(FakeWorld(np.array(world.positions) + self.shift))
        return self.worlds[-1]

    def close(self) -> None:
        pass


class FakeWorld:
    def __init__(self, positions: np.ndarray) -> None:
        self._positions = positions
        self.counts: list[int] = []
        self.closed = False

    def step(self, count: int) -> Times:
        self.counts.append(count)
        return constant(STEP, count)

    def positions(self) -> np.ndarray:
        return self._positions

    def close(self) -> None:
        self.closed = True


def ignore(_: object) -> None:
    pass


def test_time_goes_to_the_step_that_took_it() -> None:
    naps = iter((0.0, 0.05, 0.0))
    times = time_steps(lambda: time.sleep(next(naps)), 3, after=lambda: time.sleep(0.01))
    assert times.wall.argmax() == 1
    assert times.wall[1] >= 50.0
    assert times.wall[[0, 2]].max() < 50.0


def test_sleeping_takes_no_cpu_time() -> None:
    times = time_steps(lambda: time.sleep(0.05), 2)
    assert times.cpu.max() < times.wall.min()


def test_ratio_is_the_median_of_blocks_with_quartiles() -> None:
    ours = [constant(ms, count=2) for ms in (1.0, 2.0, 3.0, 4.0, 100.0)]
    theirs = [constant(10.0, count=2) for _ in ours]
    assert Ratio.between(ours, theirs) == Ratio(pytest.approx(0.3), pytest.approx(0.2), pytest.approx(0.4))


def test_engines_take_turns_in_changing_order() -> None:
    log: list[tuple[str, int]] = []

    class Logged:
        def __init__(self, name: str) -> None:
            self.name = name

        def step(self, count: int) -> Times:
            log.append((self.name, count))
            return constant(1.0, count)

    told: list[int] = []
    blocks = take_turns([Logged("ours"), Logged("theirs")], 2 * BLOCK + 3, told.append)
    assert log == [
        ("ours", BLOCK),
        ("theirs", BLOCK),
        ("theirs", BLOCK),
        ("ours", BLOCK),
        ("ours", 3),
        ("theirs", 3),
    ]
    assert told == [BLOCK, BLOCK, 3]
    assert [[len(block.cpu) for block in one] for one in blocks] == [[BLOCK, BLOCK, 3]] * 2


def test_bench_measures_the_scene_from_its_start() -> None:
    scene = find_scene("The Talk/Pyramid")
    peer = FakePeer()
    result = bench(scene, [peer], 25, ignore, ignore)
    again = scene.make()
    for _ in range(25):
        again.step(1 / 60)
    assert (result.bodies, result.contacts) == (79, again.diagnostics().contact_count)
    assert result.ms_min <= result.ms_median <= result.ms_p99
    assert list(result.stages) == list(again.stage_times)
    assert peer.worlds[0].counts == [20, 5]
    assert peer.worlds[0].closed
    assert result.peers["fake"].ms_median == STEP
    assert 0.0 < result.peers["fake"].ratio.median < 1.0


def test_a_scene_without_moving_bodies_is_measured() -> None:
    def build(world: World) -> None:
        world.create_body(Box(1, 1), kind="static")

    assert bench(Scene("still", build, "", (0.0, 0.0, 1.0)), [], 3, ignore, ignore).contacts == 0


def test_a_peer_that_cannot_copy_the_scene_is_left_out() -> None:
    heard: list[str] = []
    result = bench(find_scene("Circles"), [FakePeer(refuse="it has no circles")], 2, ignore, heard.append)
    assert result.peers == {}
    assert heard == ["The Talk/Circles: left out fake: it has no circles"]


def test_a_copy_that_differs_is_refused() -> None:
    peer = FakePeer(shift=0.01)
    with pytest.raises(PeerError, match="fake: its copy of the scene differs"):
        bench(find_scene("Single Box"), [peer], 2, ignore, ignore)
    assert peer.worlds[0].closed
