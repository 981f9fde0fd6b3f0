"""Whatever happens, the loop goes on, and the last good state with it."""

from __future__ import annotations

import logging
import threading
import time
from typing import Any

import numpy as np
import pytest

from engine import Box, StepError, World
from sandbox import commands as ask
from sandbox import session as sessions
from sandbox import simulation as simulations
from sandbox.scenes import SCENES, Scene
from sandbox.session import Session
from sandbox.simulation import Simulation
from tests.sandbox.watching import PushTooHard, running, step_by_step, until, whole_frame


@pytest.mark.parametrize("rubbish", [None, "spawn", 5, {"command": "spawn"}, object(), ask.Spawn, b"\x00"])
def test_rubbish_is_ignored_logged_and_told(rubbish: Any, caplog: pytest.LogCaptureFixture) -> None:
    with running(paused=True) as (session, watcher):
        session.submit(rubbish)
        frame = watcher.wait(lambda frame: frame.status.notice)
        assert "must be one of sandbox.commands" in frame.status.notice
        after = step_by_step(session, watcher, 1)
        assert after.status.failure == ""
    assert any(record.levelno == logging.WARNING and "ignored" in record.message for record in caplog.records)
    alone = Simulation("The Talk/Single Box")
    alone.step()
    assert whole_frame(alone.frame()) == whole_frame(after)


def test_a_command_that_cannot_be_done_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulations, "MOST_BODIES", 5000)
    with running(paused=True) as (session, watcher):
        for _ in range(25):
            session.submit(ask.Spawn("box", 0.0, 9.0, count=200))
        frame = watcher.wait(lambda frame: "count = 200" in frame.status.notice)
        assert len(frame.serials) == 24 * 200 + 2
        assert frame.status.failure == ""


def test_a_full_queue_says_so() -> None:
    session = Session("The Talk/Single Box")
    accepted = [session.submit(ask.Release(1)) for _ in range(sessions.MOST_QUEUED + 10)]
    assert accepted == [True] * sessions.MOST_QUEUED + [False] * 10
    session.start()
    try:
        until(lambda: session.submit(ask.Release(1)))
        until(lambda: session.frame.step > 10)
    finally:
        session.close()


