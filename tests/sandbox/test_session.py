"""One loop owns the world: it obeys, keeps time, and shows what it does."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from sandbox import clock
from sandbox import commands as ask
from sandbox.frame import Frame
from sandbox.session import Session
from sandbox.simulation import Simulation
from sandbox.viewer import NullViewer
from tests.sandbox.watching import Watcher, running, step_by_step, until, whole_frame


def test_steps_in_real_time_and_in_order() -> None:
    with running() as (_, watcher):
        watcher.wait_for_step(5)
        first, began = watcher.frames[-1].step, time.perf_counter()
        watcher.wait_for_step(first + 60)
        took = time.perf_counter() - began
        steps = [frame.step for frame in watcher.frames]
    assert took > 55 / 60, "faster than real time"
    assert sorted(steps) == steps
    assert set(range(steps[-1] + 1)) == set(steps), "a frame is missing"


def test_runs_as_a_simulation_does() -> None:
    """Bit for bit, whatever the thread and the clock do."""
    with running("The Talk/Dominos", iterations=7) as (_, watcher):
        frame = watcher.wait_for_step(40)
    alone = Simulation("The Talk/Dominos", iterations=7)
    for _ in range(frame.step):
        alone.step()
    assert whole_frame(alone.frame()) == whole_frame(frame)


def test_the_caller_never_waits() -> None:
    with running() as (session, watcher):
        watcher.wait_for_step(1)
        began = time.perf_counter()
        for _ in range(1000):
            session.submit(ask.MoveHand(1, 0.0, 0.0))
        assert time.perf_counter() - began < 0.5


@pytest.mark.parametrize("speed", [0.25, 3.0])
def test_speed(speed: float) -> None:
    with running() as (session, watcher):
        began = time.perf_counter()
        session.submit(ask.SetSpeed(speed))
        first = watcher.wait(lambda frame: frame.status.speed == speed).step
        time.sleep(0.5)
        last, took = session.frame.step, time.perf_counter() - began
        assert last - first <= took * 60 * speed + clock.MOST_AT_ONCE + 1
        watcher.wait(lambda frame: 0.8 < frame.status.steps_per_second / (60 * speed) < 1.1)


def test_says_when_it_cannot_keep_real_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "PATIENCE", 0.3)
    step = Simulation.step
    slow = threading.Event()
    slow.set()
    monkeypatch.setattr(Simulation, "step", lambda self: (step(self), slow.is_set() and time.sleep(0.05)))
    with running() as (_, watcher):
        frame = watcher.wait(lambda frame: frame.status.behind)
        assert 5 < frame.status.steps_per_second < 21
        slow.clear()
        watcher.wait(lambda frame: not frame.status.behind)


def test_pause_and_play() -> None:
    with running() as (session, watcher):
        watcher.wait_for_step(3)
        session.submit(ask.Pause())
        paused = watcher.wait(lambda frame: frame.status.paused)
        assert paused.status.steps_per_second == 0.0
        time.sleep(0.15)
        assert session.frame.step == paused.step
        session.submit(ask.Play())
        played = watcher.wait(lambda frame: frame.step > paused.step)
        assert not played.status.paused
        assert played.step < paused.step + 10, "the pause was not caught up"


def test_a_pause_is_not_counted_as_being_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "PATIENCE", 0.5)
    with running(paused=True) as (session, watcher):
        paused = watcher.wait(lambda frame: frame.status.paused)
        time.sleep(0.7)
        session.submit(ask.Play())
        watcher.wait_for_step(paused.step + 1)
        first = next(frame for frame in watcher.frames if frame.step == paused.step + 1)
        assert not first.status.behind


def test_single_steps() -> None:
    with running(paused=True) as (session, watcher):
        step_by_step(session, watcher, 3)
        time.sleep(0.1)
        assert session.frame.step == 3
        assert session.frame.status.paused


def test_a_single_step_pauses() -> None:
    with running() as (session, watcher):
        watcher.wait_for_step(2)
        session.submit(ask.StepOnce())
        frame = watcher.wait(lambda frame: frame.status.paused)
        time.sleep(0.1)
        assert session.frame.step == frame.step


def test_commands_are_obeyed_while_it_stands_still() -> None:
    with running(paused=True) as (session, watcher):
        session.submit(ask.Spawn("box", 3.0, 5.0))
        frame = watcher.wait(lambda frame: len(frame.serials) == 3)
        assert frame.step == 0
        assert frame.content != watcher.frames[0].content
        frame = step_by_step(session, watcher, 1)
        stepped = next(frame for frame in watcher.frames if frame.step == 1)
        assert [command["command"] for command in stepped.commands] == ["spawn"]


def test_a_frame_carries_the_commands_before_its_step_and_no_others() -> None:
    given = [ask.Set("iterations", 5), ask.Grab(1, 0.0, 4.0), ask.MoveHand(1, 2.0, 5.0)]
    with running(paused=True) as (session, watcher):
        for command in given:
            session.submit(command)
            session.submit(ask.SetSpeed(2.0))  # not physics: not recorded
        step_by_step(session, watcher, 2)
    first, second = (next(frame for frame in watcher.frames if frame.step == step) for step in (1, 2))
    assert list(first.commands) == [command.to_dict() for command in given]
    assert second.commands == ()


def test_reset_keeps_the_settings() -> None:
    with running("The Talk/Pyramid", paused=True, precision="double") as (session, watcher):
        start = watcher.frames[0]
        for command in (ask.Set("iterations", 3), ask.Set("gravity", (1.0, -5.0)), ask.Set("warm_starting", False)):
            session.submit(command)
        session.submit(ask.Bomb(0, 15, 0, 0, -20, 0))
        before = step_by_step(session, watcher, 5)
        session.submit(ask.Reset())
        frame = watcher.wait(lambda frame: frame.step == 0 and frame.settings.iterations == 3)
        assert frame.settings == before.settings
        assert frame.settings.precision == "double"
        assert frame.time == 0.0
        assert frame.content > before.content
        assert frame.positions.tobytes() == start.positions.tobytes()
        assert frame.status.paused, "a reset does not set it going"
        assert session.scene.name == "The Talk/Pyramid"


def test_another_scene_brings_its_own_gravity_and_keeps_the_solvers_settings() -> None:
    with running("The Talk/Pyramid", paused=True) as (session, watcher):
        session.submit(ask.Set("iterations", 3))
        session.submit(ask.Set("gravity", (1.0, -5.0)))
        session.submit(ask.Grab(1, -6.0, 0.75))
        session.submit(ask.LoadScene("The Talk/Dominos"))
        frame = watcher.wait(lambda frame: frame.scene == "The Talk/Dominos")
        assert (frame.step, len(frame.joints)) == (0, 4)
        assert frame.settings.iterations == 3
        assert frame.settings.gravity == (0.0, -10.0)
        assert session.scene.name == "The Talk/Dominos"
        session.submit(ask.MoveHand(1, 0.0, 10.0))
        frame = step_by_step(session, watcher, 1)
    alone = Simulation("The Talk/Dominos", iterations=3)
    alone.step()
    assert whole_frame(alone.frame()) == whole_frame(frame), "a hand of the scene before still pulls"


def test_a_late_viewer_gets_the_latest_frame_at_once() -> None:
    with running(paused=True) as (session, watcher):
        step_by_step(session, watcher, 2)
        late = Watcher()
        session.add_viewer(late)
        assert [frame.step for frame in late.frames] == [2]


def test_several_watch_and_one_that_went_sees_no_more() -> None:
    with running(paused=True) as (session, watcher):
        stays, goes = NullViewer(), Watcher()
        session.add_viewer(stays)
        session.add_viewer(goes)
        session.remove_viewer(goes)
        session.remove_viewer(goes)
        step_by_step(session, watcher, 1)
        until(lambda: stays.last is not None and stays.last.step == 1)
        assert stays.frame_count >= 2
        assert [frame.step for frame in goes.frames] == [0]


def test_a_failing_viewer_is_dropped_and_the_loop_goes_on(caplog: pytest.LogCaptureFixture) -> None:
    class Fails(Watcher):
        def show(self, frame: Frame) -> None:
            super().show(frame)
            if frame.step > 0:
                raise RuntimeError("its window is gone")

    with running(paused=True) as (session, watcher):
        fails = Fails()
        session.add_viewer(fails)
        frame = step_by_step(session, watcher, 3)
        assert [frame.step for frame in fails.frames if frame.step] == [1]
        assert frame.status.failure == ""
    assert "its window is gone" in caplog.text


def test_frames_are_read_only() -> None:
    with running() as (_, watcher):
        frame = watcher.wait_for_step(3)
    for value in vars(frame).values():
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable
    with pytest.raises(AttributeError):
        frame.step = 0


def test_frames_of_many_steps_do_not_share_memory() -> None:
    with running() as (_, watcher):
        watcher.wait_for_step(20)
    heights = [float(frame.positions[1, 1]) for frame in watcher.frames if frame.step]
    assert heights == sorted(heights, reverse=True)
    assert len(set(heights)) > 15


def test_closing_closes_the_viewers_though_one_fails() -> None:
    class Stuck(NullViewer):
        def close(self) -> None:
            raise RuntimeError("will not close")

    session, watcher = Session("The Talk/Single Box"), Watcher()
    session.add_viewer(Stuck())
    session.add_viewer(watcher)
    session.start()
    session.close()
    session.close()
    assert watcher.closed
    count = len(watcher.frames)
    time.sleep(0.1)
    assert len(watcher.frames) == count, "it still runs"


def test_closing_before_the_start() -> None:
    session, watcher = Session("The Talk/Single Box"), Watcher()
    session.add_viewer(watcher)
    session.close()
    assert watcher.closed


@pytest.mark.parametrize("paused", [False, True])
def test_closes_quickly(paused: bool) -> None:
    with running(paused=paused) as (session, watcher):
        watcher.wait(lambda frame: frame.status.paused == paused)
        began = time.perf_counter()
        session.close()
        assert time.perf_counter() - began < 1.0
