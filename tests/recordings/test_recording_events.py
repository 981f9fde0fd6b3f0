"""Events in recordings: all of them come back, of each step; a difference is found and named; a log tells them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recordings
from engine import Box, Circle, Events, World
from recordings import schema
from recordings.events_view import happened_sheets
from recordings.rrd import read_chunks
from recordings.shot import take
from sandbox.frame import Frame
from sandbox.gathering import Gathering
from sandbox.recorder import PartFile
from sandbox.repeat import repeat
from sandbox.scenes import Scene
from sandbox.simulation import Simulation

STEPS = 50


def rain(world: World) -> None:
    """Balls and boxes that fall fast, and some of which bounce."""
    world.create_body(Box(40, 2), position=(0, -1), kind="static")
    for k in range(12):
        shape = Circle(0.3) if k % 2 else Box(0.6, 0.4)
        place = (0.35 * (k % 4), 0.6 + 0.5 * k)
        world.create_body(shape, position=place, velocity=(0.2 * k, -4), restitution=0.6 * (k % 2))


RAIN = Scene("Test/Rain", rain, "", (0.0, 3.0, 8.0))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Frame]]:
    """A recording of boxes that fall onto each other, and the frames that it was made of; noted events among them."""
    simulation = Simulation(RAIN, tell_events=True, hit_speed=0.25)
    for _ in range(10):
        simulation.step()
    path = tmp_path_factory.mktemp("events") / "events.rrd"
    file = PartFile(path, recordings.Writer, simulation)
    frames = []
    for step in range(STEPS):
        if step == 20:
            note = simulation.world._state.happened
            note.note_broken(3, 0, 1, 12.5, 0.25)
            note.note_fell_asleep([1, 2])
            note.note_woke([2])
        simulation.step()
        frames.append(simulation.frame())
        file.show(frames[-1])
    return file.finish(), frames


def same(first: Events, second: Events) -> bool:
    return all(a.tobytes() == b.tobytes() and a.dtype == b.dtype for a, b in zip(first, second, strict=True))


def test_all_of_them_come_back(made: tuple[Path, list[Frame]]) -> None:
    path, frames = made
    recording = recordings.read(path)
    for frame in frames:
        events = recording.state(frame.step).events
        assert same(events, frame.events)
        assert not any(rows.flags.writeable for rows in events)
    assert sum(len(frame.events.begin) for frame in frames) > 5
    assert sum(len(frame.events.hit) for frame in frames) > 3
    assert all(sum(len(rows) for rows in kind) for kind in zip(*(frame.events for frame in frames), strict=True))
    assert not any(map(len, recording.state(recording.start_step).events)), "what led to the start is not in it"


def test_it_is_computed_again(tmp_path: Path) -> None:
    simulation = Simulation(RAIN, tell_events=True)
    file = PartFile(tmp_path / "again.rrd", recordings.Writer, simulation)
    for _ in range(30):
        simulation.step()
        file.show(simulation.frame())
    recording = recordings.read(file.finish())
    assert any(len(recording.state(int(step)).events.begin) for step in recording.steps)
    assert recordings.compare(recording, repeat(recording)) is None


def with_events(frames: list[Frame], step: int, **kinds: Any) -> Iterator[Frame]:
    for frame in frames:
        yield replace(frame, events=frame.events._replace(**kinds)) if frame.step == step else frame


@pytest.mark.parametrize("kind", Events._fields)
def test_one_that_differs_is_found_and_named(made: tuple[Path, list[Frame]], kind: str) -> None:
    path, frames = made
    recording = recordings.read(path)
    assert recordings.compare(recording, frames) is None
    at = next(frame for frame in frames if len(getattr(frame.events, kind)))
    rows = getattr(at.events, kind)
    name = kind.replace("_", " ")
    found = recordings.compare(recording, with_events(frames, at.step, **{kind: rows[1:]}))
    assert found is not None
    assert (found.step, found.field) == (at.step, f"{name} event count")
    for field in set(rows.dtype.names) - {"step"}:
        other = rows.copy()
        other[field][-1] += 1
        found = recordings.compare(recording, with_events(frames, at.step, **{kind: other}))
        assert found is not None
        assert (found.step, found.field) == (at.step, f"{name} event {field}")


def test_a_file_cut_short_gives_those_of_its_steps(made: tuple[Path, list[Frame]], tmp_path: Path) -> None:
    path, frames = made
    whole = path.read_bytes()
    short = tmp_path / "short.rrd"
    for part in (0.5, 0.8, 0.95):
        short.write_bytes(whole[: int(part * len(whole))])
        recording = recordings.read(short)
        for frame in frames:
            if recording.holds(frame.step):
                assert same(recording.state(frame.step).events, frame.events)


def test_nothing_is_written_where_nobody_asked(tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Single Box")
    file = PartFile(tmp_path / "plain.rrd", recordings.Writer, simulation)
    for _ in range(40):
        simulation.step()
        file.show(simulation.frame())
    paths = {chunk.path for chunk in read_chunks(file.finish(), schema.APPLICATION)}
    assert schema.CONTACTS.path in paths
    assert not paths & {schema.HAPPENED, *(table.path for table in schema.HAPPENINGS.values())}


def test_the_log_and_the_points_to_look_at(made: tuple[Path, list[Frame]]) -> None:
    path, frames = made
    paths = {chunk.path for chunk in read_chunks(path, schema.APPLICATION)}
    assert {schema.HAPPENED, schema.HIT_POINTS} <= paths
    at = next(frame for frame in frames if len(frame.events.broken))
    (sheet,) = happened_sheets([take(at)])
    texts = [text for column in sheet.columns for text in column.as_arrow_array().flatten().to_pylist()]
    assert "broken  joint 3 of 0-1 by 12.5 N, 0.25 N m" in texts
    assert "fell asleep  1, 2" in texts


def test_frames_that_skip_steps_lose_none() -> None:
    every, some = (Simulation(RAIN, tell_events=True) for _ in range(2))
    parts = []
    for _ in range(STEPS):
        every.step()
        parts.append(every.frame().events)
        some.step()
    frame = some.frame()
    assert frame.events_lost == 0
    for kind in Events._fields:
        assert np.array_equal(getattr(frame.events, kind), np.concatenate([getattr(part, kind) for part in parts]))
    assert not any(map(len, some.frame().events)), "told once"
    some.step()
    some.restore(some.world.snapshot(), some.extras())
    assert not any(map(len, some.frame().events)), "of the steps since"


def test_too_many_are_counted() -> None:
    simulation = Simulation(RAIN, tell_events=True)
    gathering = Gathering(most=50)
    total = 0
    for _ in range(STEPS):
        simulation.step()
        events = simulation.frame().events
        total += sum(map(len, events))
        gathering.add(events)
    kept, lost = gathering.take()
    assert sum(map(len, kept)) + lost == total
    assert 0 < sum(map(len, kept)) <= 50
    assert kept.moved["step"][-1] == simulation.world.step_count, "the latest stay"
    assert gathering.take()[1] == 0
