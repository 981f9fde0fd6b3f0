"""Recording a session: whole or .part, never in the way of the loop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import recordings
from sandbox import commands as ask
from sandbox.frame import Frame
from sandbox.recorder import PartFile, Recorder, RecordingStart
from sandbox.session import Session
from sandbox.simulation import Simulation
from sandbox.verbs.run import open_recorder
from sandbox.viewer import Viewer
from tests.sandbox.watching import PushTooHard, Watcher, make_unwritable, running, step_by_step


class Sheet(Watcher):
    """A recorder that writes one word a frame, and fails when told to."""

    opened: list[Sheet] = []  # noqa: RUF012 - emptied by the fixture
    fails_at = -1
    fails_to_close = False

    def __init__(self, path: Path, start: RecordingStart) -> None:
        super().__init__()
        self.path, self.start = path, start
        path.write_text("")
        Sheet.opened.append(self)

    def show(self, frame: Frame) -> None:
        if len(self.frames) == self.fails_at:
            raise RuntimeError("the disk is full")
        super().show(frame)
        with self.path.open("a") as file:
            file.write(f"{frame.step}\n")

    def close(self) -> None:
        super().close()
        if self.fails_to_close:
            raise RuntimeError("the disk is full")


@pytest.fixture(autouse=True)
def _new_sheets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Sheet, "opened", [])


@pytest.fixture
def recorded(tmp_path: Path) -> Iterator[tuple[Session, Watcher]]:
    """A paused session that records into tmp_path."""
    with running(paused=True, open_recorder=Sheet, record_dir=tmp_path) as (session, watcher):
        yield session, watcher


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_is_renamed_only_when_whole(recorded: tuple[Session, Watcher], tmp_path: Path) -> None:
    session, watcher = recorded
    step_by_step(session, watcher, 2)
    session.submit(ask.StartRecording())
    frame = watcher.wait(lambda frame: frame.status.recording)
    name = frame.status.recording
    assert name.startswith("the-talk-single-box-")
    assert name.endswith(".rrd")
    step_by_step(session, watcher, 3)
    assert names(tmp_path) == [f"{name}.part"]
    assert session.last_recording is None
    session.submit(ask.StopRecording())
    frame = watcher.wait(lambda frame: not frame.status.recording)
    assert frame.status.notice == f"recorded {name}"
    assert session.last_recording == tmp_path / name
    assert names(tmp_path) == [name]
    assert (tmp_path / name).read_text().split() == ["2", "3", "4", "5"], "the start, then every step"
    step_by_step(session, watcher, 1)
    assert Sheet.opened[0].closed
    assert len(Sheet.opened[0].frames) == 4


def test_starts_with_all_that_the_first_step_depends_on(recorded: tuple[Session, Watcher]) -> None:
    session, watcher = recorded
    session.submit(ask.Set("iterations", 7))
    step_by_step(session, watcher, 2)
    session.submit(ask.Grab(3, 0.0, 4.0))
    session.submit(ask.StartRecording())
    frame = watcher.wait(lambda frame: frame.status.recording)
    start = Sheet.opened[0].start
    assert (start.scene, start.step, start.time, start.dt) == ("The Talk/Single Box", 2, frame.time, 1 / 60)
    assert start.settings == frame.settings.to_dict()
    assert start.settings["iterations"] == 7
    assert list(start.hands["hands"]) == ["3"]
    assert start.view == (0.0, 3.0, 10.0)
    assert start.version == "0.1.0"
    step_by_step(session, watcher, 1)
    assert Sheet.opened[0].frames[1].commands == (), "what was done before is in the snapshot"


def test_recordings_of_one_second_get_names_of_their_own(recorded: tuple[Session, Watcher], tmp_path: Path) -> None:
    session, watcher = recorded
    for _ in range(3):  # a recording under way is finished before the next
        session.submit(ask.StartRecording())
        step_by_step(session, watcher, 1)
    session.submit(ask.StopRecording())
    watcher.wait(lambda frame: not frame.status.recording)
    assert len(names(tmp_path)) == 3
    assert all(name.endswith(".rrd") for name in names(tmp_path))


@pytest.mark.parametrize(
    "end", [ask.Reset, lambda: ask.LoadScene("Pyramid"), ask.StopRecording], ids=["reset", "scene", "stop"]
)
def test_a_new_beginning_finishes_it(end: Callable[[], Any], recorded: tuple[Session, Watcher], tmp_path: Path) -> None:
    session, watcher = recorded
    session.submit(ask.StartRecording())
    step_by_step(session, watcher, 2)
    session.submit(end())
    frame = watcher.wait(lambda frame: not frame.status.recording)
    assert session.last_recording is not None
    assert names(tmp_path) == [session.last_recording.name]
    assert frame.status.notice == f"recorded {session.last_recording.name}"


def test_closing_finishes_it(tmp_path: Path) -> None:
    with running(paused=True, open_recorder=Sheet, record_dir=tmp_path / "new" / "folder") as (session, watcher):
        session.submit(ask.StartRecording())
        step_by_step(session, watcher, 2)
    assert session.last_recording is not None
    assert session.last_recording.is_file()
    assert names(session.last_recording.parent) == [session.last_recording.name]


def test_a_failing_step_finishes_it_with_the_last_good_state(recorded: tuple[Session, Watcher], tmp_path: Path) -> None:
    session, watcher = recorded
    session.submit(ask.StartRecording())
    step_by_step(session, watcher, 2)
    session.submit(PushTooHard())
    session.submit(ask.Play())
    frame = watcher.wait(lambda frame: frame.status.failure)
    assert frame.status.recording == ""
    assert session.last_recording is not None
    assert session.last_recording.read_text().split() == ["0", "1", "2"]


@pytest.mark.parametrize("fails_at", [1, 3])
def test_an_error_ends_it_with_a_notice_and_the_loop_goes_on(
    fails_at: int, recorded: tuple[Session, Watcher], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, watcher = recorded
    monkeypatch.setattr(Sheet, "fails_at", fails_at)
    session.submit(ask.StartRecording())
    frame = step_by_step(session, watcher, 5)
    assert frame.status.notice == "the recording ended: the disk is full"
    assert (frame.status.recording, frame.status.failure) == ("", "")
    assert Sheet.opened[0].closed
    assert names(tmp_path) == [Sheet.opened[0].path.name], "what was written is kept"
    assert names(tmp_path)[0].endswith(".rrd.part")
    assert session.last_recording is None


@pytest.mark.parametrize("how", ["stop", "reset", "failing step", "start again", "close"])
def test_an_error_at_its_end_is_a_notice_too(
    how: str, recorded: tuple[Session, Watcher], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, watcher = recorded
    session.submit(ask.StartRecording())
    good = step_by_step(session, watcher, 2)
    monkeypatch.setattr(Sheet, "fails_to_close", True)
    if how == "close":
        session.close()
        assert watcher.closed
    else:
        if how == "failing step":
            session.submit(PushTooHard())
        ends = {"stop": ask.StopRecording(), "reset": ask.Reset(), "start again": ask.StartRecording(),
                "failing step": ask.StepOnce()}  # fmt: skip
        session.submit(ends[how])
        watcher.wait(lambda frame: "the disk is full" in frame.status.notice)
        monkeypatch.setattr(Sheet, "fails_to_close", False)
        frame = step_by_step(session, watcher, 1)
        assert frame.step == (1 if how == "reset" else good.step + 1)
        assert frame.status.failure == ""
    assert session.last_recording is None or how == "start again"
    assert any(name.endswith(".part") for name in names(tmp_path))


def failing_to_open(path: Path, start: RecordingStart) -> Viewer:
    raise recordings.RecordingError("no room left")


def failing_at_once(path: Path, start: RecordingStart) -> Viewer:
    sheet = Sheet(path, start)
    sheet.fails_at = 0
    return sheet


@pytest.mark.parametrize(
    ("opener", "words"),
    [(failing_to_open, "no room left"), (failing_at_once, "the disk is full"), (None, "a session that can record")],
)
def test_one_that_cannot_begin_is_a_notice(opener: Any, words: str, tmp_path: Path) -> None:
    with running(paused=True, open_recorder=opener, record_dir=tmp_path) as (session, watcher):
        assert session.can_record == (opener is not None)
        session.submit(ask.StartRecording())
        frame = watcher.wait(lambda frame: frame.status.notice)
        assert words in frame.status.notice
        frame = step_by_step(session, watcher, 2)
        assert (frame.status.recording, frame.status.failure) == ("", "")
    assert all(sheet.closed for sheet in Sheet.opened)


def test_a_folder_that_cannot_be_written_is_a_notice(tmp_path: Path) -> None:
    with running(paused=True, open_recorder=open_recorder, record_dir=make_unwritable(tmp_path)) as (session, watcher):
        session.submit(ask.StartRecording())
        frame = watcher.wait(lambda frame: frame.status.notice)
        assert "must be in a folder that can be written" in frame.status.notice
        frame = step_by_step(session, watcher, 2)
        assert (frame.status.recording, frame.status.failure) == ("", "")


def test_other_files_are_left_alone(tmp_path: Path) -> None:
    recorder = Recorder(Sheet, tmp_path)
    simulation = Simulation("The Talk/Single Box")
    for taken in ("{}.rrd", "{}.rrd.part"):
        recorder.start(simulation)
        stem = recorder.name.removesuffix(".rrd")
        recorder.stop()
        for path in tmp_path.iterdir():
            path.unlink()
        (tmp_path / taken.format(stem)).write_text("precious")
        assert recorder._free_path(stem).name == f"{stem}-2.rrd"
        assert (tmp_path / taken.format(stem)).read_text() == "precious"


def test_part_file_keeps_what_it_has_when_abandoned(tmp_path: Path) -> None:
    simulation = Simulation("The Talk/Single Box")
    file = PartFile(tmp_path / "x.rrd", Sheet, simulation)
    file.abandon()
    assert names(tmp_path) == ["x.rrd.part"]
    file = PartFile(tmp_path / "x.rrd", Sheet, simulation)
    assert file.finish() == tmp_path / "x.rrd"
    assert names(tmp_path) == ["x.rrd"]
