"""Steps are timed one by one, engines take turns, and a ratio compares the same steps."""

from __future__ import annotations

import gc
import time

import numpy as np
import pytest

from engine import Box, World
from sandbox.lab.bench import BLOCK, RUN_IN, Plan, Progress, Say, TimedWorld, bench, flown_apart, take_turns
from sandbox.lab.bench_result import BenchResult
from sandbox.lab.bench_scenes import SETTLES, default_scenes, default_steps, settling_time
from sandbox.lab.peers import CannotMirror, PeerError
from sandbox.lab.pyramids import BASES
from sandbox.lab.timing import Figures, Ratio, Times, no_collection, time_steps
from sandbox.scenes import SCENES, Scene, find_scene

STEP = 100.0  # what a step of the fake peer takes [ms]


def constant(cpu: float, count: int = 1) -> Times:
    return Times(np.full(count, cpu), np.full(count, cpu))


class FakePeer:
    """Copies positions, and refuses or misplaces what it is told to."""

    def __init__(self, *, shift: float = 0.0, refuse: str = "", flies_after: int = 1000) -> None:
        self.name = "fake"
        self.flies_after = flies_after
        self.shift = shift
        self.refuse = refuse
        self.worlds: list[FakeWorld] = []

    def mirror(self, world: World, dt: float) -> FakeWorld:
        if self.refuse:
            raise CannotMirror(self.refuse)
        self.worlds.append(FakeWorld(np.array(world.positions) + self.shift, self.flies_after))
        return self.worlds[-1]

    def close(self) -> None:
        pass


class FakeWorld:
    def __init__(self, positions: np.ndarray, flies_after: int) -> None:
        self._positions = positions
        self._flies_after = flies_after  # turns
        self.counts: list[int] = []
        self.closed = False

    def step(self, count: int) -> Times:
        self.counts.append(count)
        return constant(STEP, count)

    def positions(self) -> np.ndarray:
        return self._positions * (1e6 if len(self.counts) >= self._flies_after else 1.0)

    def close(self) -> None:
        self.closed = True


def ignore(*_: object) -> None:
    pass


def measure(plan: Plan, *peers: FakePeer, progress: Progress = ignore, say: Say = ignore) -> BenchResult:
    return bench(plan.scene.make(), plan, peers, progress, say)


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


def test_ratio_is_of_cpu_time_unless_wall_time_is_asked_for() -> None:
    ours, theirs = [Times(np.array([1.0]), np.array([6.0]))], [Times(np.array([2.0]), np.array([3.0]))]
    assert Ratio.between(ours, theirs).median == 0.5
    assert Ratio.between(ours, theirs, "wall").median == 2.0


def test_figures_of_times() -> None:
    figures = Figures.of(np.array([*[2.0] * 60, *[1.0] * 30, *[7.0] * 10]))
    assert (figures.median, figures.least) == (2.0, 1.0)
    assert 2.0 < figures.p99 <= 7.0


def test_nothing_is_collected_while_steps_are_timed() -> None:
    assert gc.isenabled()
    with no_collection():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_bench_measures_the_scene_after_a_run_in_of_all() -> None:
    scene = find_scene("The Talk/Pyramid")
    peer = FakePeer()
    result = measure(Plan(scene, steps=25), peer)
    again = scene.make()
    np.testing.assert_array_equal(peer.worlds[0].positions(), again.positions)
    for _ in range(RUN_IN + 25):
        again.step(1 / 60)
    assert (result.bodies, result.contacts) == (79, again.diagnostics().contact_count)
    assert (result.steps, result.after, result.threads) == (25, 0.0, 1)
    for figures in (result.cpu, result.wall):
        assert 0.0 < figures.least <= figures.median <= figures.p99
    assert list(result.stages) == list(again.stage_times)
    assert sum(result.stages.values()) <= 2 * result.wall.median
    assert result.peak_memory > 20.0
    assert peer.worlds[0].counts == [RUN_IN, 20, 5]
    assert peer.worlds[0].closed
    assert result.peers["fake"].ms_median == STEP
    assert 0.0 < result.peers["fake"].ratio.median < 1.0