def test_a_flood_does_not_stop_the_steps() -> None:
    """Of the costliest command: taking hold looks at every body."""

    def crowd(world: World) -> None:
        for i in range(400):
            world.create_body(Box(0.5, 0.5), position=(i % 40, i // 40), kind="static")
        world.create_body(Box(1, 1), position=(0.0, 20.0))

    SCENES["Test/Crowd"] = Scene("Test/Crowd", crowd, "", (0.0, 0.0, 10.0))
    ended = threading.Event()
    try:
        with running("Test/Crowd") as (session, watcher):

            def flood() -> None:
                while not ended.is_set():
                    if not session.submit(ask.Grab(1, 0.0, 900.0)):
                        ended.wait(0.01)

            flooder = threading.Thread(target=flood)
            watcher.wait_for_step(1)
            flooder.start()
            try:
                until(lambda: not session.submit(ask.Grab(1, 0.0, 900.0)))  # the queue is full
                first = session.frame.step
                time.sleep(1.0)
                assert session.frame.step - first > 15
            finally:
                ended.set()
                flooder.join()
    finally:
        del SCENES["Test/Crowd"]


def test_standing_still_a_flood_does_not_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sessions, "MOST_A_STEP", 50)
    with running(paused=True) as (session, watcher):
        for _ in range(200):
            session.submit(ask.MoveHand(1, 1.0, 1.0))
        watcher.wait(lambda frame: "at most 50" in frame.status.notice)
        step_by_step(session, watcher, 1)
        stepped = next(frame for frame in watcher.frames if frame.step == 1)
        assert len(stepped.commands) == 50
        session.submit(ask.Set("iterations", 4))
        watcher.wait(lambda frame: frame.settings.iterations == 4)


@pytest.mark.parametrize("steps", [0, 4, 63])
def test_a_failing_step_keeps_the_last_good_state_pauses_and_says_so(steps: int) -> None:
    with running("The Talk/Dominos", paused=True) as (session, watcher):
        session.submit(ask.Set("gravity", (0.5, -9.0)))
        good = step_by_step(session, watcher, steps)
        session.submit(ask.Spawn("box", 0.0, 30.0))
        session.submit(PushTooHard())
        session.submit(ask.Play())
        frame = watcher.wait(lambda frame: frame.status.failure)
        assert f"body {len(good.serials)} is no longer finite" in frame.status.failure
        assert frame.status.paused
        if steps:
            assert whole_frame(frame) == whole_frame(good)
        time.sleep(0.1)
        assert session.frame.step == steps

        session.submit(ask.Play())
        frame = watcher.wait_for_step(steps + 5)
        assert frame.status.failure == ""
        assert not frame.status.paused
        first = next(frame for frame in watcher.frames if frame.step == steps + 1)
        assert first.commands == (), "what failed is not done again"
        assert np.isfinite(frame.positions).all()


def test_a_failing_single_step_too() -> None:
    with running(paused=True) as (session, watcher):
        good = step_by_step(session, watcher, 2)
        session.submit(PushTooHard())
        session.submit(ask.StepOnce())
        frame = watcher.wait(lambda frame: frame.status.failure)
        assert whole_frame(frame) == whole_frame(good)
        frame = step_by_step(session, watcher, 1)
        assert frame.status.failure == ""


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_body_poisoned_from_outside_is_named_and_the_last_good_state_kept(value: float) -> None:
    """Behind the session's back, between two steps: what the step finds is told, and undone."""
    with running("The Talk/Pyramid", paused=True) as (session, watcher):
        good = step_by_step(session, watcher, 5)
        world = session._simulation.world
        body = world.bodies[7]
        world._state.bodies.tables["motions"]["vx"][body._row] = value
        session.submit(ask.StepOnce())
        frame = watcher.wait(lambda frame: frame.status.failure)
        assert "is no longer finite" in frame.status.failure
        assert "body " in frame.status.failure
        assert np.isfinite(frame.positions).all()
        assert whole_frame(frame) == whole_frame(good)
        assert step_by_step(session, watcher, 1).status.failure == ""


@pytest.mark.parametrize("error", [StepError("made up"), RuntimeError("made up"), MemoryError("made up")])
def test_whatever_fails_in_a_step_is_taken_back(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    step = Simulation.step

    def fails_once_half_way(self: Simulation) -> None:
        step(self)
        if self.world.iterations == 9:
            self.world.iterations = 8
            raise error

    with running(paused=True) as (session, watcher):
        step_by_step(session, watcher, 5)
        monkeypatch.setattr(Simulation, "step", fails_once_half_way)
        session.submit(ask.Set("iterations", 9))
        session.submit(ask.Play())
        frame = watcher.wait(lambda frame: frame.status.failure)
        assert "made up" in frame.status.failure
        assert frame.status.paused
        session.submit(ask.Reset())
        frame = watcher.wait(lambda frame: frame.step == 0 and not frame.status.failure)
        session.submit(ask.Play())
        watcher.wait_for_step(5)


def test_goes_back_in_the_scene_that_runs_now() -> None:
    with running("The Talk/Pyramid", paused=True) as (session, watcher):
        step_by_step(session, watcher, 3)
        session.submit(ask.LoadScene("The Talk/Dominos"))
        watcher.wait(lambda frame: frame.scene == "The Talk/Dominos")
        good = step_by_step(session, watcher, 2)
        session.submit(PushTooHard())
        session.submit(ask.StepOnce())
        frame = watcher.wait(lambda frame: frame.status.failure)
        assert whole_frame(frame) == whole_frame(good)


def test_a_reset_ends_a_failure() -> None:
    with running(paused=True) as (session, watcher):
        session.submit(PushTooHard())
        session.submit(ask.StepOnce())
        watcher.wait(lambda frame: frame.status.failure)
        session.submit(ask.Reset())
        watcher.wait(lambda frame: not frame.status.failure)
