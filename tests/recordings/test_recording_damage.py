"""Missing, foreign, cut and corrupt files: one clear line, or the steps that are whole; never anything else."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
import rerun as rr
from recorded_frames import Frame, Start, steady_frames, write

import recordings
from recordings import schema


@pytest.fixture(scope="module")
def frames() -> list[Frame]:
    return steady_frames(24, bodies=5, contacts=3)


@pytest.fixture(scope="module")
def whole(frames: list[Frame], tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a recording in several blocks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("recordings.mailbox.BLOCK_BYTES", 8000)
        return write(tmp_path_factory.mktemp("whole") / "w.rrd", frames).read_bytes()


def refusal(path: Path) -> str:
    """The one line with which a file is refused."""
    with pytest.raises(recordings.RecordingError) as caught:
        recordings.read(path)
    line = str(caught.value)
    assert "\n" not in line
    assert line.startswith(str(path))
    return line.removeprefix(str(path))


def test_what_is_no_recording(tmp_path: Path) -> None:
    assert "no such file" in refusal(tmp_path / "missing.rrd")
    assert "a folder" in refusal(tmp_path)
    path = tmp_path / "foreign.rrd"
    for content in (b"", b"RR", b"PNG\x00" * 100, b"{}"):
        path.write_bytes(content)
        assert "not a rerun recording" in refusal(path)


def test_another_programs_rrd(tmp_path: Path) -> None:
    path = tmp_path / "other.rrd"
    stream = rr.RecordingStream("somebody_else")
    stream.save(path)
    stream.log("points", rr.Points3D([[0, 0, 0]]))
    stream.disconnect()
    assert "a recording of 'somebody_else', not of tumble" in refusal(path)


def test_an_rrd_of_ours_without_a_start(tmp_path: Path) -> None:
    path = tmp_path / "other.rrd"
    stream = rr.RecordingStream(schema.APPLICATION)
    stream.save(path)
    stream.log("points", rr.Points3D([[0, 0, 0]]))
    stream.disconnect()
    assert "no recording of tumble" in refusal(path)


def test_newer_schema(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "newer.rrd"
    with monkeypatch.context() as patch:
        patch.setattr(schema, "VERSION", schema.VERSION + 1)
        write(path, steady_frames(2))
    assert f"written by a newer tumble (recording schema {schema.VERSION + 1}" in refusal(path)


@pytest.mark.parametrize("fraction", range(60))
def test_cut_anywhere(whole: bytes, frames: list[Frame], tmp_path: Path, fraction: int) -> None:
    """Either the first steps come back bit for bit, or the file is refused because not even its start is there."""
    path = tmp_path / "cut.rrd"
    position = random.Random(fraction).randrange(len(whole)) if fraction else len(whole) - 1
    path.write_bytes(whole[:position])
    try:
        recording = recordings.read(path)
    except recordings.RecordingError as error:
        assert re.search("cut before its start|not a rerun recording", str(error))
        assert schema.START_SNAPSHOT.encode() not in whole[: position - 4000]
        return
    assert not recording.whole
    kept = len(recording.steps) + 1
    assert recordings.compare(recording, frames[:kept]) is None


def test_only_a_file_with_its_very_last_byte_is_whole(whole: bytes, frames: list[Frame], tmp_path: Path) -> None:
    path = tmp_path / "cut.rrd"
    path.write_bytes(whole)
    assert recordings.read(path).whole
    footer = _messages(whole)[-1][0]
    for length in (*range(len(whole) - 40, len(whole)), footer, footer + 1, footer + 20):
        path.write_bytes(whole[:length])
        recording = recordings.read(path)
        assert not recording.whole, len(whole) - length
        assert len(recording.steps) == len(frames) - 1


def test_a_footer_without_our_end_is_not_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As after a full disk: rerun finishes the file, but the writer did not close it."""
    monkeypatch.setattr("recordings.rrd_file.RrdFile.finish", lambda file: file.abandon())
    recording = recordings.read(write(tmp_path / "abandoned.rrd", steady_frames(5)))
    assert (recording.whole, len(recording.steps)) == (False, 4)


