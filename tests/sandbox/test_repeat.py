"""What was recorded comes again bit for bit, however lively it was; and what was tampered with does not."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import recordings
from engine import Snapshot
from recordings import Difference, Recording
from sandbox import commands as ask
from sandbox.recorder import PartFile
from sandbox.repeat import repeat, simulation_at_start
from sandbox.simulation import Simulation
from sandbox.verbs.run import open_recorder
from tests.sandbox.watching import PRECISIONS, LivelyHands, bits, running, until


def verify(recording: Recording) -> Difference | None:
    return recordings.compare(recording, repeat(recording))


def lively_session(folder: Path, seed: int, precision: str, before: int, steps: int) -> Recording:
    """A session with busy visitors; the recording begins after so many steps."""
    with running("The Talk/Circles", paused=True, open_recorder=open_recorder, record_dir=folder,
                 precision=precision) as (session, watcher):  # fmt: skip
        visitors = LivelyHands(seed)
        for step in range(before + steps):
            if step == before:
                session.submit(ask.StartRecording())
            for command in visitors.commands(session.frame.positions):
                session.submit(command)
            session.submit(ask.StepOnce())
            watcher.wait_for_step(step + 1)
    assert session.last_recording is not None
    return recordings.read(session.last_recording)


@settings(max_examples=6)
@given(
    seed=st.integers(0, 2**32),
    precision=st.sampled_from(PRECISIONS),
    before=st.sampled_from([0, 1, 30]),
)
def test_a_lively_session_comes_again_bit_for_bit(
    tmp_path_factory: pytest.TempPathFactory, seed: int, precision: str, before: int
) -> None:
    recording = lively_session(tmp_path_factory.mktemp("lively"), seed, precision, before, 60)
    assert len(recording.steps) == 60
    assert recording.start_step == before
    assert recording.commands, "nobody did anything"
    assert verify(recording) is None


def test_a_session_in_real_time_too(tmp_path: Path) -> None:
    """Commands from several threads at once, at whatever moments."""
    with running("The Talk/Dominos", open_recorder=open_recorder, record_dir=tmp_path) as (session, watcher):
        watcher.wait_for_step(10)
        ended = threading.Event()

        def visit(seed: int) -> None:
            visitor = LivelyHands(seed)
            while not ended.wait(0.005):
                for command in visitor.commands(session.frame.positions):
                    session.submit(command)

        visitors = [threading.Thread(target=visit, args=(seed,)) for seed in range(3)]
        for visitor in visitors:
            visitor.start()
        time.sleep(0.1)
        session.submit(ask.StartRecording())
        first = watcher.wait(lambda frame: frame.status.recording).step
        session.submit(ask.SetSpeed(2.0))
        watcher.wait_for_step(first + 40)
        session.submit(ask.Pause())
        time.sleep(0.05)
        session.submit(ask.StepOnce())
        session.submit(ask.Play())
        watcher.wait_for_step(first + 60)
        session.submit(ask.StopRecording())
        until(lambda: session.last_recording)
        ended.set()
        for visitor in visitors:
            visitor.join()
    recording = recordings.read(session.last_recording)
    assert recording.start_step > 10
    assert len(recording.steps) >= 59
    assert len(recording.commands) > 20
    assert verify(recording) is None


# --- simulations made by hand: what no page can do --------------------------------------------------------------------


def recorded_by_hand(path: Path, simulation: Simulation, commands: dict[int, list[Any]], steps: int) -> Recording:
    """Records so many steps, with commands before some of them, counted from the recording's start."""
    file = PartFile(path, open_recorder, simulation)
    for step in range(steps):
        given = commands.get(step, [])
        for command in given:
            simulation.apply(command)
        simulation.step()
        file.show(simulation.frame(tuple(command.to_dict() for command in given)))
    return recordings.read(file.finish())


