"""After a step that failed the state before it is back, bit for bit."""

from __future__ import annotations

from typing import Any

import pytest

from engine import StepError
from sandbox import commands as ask
from sandbox.rewind import EVERY, History
from sandbox.simulation import Simulation
from tests.sandbox.watching import LARGEST, LivelyHands

SNAPSHOTS = (0, 1, 7, EVERY - 1, EVERY, EVERY + 1, 2 * EVERY + 5)


def lively(steps: int) -> tuple[Simulation, History]:
    """A simulation after so many steps with commands, and its history."""
    simulation = Simulation("The Talk/Circles")
    history, visitors = History(simulation), LivelyHands(11)
    for _ in range(steps):
        for command in visitors.commands(simulation.world.positions):
            simulation.apply(command)
            history.applied(command)
        simulation.step()
        history.stepped()
    return simulation, history


def meaning(simulation: Simulation) -> tuple[Any, ...]:
    """All that a later step depends on, but for serials: what is created again gets new ones."""
    world = simulation.world
    places = {body.serial: place for place, body in enumerate(world.bodies)}
    hands = {
        key: (places[hand.serial], hand.anchor_x, hand.anchor_y, hand.x, hand.y)
        for key, hand in simulation.hands.items()
    }
    bomb = places.get(simulation.bomb_serial)
    return world.state_hash(), world.step_count, world.time, world.settings, hands, bomb


@pytest.mark.parametrize("steps", SNAPSHOTS)
def test_goes_back_to_the_last_good_step(steps: int) -> None:
    simulation, history = lively(steps)
    good = meaning(simulation)
    for command in (ask.Set("gravity", (1.0, 2.0)), ask.Spawn("box", 0.0, 9.0, count=3), ask.Grab(3, 0.0, 9.0)):
        simulation.apply(command)  # given since: left out
        history.applied(command)
    simulation.world.bodies[-1].velocity = (LARGEST, 0.0)
    simulation.world.bodies[-1].force = (LARGEST, 0.0)
    with pytest.raises(StepError):
        simulation.step()
    history.go_back()
    assert meaning(simulation) == good
    assert simulation.world.step_count == steps


def test_goes_on_afterwards_as_if_nothing_had_been() -> None:
    broken, history = lively(EVERY + 20)
    unhurt, _ = lively(EVERY + 20)
    history.go_back()
    for simulation in (broken, unhurt):
        for _ in range(EVERY + 5):
            simulation.step()
    assert meaning(broken) == meaning(unhurt)


def test_can_go_back_again_and_again() -> None:
    simulation, history = lively(30)
    good = meaning(simulation)
    for _ in range(3):
        simulation.apply(ask.Set("gravity", (5.0, 5.0)))
        history.applied(ask.Set("gravity", (5.0, 5.0)))
        history.go_back()
        assert meaning(simulation) == good
    command = ask.Set("gravity", (5.0, 5.0))
    simulation.apply(command)
    history.applied(command)
    simulation.step()
    history.stepped()
    good = meaning(simulation)
    history.go_back()
    assert meaning(simulation) == good


def test_an_older_state_is_better_than_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """If even the steps that were good fail now, it is the snapshot that comes back."""
    simulation, history = lively(EVERY)
    snapshot = meaning(simulation)
    for _ in range(10):
        simulation.step()
        history.stepped()
    step, start = simulation.step, simulation.world.step_count - 10

    def fail_in_the_middle() -> None:
        if simulation.world.step_count - start == 5:
            raise StepError("made up")
        step()

    monkeypatch.setattr(simulation, "step", fail_in_the_middle)
    history.go_back()
    assert meaning(simulation) == snapshot


def test_keeps_no_more_than_since_the_last_snapshot() -> None:
    simulation, history = lively(1)
    for _ in range(3 * EVERY):
        simulation.apply(ask.Set("iterations", 5))
        history.applied(ask.Set("iterations", 5))
        simulation.step()
        history.stepped()
    assert len(history._since) <= EVERY