def test_a_cut_keeps_all_but_the_last_block(whole: bytes, frames: list[Frame], tmp_path: Path) -> None:
    path = tmp_path / "cut.rrd"
    kept = []
    for percent in (60, 70, 80, 90, 99):
        path.write_bytes(whole[: len(whole) * percent // 100])
        kept.append(len(recordings.read(path).steps))
    assert kept == sorted(kept)
    assert kept[0] > 0
    assert kept[-1] >= len(frames) - 8


def test_flipped_bits(whole: bytes, frames: list[Frame], tmp_path: Path) -> None:
    """A flipped bit is noticed, or it hit what is only there to look at and the state is still the same."""
    path = tmp_path / "flipped.rrd"
    chance = random.Random(5)
    refused = 0
    for _ in range(250):
        damaged = bytearray(whole)
        for _ in range(chance.choice((1, 1, 8))):
            damaged[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        path.write_bytes(damaged)
        try:
            recording = recordings.read(path)
        except recordings.RecordingError as error:
            assert "\n" not in str(error)
            refused += 1
        else:
            assert len(recording.steps) == len(frames) - 1
            assert recordings.compare(recording, frames) is None
    assert refused > 80


def test_a_number_changed_under_a_valid_container(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the checksum can tell: every byte of the container is as it should be."""
    from recordings import state_sheets

    original = state_sheets.body_rows

    def wrong_after_checksum(shots: list) -> np.ndarray:
        rows = original(shots)
        checks.append(rows)
        return rows

    checks: list[np.ndarray] = []
    real_columns = state_sheets.table_columns

    def columns(table: schema.Table, rows: np.ndarray, lengths: np.ndarray) -> list:
        if table is schema.BODIES:
            rows = rows.copy()
            rows["x"].view(np.int64)[4] ^= 1
        return real_columns(table, rows, lengths)

    monkeypatch.setattr(state_sheets, "body_rows", wrong_after_checksum)
    monkeypatch.setattr(state_sheets, "table_columns", columns)
    path = write(tmp_path / "wrong.rrd", steady_frames(3, bodies=3))
    assert checks
    assert refusal(path) == ": damaged at step 1"


@pytest.mark.parametrize(
    ("table", "field"),
    [(schema.ROSTER, "body_kind"), *((schema.PIECES, name) for name in schema.PIECES.dtype.names or ()),
     (schema.CORNERS, "x"), (schema.CORNERS, "y")],
)  # fmt: skip
def test_a_changed_shape_under_a_valid_container(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, table: schema.Table, field: str
) -> None:
    """What bodies look like is written once and holds for all steps: the checksum of each covers it."""
    from recordings import state_sheets

    real_columns = state_sheets.table_columns

    def columns(of: schema.Table, rows: np.ndarray, lengths: np.ndarray) -> list:
        if of.path == table.path:
            rows = rows.copy()
            values = np.ascontiguousarray(rows[field])
            values.view(f"u{values.itemsize}")[-1] ^= 1
            rows[field] = values
        return real_columns(of, rows, lengths)

    monkeypatch.setattr(state_sheets, "table_columns", columns)
    assert refusal(write(tmp_path / "wrong.rrd", steady_frames(3, bodies=5))) == ": damaged at step 0"


def test_pieces_without_a_body_are_refused_even_under_a_valid_checksum(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What reads a recording takes an owner for an index."""
    from recordings import state_sheets

    real = state_sheets.piece_rows

    def orphaned(shot: Any) -> np.ndarray:
        rows = real(shot)
        rows["owner"][0] = 5_000
        return rows

    monkeypatch.setattr(state_sheets, "piece_rows", orphaned)
    assert refusal(write(tmp_path / "orphan.rrd", steady_frames(3, bodies=5))) == ": damaged at step 0"


@pytest.mark.parametrize("table", schema.ON_CHANGE)
def test_shapes_that_are_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, table: schema.Table) -> None:
    from recordings import state_sheets

    real = state_sheets.StateSheets.sheets
    monkeypatch.setattr(
        state_sheets.StateSheets, "sheets", lambda *a: (sheet for sheet in real(*a) if sheet.path != table.path)
    )
    path = write(tmp_path / "missing.rrd", steady_frames(3, bodies=5))
    assert "damaged: what bodies look like is missing" in refusal(path)


@pytest.mark.parametrize("part", ["json", "snapshot"])
def test_a_changed_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, part: str) -> None:
    from recordings import start

    real = start.batch

    def changed(name: str, value: pa.Array) -> rr.DescribedComponentBatch:
        if name == schema.START_TEXT and part == "json":
            value = pa.array([json.dumps(json.loads(value[0].as_py()) | {"dt": 0.5})])
        if name == schema.START_SNAPSHOT and part == "snapshot":
            value = pa.array([value[0].as_py()[:-1] + b"?"], pa.binary())
        return real(name, value)

    monkeypatch.setattr(start, "batch", changed)
    assert refusal(write(tmp_path / "start.rrd", steady_frames(2))) == ": damaged at its start"


def test_a_block_that_is_missing(whole: bytes, tmp_path: Path) -> None:
    """A message taken out of the middle, or at the end, is not mistaken for a shorter recording."""
    path = tmp_path / "gap.rrd"
    messages = _messages(whole)
    states = [m for m in messages if b"rerun.controls.RowId" in whole[m[0] : m[1]] or m[1] - m[0] > 300]
    refused = 0
    for begin, end in states:
        path.write_bytes(whole[:begin] + whole[end:])
        try:
            recording = recordings.read(path)
        except recordings.RecordingError:
            refused += 1
        else:
            assert len(recording.steps) == 23
    assert refused >= 5 * 3


def test_a_message_with_a_wrong_header(whole: bytes, frames: list[Frame], tmp_path: Path) -> None:
    """A wrong length looks like a cut, and a wrong kind like an end; the file's real end tells that it is neither."""
    path = tmp_path / "header.rrd"
    refused = 0
    for begin, end in _messages(whole)[::5]:
        for at, value in ((0, 0), (0, 3), (0, 77), (8, end - begin - 15), (8, 2**40)):
            damaged = bytearray(whole)
            damaged[begin + at : begin + at + 8] = value.to_bytes(8, "little")
            path.write_bytes(damaged)
            try:
                recording = recordings.read(path)
            except recordings.RecordingError:
                refused += 1
            else:
                assert recordings.compare(recording, frames) is None
    assert refused > 20


def _messages(data: bytes) -> list[tuple[int, int]]:
    """Begin and end of every message."""
    found, at = [], 12
    while at + 16 <= len(data) - 32:
        end = at + 16 + int.from_bytes(data[at + 8 : at + 16], "little")
        found.append((at, end))
        at = end
    return found


def test_starting_over_leaves_no_old_steps(tmp_path: Path) -> None:
    path = write(tmp_path / "twice.rrd", steady_frames(9))
    recordings.Writer(path, Start()).close()
    assert recordings.read(path).steps.tolist() == []