COMMANDS: dict[int, list[Any]] = {
    3: [ask.MoveHand(1, 4.0, 8.0)],
    8: [ask.Spawn("circle", 1.0, 14.0, 0.6, count=4), ask.Grab(2, 0.67, 14.0)],
    12: [ask.Set("gravity", (2.0, -8.0))],
    20: [ask.Bomb(-4.0, 15.0, 0.1, 6.0, -22.0, 9.0)],
    30: [ask.Release(1), ask.Set("warm_starting", False)],
}


def mid_session(path: Path) -> Recording:
    """Begun in the middle: bodies destroyed and spawned, the bomb thrown and destroyed, a drag under way."""
    simulation = Simulation("The Talk/Pyramid")
    for command in (ask.Bomb(0.0, 15.0, 0.0, 0.0, -20.0, 0.0), ask.Spawn("box", 0.0, 20.0, 0.4, 0.4, count=9)):
        simulation.apply(command)
    for _ in range(30):
        simulation.step()
    simulation.apply(ask.Grab(1, *simulation.world.bodies[40].position))
    simulation.apply(ask.Grab(7, *simulation.world.bodies[50].position))
    for body in [simulation.world.bodies[place] for place in (3, 4, 20, 79)]:  # the bomb is 79
        body.destroy()
    simulation.world.find_body(simulation.hands[7].serial).destroy()  # a hand's body, unnoticed so far
    simulation.apply(ask.MoveHand(1, -3.0, 9.0))
    return recorded_by_hand(path, simulation, COMMANDS, 60)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return mid_session(tmp_path_factory.mktemp("mid") / "session.rrd")


def test_one_begun_in_mid_session_comes_again(recording: Recording) -> None:
    assert recording.start_step == 30
    assert set(recording.hands["hands"]) == {"1", "7"}
    assert verify(recording) is None
    assert verify(recording) is None, "and again"


def test_one_begun_after_going_back_comes_again(tmp_path: Path) -> None:
    """Serials do not go back with a restored state: a recording must not mind."""
    simulation = Simulation("The Talk/Teeter")
    snapshot, extras = simulation.world.snapshot(), simulation.extras()
    simulation.apply(ask.Spawn("box", 0.0, 9.0, count=5))
    simulation.step()
    simulation.restore(snapshot, extras)
    simulation.apply(ask.Spawn("box", 0.0, 9.0, count=2))
    assert verify(recorded_by_hand(tmp_path / "x.rrd", simulation, COMMANDS, 40)) is None


