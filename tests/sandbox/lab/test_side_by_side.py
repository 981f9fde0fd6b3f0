"""Other solvers follow a live scene step by step: bit by bit where they are the live one's own, with its commands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from engine import StepError
from sandbox.commands import Set, SetAll, Spawn
from sandbox.frame import Frame
from sandbox.lab import side_by_side
from sandbox.lab.side_by_side import SideBySide
from sandbox.simulation import Simulation
from tests.web.fake_session import wait_until

SCENE = "The Talk/Teeter"
TALK = "sequential_impulses"


class Live:
    """A session's part: it steps and shows."""

    def __init__(self, others: SideBySide, scene: str = SCENE) -> None:
        self.others = others
        self.simulation = Simulation(scene)
        self.commands: list[Any] = []

    def show(self) -> Frame:
        frame = self.simulation.frame(tuple(command.to_dict() for command in self.commands))
        self.commands.clear()
        self.others.show(frame)
        return frame

    def step(self, count: int = 1) -> Frame:
        for _ in range(count):
            self.simulation.step()
            frame = self.show()
        return frame

    def apply(self, command: Any) -> None:
        self.simulation.apply(command)
        self.commands.append(command)


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def live(said: list[str]) -> Iterator[Live]:
    others = SideBySide(said.append)
    yield Live(others)
    others.close()


def reaches(live: Live, solver: str, frame: Frame) -> Frame:
    """The solver's frame of the same step."""
    return wait_until(
        lambda: (found := live.others.frames.get(solver)) is not None and found.step == frame.step and found
    )  # fmt: skip


def test_nothing_is_stepped_until_somebody_asks(live: Live) -> None:
    live.show()
    live.step(3)
    assert live.others.frames == {}
    assert live.others._queue.empty()


def test_the_same_solver_is_the_same_bit_by_bit_and_another_differs(live: Live) -> None:
    live.others.choose(("soft_step", TALK), live.show())
    live.show()
    live.step(10)
    live.apply(Spawn("box", x=1.0, y=6.0, width=1.0, height=1.0))
    live.apply(Set("gravity", (1.0, -9.0)))
    frame = live.step(40)
    same, other = reaches(live, "soft_step", frame), reaches(live, TALK, frame)
    np.testing.assert_array_equal(same.positions, frame.positions)
    assert other.positions.shape == frame.positions.shape
    assert not np.array_equal(other.positions, frame.positions)
    assert (other.settings.solver, other.settings.gravity) == (TALK, (1.0, -9.0))


def test_it_begins_with_the_scenes_next_beginning(live: Live) -> None:
    live.show()
    live.step(5)
    live.others.choose((TALK,), live.show())
    live.step(5)
    assert live.others.frames == {}
    live.simulation = Simulation(SCENE)
    frame = live.step(4)  # a session in a hurry does not show step 0
    assert reaches(live, TALK, frame).step == 4


def test_a_solver_keeps_its_own_numbers(live: Live) -> None:
    live.others.choose((TALK,), live.show())
    live.show()
    live.apply(Set("solver", "soft_step"))
    live.apply(Set("substeps", 9))
    live.apply(Set("warm_starting", False))
    settings = reaches(live, TALK, live.step()).settings
    assert (settings.solver, settings.substeps, settings.iterations) == (TALK, 1, 10)
    assert not settings.warm_starting


def test_what_a_solver_lacks_is_said_and_the_others_go_on(said: list[str]) -> None:
    others = SideBySide(said.append)
    live = Live(others, "Effects/Restitution")
    others.choose((TALK, "soft_step"), live.show())
    assert f"{TALK}: " in said[-1]
    assert "restitution" in said[-1]
    live.show()
    reaches(live, "soft_step", live.step(3))
    assert set(others.frames) == {"soft_step"}
    others.close()


def test_a_scene_that_goes_back_ends_the_comparison_and_says_so(live: Live, said: list[str]) -> None:
    live.others.choose((TALK,), live.show())
    live.show()
    reaches(live, TALK, live.step(5))
    live.simulation.step()
    live.simulation.step()
    live.show()
    wait_until(lambda: said and "reset it" in said[-1])
    assert live.others.frames == {}


def test_a_solver_that_loses_its_state_is_named(live: Live, said: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    live.others.choose((TALK, "soft_step"), live.show())
    live.show()
    reaches(live, TALK, live.step())
    simulation = live.others._simulations[TALK]

    def fail() -> None:
        raise StepError("body 3 has left")

    monkeypatch.setattr(simulation, "step", fail)
    reaches(live, "soft_step", live.step(2))
    assert said[-1] == f"{TALK} stopped following: body 3 has left"
    assert set(live.others.frames) == {"soft_step"}


def test_one_that_cannot_keep_up_ends(live: Live, said: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(side_by_side, "MOST_WAITING", 3)
    others = SideBySide(said.append)
    live.others = others
    others.choose((TALK,), live.show())
    with others._lock:
        live.step(8)
    assert "could not keep up" in said[-1]
    assert others.ended
    others._tell()  # as a solver that is lost on the other thread does
    assert "could not keep up" in said[-1]
    others.choose((TALK,), live.show())
    assert (others.ended, said[-1]) == (False, "")
    others.close()


def test_what_is_shown_while_it_compiles_does_not_end_it(
    live: Live, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Compiling takes longer than all the frames that may wait."""
    monkeypatch.setattr(side_by_side, "MOST_WAITING", 3)
    others = live.others = SideBySide(said.append)
    rehearse = others._rehearse
    monkeypatch.setattr(others, "_rehearse", lambda *arguments: (live.step(20), rehearse(*arguments)))
    others.choose((TALK,), live.show())
    assert (others.ended, said[-1]) == (False, "")
    live.simulation = Simulation(SCENE)
    live.show()
    assert reaches(live, TALK, live.step()).step == 1
    others.close()


def test_a_solver_that_is_refused_what_the_live_one_does_stops_and_says_why(live: Live, said: list[str]) -> None:
    """A body that bounces is spawned beside a solver that has no restitution."""
    live.others.choose((TALK, "soft_step"), live.show())
    live.show()
    reaches(live, TALK, live.step())
    live.apply(Spawn("circle", x=0.0, y=6.0, restitution=0.5))
    reaches(live, "soft_step", live.step(2))
    assert set(live.others.frames) == {"soft_step"}
    assert said[-1].startswith(f"{TALK} stopped following: ")
    assert "restitution" in said[-1]
    live.simulation = Simulation(SCENE)  # which it can have, as before
    live.show()
    reaches(live, TALK, live.step())
    assert said[-1] == ""


def test_several_settings_at_once_leave_a_solver_its_own_numbers(live: Live) -> None:
    live.others.choose((TALK,), live.show())
    live.show()
    live.apply(SetAll({"solver": "soft_step", "substeps": 9, "warm_starting": False}))
    live.apply(SetAll({"substeps": 7, "iterations": 2}))
    settings = reaches(live, TALK, live.step()).settings
    assert (settings.solver, settings.substeps, settings.iterations) == (TALK, 1, 10)
    assert not settings.warm_starting