def test_the_world_settles_alone_and_is_copied_from_there() -> None:
    scene = find_scene("The Talk/Single Box")
    peer, told = FakePeer(), []
    result = measure(Plan(scene, after=0.5, steps=3), peer, progress=lambda *now: told.append(now))
    again = scene.make()
    for _ in range(30):
        again.step(1 / 60)
    np.testing.assert_array_equal(peer.worlds[0].positions(), again.positions)
    assert peer.worlds[0].counts == [RUN_IN, 3]
    assert result.after == pytest.approx(0.5)
    assert told[:2] == [(1, 53), (2, 53)]
    assert told[-1] == (53, 53)


def test_stages_are_those_of_the_steps_that_are_timed() -> None:
    """The run-in's, with all that was compiled in it, are forgotten."""
    world = find_scene("The Talk/Single Box").make()
    timed = TimedWorld(world, 1 / 60)
    timed.step(2)
    timed.forget()
    timed.step(1)
    assert timed.stages() == pytest.approx({name: 1e3 * taken for name, taken in world.stage_times.items()})


def test_the_run_in_counts_for_no_stage(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TimedWorld, "stages", lambda timed: {"steps": len(timed._stage_rows)})
    assert measure(Plan(find_scene("The Talk/Single Box"), steps=3)).stages == {"steps": 3}


def test_colours_are_told_where_the_world_has_any() -> None:
    plan = Plan(find_scene("The Talk/Single Box"), steps=1)
    world = plan.scene.make()
    result = bench(world, plan, [], ignore, ignore)
    assert result.colours == tuple(getattr(world, "colours", ()))
    assert result.overflow == getattr(world, "overflow", 0)


def test_a_scene_without_moving_bodies_is_measured() -> None:
    def build(world: World) -> None:
        world.create_body(Box(1, 1), kind="static")

    assert measure(Plan(Scene("still", build, "", (0.0, 0.0, 1.0)), steps=3)).contacts == 0


def test_a_peer_that_cannot_copy_the_scene_is_left_out() -> None:
    heard: list[str] = []
    plan = Plan(find_scene("Circles"), steps=2)
    result = measure(plan, FakePeer(refuse="it has no circles"), say=heard.append)
    assert result.peers == {}
    assert result.left_out == {"fake": "it has no circles"}
    assert heard == ["The Talk/Circles: left out fake: it has no circles"]


def test_a_copy_that_flies_apart_is_left_out_and_not_stepped_on() -> None:
    heard: list[str] = []
    peer = FakePeer(flies_after=3)
    result = measure(Plan(find_scene("The Talk/Pyramid"), steps=100), peer, say=heard.append)
    assert peer.worlds[0].counts == [20, 20, 20]
    assert result.peers == {}
    assert result.left_out == {"fake": "its bodies have flown apart within 60 steps"}
    assert heard == ["The Talk/Pyramid: left out fake: its bodies have flown apart within 60 steps"]


def test_what_has_flown_apart() -> None:
    ours = np.array([(0.0, 0.0), (100.0, 20.0)])
    for place, apart in (
        ((-109, 0), False),
        ((-111, 0), True),
        ((211, 5), True),
        ((50, 129), False),
        ((50, 131), True),
    ):
        assert flown_apart(np.array([(0.0, 0.0), place]), ours) == apart
    assert flown_apart(np.array([(0.0, 0.0), (np.nan, 0.0)]), ours)
    assert not flown_apart(np.zeros((0, 2)), np.zeros((0, 2)))


def test_a_copy_that_differs_is_refused() -> None:
    peer = FakePeer(shift=0.01)
    with pytest.raises(PeerError, match="fake: its copy of the scene differs"):
        measure(Plan(find_scene("Single Box"), steps=2), peer)
    assert peer.worlds[0].closed


def test_fewer_steps_of_large_scenes() -> None:
    assert [default_steps(things) for things in (0, 10, 2000, 5051, 20_001, 10**6)] == [600, 600, 600, 237, 80, 80]


def test_scenes_that_settle_are_there() -> None:
    assert not [name for name in SETTLES if name not in SCENES]
    assert settling_time("The Talk/Pyramid") == 0.0


def test_default_scenes_are_those_for_it_or_the_talks() -> None:
    names = [scene.name for scene in default_scenes(talk=False)]
    assert names == [name for name in SCENES if name.startswith("Benchmark/")]
    assert len(default_scenes(talk=True)) == len(BASES)