@pytest.mark.parametrize("dt", [1 / 240, 1 / 20, 0.017])
def test_other_time_steps_come_again(dt: float, tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Suspension Bridge", dt, precision="double", iterations=3)
    recording = recorded_by_hand(tmp_path / "x.rrd", simulation, COMMANDS, 40)
    assert recording.dt == dt
    assert verify(recording) is None


def test_a_scene_that_is_gone_comes_again(recording: Recording) -> None:
    """All that it needs is in the recording."""
    assert verify(replace(recording, scene="Gone/Renamed")) is None


def test_the_start_is_that_of_the_recorded_simulation(tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Pyramid")
    simulation.apply(ask.Grab(5, -6.0, 0.75))
    simulation.step()
    expected = bits(simulation)
    assert bits(simulation_at_start(recorded_by_hand(tmp_path / "x.rrd", simulation, {}, 5))) == expected


# --- tampering --------------------------------------------------------------------------------------------------------


def with_table(recording: Recording, table: str, row: int, field: str) -> Recording:
    """The recording with one number of its start the least bit larger."""
    snapshot = Snapshot.from_bytes(recording.snapshot)
    tables = {name: np.array(values) for name, values in snapshot.tables.items()}
    values = tables[table][field]
    values[row] = np.nextafter(values[row], values.dtype.type(np.inf))
    return replace(recording, snapshot=Snapshot(snapshot.settings, tables).to_bytes())


@pytest.mark.parametrize(
    ("table", "field", "told"),
    [("bodies.bodies", "x", "x"), ("bodies.bodies", "angle", "angle"), ("bodies.motions", "vy", "velocity y"),
     ("bodies.motions", "w", "angular velocity")],
)  # fmt: skip
def test_one_last_bit_of_the_start_is_found(recording: Recording, table: str, field: str, told: str) -> None:
    difference = verify(with_table(recording, table, 10, field))
    assert difference is not None
    assert (difference.step, difference.body, difference.field) == (30, 10, told)
    assert "step 30, body 10: " + told in str(difference)


def test_one_last_bit_that_no_frame_shows_is_found_a_step_later(recording: Recording) -> None:
    """A body's mass is nowhere among the recorded states."""
    difference = verify(with_table(recording, "bodies.motions", 41, "inverse_mass"))
    assert difference is not None
    assert difference.step > 30
    assert difference.body is not None


def test_a_hand_a_little_off_is_found(recording: Recording) -> None:
    hand = recording.hands["hands"]["1"]
    moved = {**recording.hands, "hands": {"1": {**hand, "x": hand["x"] + 1e-5}}}
    difference = verify(replace(recording, hands=moved))
    assert difference is not None
    assert difference.step == 31


def told(command: dict[str, Any]) -> str:
    """A command's name; of one that sets, the setting."""
    return str(command.get("setting", command["command"]))


@pytest.mark.parametrize("name", ["move_hand", "spawn", "grab", "gravity", "bomb", "release", "warm_starting"])
def test_a_dropped_command_is_found_at_its_step(recording: Recording, name: str) -> None:
    step = next(step for step, given in recording.commands.items() if name in map(told, given))
    commands = {at: [c for c in given if told(c) != name] for at, given in recording.commands.items()}
    difference = verify(replace(recording, commands=commands))
    assert difference is not None
    late = name in ("warm_starting", "grab")  # the last step's impulses, or a hand that moves, show it
    assert step <= difference.step <= step + late
    assert (difference.body is None) == (name in ("spawn", "bomb"))
    expected = {"spawn": "body count", "bomb": "body count", "gravity": "x"}
    assert difference.field == expected.get(name, difference.field)


def test_a_command_a_step_too_late_is_found(recording: Recording) -> None:
    step = recording.start_step + 1 + 12
    commands = {at + (at == step): given for at, given in recording.commands.items()}
    difference = verify(replace(recording, commands=commands))
    assert difference is not None
    assert difference.step == step


def test_what_was_driven_comes_again(tmp_path: Path) -> None:
    simulation = Simulation("Joints/Car")
    for _ in range(20):
        simulation.step()  # the recording begins while it drives
    given = {5: [ask.DriveMotor(joint, 24.0) for joint in (0, 1)], 15: [ask.DriveMotor(0, 0.0)]}
    recording = recorded_by_hand(tmp_path / "x.rrd", simulation, given, 30)
    assert verify(recording) is None
    assert [len(commands) for commands in recording.commands.values()] == [2, 1]
    assert verify(replace(recording, commands={})) is not None


def test_the_last_bit_of_the_time_step_is_found(tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Dominos", precision="double")
    recording = recorded_by_hand(tmp_path / "x.rrd", simulation, {}, 5)
    difference = verify(replace(recording, dt=float(np.nextafter(recording.dt, 1.0))))
    assert difference is not None
    assert difference.step == 1


@pytest.mark.parametrize(
    "changes",
    [{"snapshot": b"rubbish"}, {"hands": {}}, {"hands": {"bomb": -1, "hands": {"1": {"serial": 3}}}},
     {"hands": {"bomb": "x", "hands": {}}}, {"commands": {33: [{"command": "quit"}]}},
     {"commands": {33: [{"command": "set_gravity", "x": float("nan"), "y": 0.0}]}}],
)  # fmt: skip
def test_what_cannot_be_computed_is_an_error_the_verb_expects(recording: Recording, changes: dict[str, Any]) -> None:
    with pytest.raises((ValueError, KeyError, TypeError)):
        verify(replace(recording, **changes))
