"""Kills, full disks and vanished folders while a recording is being written."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from recorded_frames import Frame, Start, steady_frames, tumbling

import recordings

ROOT = Path(__file__).parents[2]
KILLED = """
import sys, time
sys.path[:0] = sys.argv[2:]
import recordings
from recorded_frames import steady_frames, start_of
frames = steady_frames(2000, bodies=20, contacts=30)
writer = recordings.Writer(sys.argv[1], start_of(frames[0]))
begin = time.perf_counter()
for frame in frames:
    writer.show(frame)
    print(frame.step, flush=True)
    time.sleep(max(0.0, begin + frame.step / 240 - time.perf_counter()))
"""


def run_script(script: str, path: Path) -> subprocess.Popen[str]:
    arguments = [sys.executable, "-c", script, str(path), str(ROOT), str(Path(__file__).parent)]
    return subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)


def test_kill_loses_no_more_than_half_a_second(tmp_path: Path) -> None:
    path = tmp_path / "killed.rrd"
    with run_script(KILLED, path) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if int(line) >= 360:
                break
        process.send_signal(signal.SIGKILL)
        shown = [360, *map(int, process.stdout.read().split())]
    recording = recordings.read(path)
    assert not recording.whole
    assert recording.steps[-1] >= shown[-1] - 120  # half a second at 240 steps per second
    frames = steady_frames(2000, bodies=20, contacts=30)
    assert recordings.compare(recording, frames[: len(recording.steps) + 1]) is None


LEFT_OPEN = """
import sys
sys.path[:0] = sys.argv[2:]
import recordings
from recorded_frames import steady_frames, start_of
frames = steady_frames(30)
writer = recordings.Writer(sys.argv[1], start_of(frames[0]))
for frame in frames:
    writer.show(frame)
raise SystemExit(3)
"""


def test_an_exit_without_close_still_finishes_the_file(tmp_path: Path) -> None:
    path = tmp_path / "left.rrd"
    with run_script(LEFT_OPEN, path) as process:
        assert process.wait(30) == 3
    recording = recordings.read(path)
    assert (recording.whole, len(recording.steps)) == (True, 29)


def test_frames_are_on_disk_soon_even_if_no_more_come(tmp_path: Path) -> None:
    path = tmp_path / "quiet.rrd"
    frames = steady_frames(3)
    writer = recordings.Writer(path, Start())
    for frame in frames:
        writer.show(frame)
    time.sleep(0.5)
    assert recordings.read(path).steps.tolist() == [1, 2]
    writer.close()


def show_until_error(writer: recordings.Writer, frames: Iterator[Frame]) -> recordings.RecordingError:
    """Shows frames until the writer refuses one."""
    for frame in frames:
        try:
            writer.show(frame)
        except recordings.RecordingError as error:
            assert "\n" not in str(error)
            return error
        time.sleep(0.002)
    pytest.fail("the recording went on as if nothing had happened")


@pytest.fixture
def file_size_limit() -> Iterator[int]:
    """No file of this process may grow beyond this many bytes: to the writer, the disk is full."""
    limit = 600_000
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    previous = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    yield limit
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, previous)


def test_full_disk_is_told_at_the_loop(tmp_path: Path, file_size_limit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("recordings.mailbox.BLOCK_BYTES", 80_000)  # some blocks fit before the limit
    path = tmp_path / "full.rrd"
    writer = recordings.Writer(path, Start())
    frames = steady_frames(1500, bodies=30, contacts=60)
    error = show_until_error(writer, iter(frames))
    assert f"cannot write {path}" in str(error)
    with pytest.raises(recordings.RecordingError):
        writer.show(frames[-1])
    writer.close()  # not told twice
    assert path.stat().st_size <= file_size_limit
    recording = recordings.read(path)
    assert not recording.whole
    assert len(recording.steps) > 0
    assert recordings.compare(recording, frames[: len(recording.steps) + 1]) is None


def test_full_disk_is_told_at_close(tmp_path: Path, file_size_limit: int) -> None:
    writer = recordings.Writer(tmp_path / "full.rrd", Start())
    for frame in steady_frames(300, bodies=60, contacts=100):
        writer.show(frame)
    with pytest.raises(recordings.RecordingError, match="cannot write"):
        writer.close()
    writer.close()


@pytest.mark.parametrize("gone", ["file", "folder", "replaced"])
def test_a_vanished_file_is_told_at_the_loop(tmp_path: Path, gone: str) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    path = folder / "v.rrd"
    writer = recordings.Writer(path, Start())
    frames = iter(steady_frames(1000))
    writer.show(next(frames))
    if gone == "folder":
        folder.rename(tmp_path / "elsewhere")
    else:
        path.unlink()
    if gone == "replaced":
        path.write_bytes(b"another file")
    assert "removed or replaced" in str(show_until_error(writer, frames))
    writer.close()


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(recordings.RecordingError, match="its folder does not exist"):
        recordings.Writer(tmp_path / "none" / "a.rrd", Start())
    with pytest.raises(recordings.RecordingError, match="cannot write"):
        recordings.Writer(tmp_path, Start())
    assert not (tmp_path / "none").exists()


def test_a_disk_that_hangs_stops_the_loop_with_a_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("recordings.mailbox.QUEUE_BYTES", 20_000)
    monkeypatch.setattr("recordings.mailbox.STALL_SECONDS", 0.3)
    hang = threading.Event()
    monkeypatch.setattr("recordings.rrd_file.RrdFile.write", lambda *_: hang.wait(10))
    writer = recordings.Writer(tmp_path / "h.rrd", Start())
    begin = time.monotonic()
    error = show_until_error(writer, iter(steady_frames(500, bodies=10)))
    assert "the disk took nothing" in str(error)
    assert 0.2 < time.monotonic() - begin < 5
    assert writer.stalls > 0
    hang.set()
    writer.close()


def test_a_slow_disk_slows_the_loop_and_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("recordings.mailbox.QUEUE_BYTES", 20_000)
    monkeypatch.setattr("recordings.mailbox.BLOCK_BYTES", 10_000)
    path = tmp_path / "slow.rrd"
    writer = recordings.Writer(path, Start())
    frames = list(tumbling(120))
    for frame in frames:
        writer.show(frame)
    writer.close()
    assert writer.stalls > 0
    assert recordings.compare(recordings.read(path), frames) is None


@pytest.mark.parametrize("fails", [False, True])
def test_close_leaves_no_thread_and_no_open_file(tmp_path: Path, fails: bool) -> None:
    tasks, descriptors = Path("/proc/self/task"), Path("/proc/self/fd")
    if not tasks.is_dir():
        pytest.skip("threads and open files are counted in /proc, which this system does not have")

    def record(name: str) -> None:
        writer = recordings.Writer(tmp_path / name, Start())
        if fails:
            writer.path.unlink()
            with pytest.raises(recordings.RecordingError):
                writer.close()
        else:
            writer.close()

    record("first.rrd")
    before = len(os.listdir(tasks)), len(os.listdir(descriptors))
    for i in range(8):
        record(f"{i}.rrd")
    allowed = before[0] + 8 * 2  # rerun itself never ends the two idle threads of a blueprint that was sent
    deadline = time.monotonic() + 5  # the others end a moment after their stream
    while len(os.listdir(tasks)) > allowed and time.monotonic() < deadline:
        time.sleep(0.05)
    assert len(os.listdir(tasks)) <= allowed
    assert len(os.listdir(descriptors)) <= before[1]
