"""What was written comes back bit for bit."""

from __future__ import annotations

import re
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recorded_frames import CONTENT, DT, Start, random_frame, start_of, steady_frames, tumbling, write

import recordings
from recordings import schema

ARRAYS = (
    "serials",
    "body_kinds",
    "positions",
    "angles",
    "velocities",
    "angular_velocities",
    "shape_serials",
    "owners",
    "shape_kinds",
    "sizes",
    "places",
    "corner_counts",
    "corners",
    "contacts",
    "joints",
)


def assert_same_bits(state: recordings.State, frame: object) -> None:
    for name in ARRAYS:
        recorded, shown = getattr(state, name), getattr(frame, name)
        assert recorded.dtype == shown.dtype, name
        assert recorded.shape == shown.shape, name
        assert recorded.tobytes() == shown.tobytes(), name


@settings(max_examples=25, deadline=None)
@given(
    counts=st.lists(st.tuples(st.integers(0, 6), st.integers(0, 5), st.integers(0, 3)), min_size=1, max_size=6),
    first_step=st.integers(0, 10**9),
    seed=st.integers(0, 2**32 - 1),
)
def test_any_bits_and_any_counts(counts: list[tuple[int, int, int]], first_step: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = [random_frame(rng, first_step + i, *count) for i, count in enumerate(counts)]
    with tempfile.TemporaryDirectory() as folder:
        recording = recordings.read(write(Path(folder) / "any.rrd", frames))
    assert recording.start_step == first_step
    assert recording.steps.tolist() == [frame.step for frame in frames[1:]]
    assert recording.times.tolist() == [frame.time for frame in frames[1:]]
    for frame in frames:
        state = recording.state(frame.step)
        assert (state.step, state.time, state.dt) == (frame.step, frame.time, frame.dt)
        assert_same_bits(state, frame)


def test_start_comes_back(tmp_path: Path) -> None:
    frame = steady_frames(1, first_step=12)[0]
    start = Start(
        scene="Joints/Brücke",
        step=12,
        time=0.1 + 0.2,
        dt=1 / 3,
        settings={"gravity": [0.0, -9.81], "warm_starting": False, "solver": "sequential_impulses"},
        snapshot=bytes(range(256)) * 40,
        hands={"grabs": {"0": [1.5, -0.1]}},
        view=(0.5, 1 / 7, 20.0),
        version="1.2.3",
    )
    path = tmp_path / "start.rrd"
    writer = recordings.Writer(path, start)
    writer.show(frame)
    writer.close()
    recording = recordings.read(path)
    for name in ("scene", "dt", "settings", "snapshot", "hands", "view", "version"):
        assert getattr(recording, name) == getattr(start, name)
    assert (recording.start_step, recording.start_time) == (12, 0.1 + 0.2)
    assert recording.steps.shape == recording.times.shape == recording.diagnostics.shape == (0,)
    assert_same_bits(recording.state(12), frame)


def test_a_recording_closed_at_once_has_no_steps(tmp_path: Path) -> None:
    path = tmp_path / "none.rrd"
    recordings.Writer(path, Start()).close()
    recording = recordings.read(path)
    assert not recording.whole, "the frame it started from is missing"
    assert recording.steps.tolist() == []
    with pytest.raises(ValueError, match="step = 0: the recording holds no step"):
        recording.state(0)


def test_commands_and_diagnostics(tmp_path: Path) -> None:
    frames = list(tumbling(60))
    commands = ({"command": "set_gravity", "x": 0.1, "y": -10.0}, {"command": "release", "hand": 2})
    frames[7] = replace(frames[7], commands=commands)
    recording = recordings.read(write(tmp_path / "c.rrd", frames))
    assert recording.commands == {7: list(commands), 40: list(frames[40].commands)}
    for row, frame in zip(recording.diagnostics, frames[1:], strict=True):
        d = frame.diagnostics
        assert (row["kinetic_energy"], row["potential_energy"]) == (d.kinetic_energy, d.potential_energy)
        assert (row["momentum_x"], row["momentum_y"], row["angular_momentum"]) == (*d.momentum, d.angular_momentum)
        assert (row["max_penetration"], row["contact_count"]) == (d.max_penetration, d.contact_count)


def test_steps_outside_are_refused(tmp_path: Path) -> None:
    recording = recordings.read(write(tmp_path / "s.rrd", steady_frames(4, first_step=10)))
    wrong: tuple[Any, ...] = (9, 14, -1, 10**30, 11.5, 11.0, True, np.bool_(True), "x", None, np.array([10, 11]))
    for step in wrong:
        with pytest.raises(ValueError, match=re.escape(f"step = {step!r}: must be a whole number from 10 to 13")):
            recording.state(step)
    assert recording.state(np.int64(11)).step == 11  # type: ignore[arg-type]
    assert not recording.state(13).positions.flags.writeable


def test_blocks_of_every_size_read_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    frames = list(tumbling(90))
    for block in (1, 20_000, 1 << 30):
        monkeypatch.setattr("recordings.mailbox.BLOCK_BYTES", block)
        assert recordings.compare(recordings.read(write(tmp_path / "b.rrd", frames)), frames) is None


def test_what_the_caller_changes_later_does_not_count(tmp_path: Path) -> None:
    frame = steady_frames(1)[0]
    live = frame.positions.copy()
    view = live[:]
    view.flags.writeable = False  # read-only, but what it looks into is not
    path = tmp_path / "live.rrd"
    writer = recordings.Writer(path, start_of(frame))
    writer.show(replace(frame, positions=view))
    live[:] = 0.0
    writer.close()
    assert recordings.read(path).state(0).positions.tobytes() == frame.positions.tobytes()


def test_steps_must_follow_each_other(tmp_path: Path) -> None:
    frames = steady_frames(4)
    writer = recordings.Writer(tmp_path / "g.rrd", Start())
    writer.show(frames[0])
    for wrong in (0, 2, 3):
        with pytest.raises(recordings.RecordingError, match=f"step {wrong} came where step 1 was expected"):
            writer.show(frames[wrong])
    writer.show(frames[1])
    writer.close()
    with pytest.raises(recordings.RecordingError, match="closed"):
        writer.show(frames[2])


def test_shapes_are_written_only_when_bodies_come_or_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("recordings.mailbox.BLOCK_BYTES", 30_000)  # many blocks
    rows = _rows_by_path(write(tmp_path / "t.rrd", list(tumbling(90))))
    for table in schema.ON_CHANGE:
        assert rows[table.path] == 2  # at the start, and at step 40
    shapes = {"boxes": "Boxes3D:half_sizes", "circles": "Cylinders3D:radii", "outlines/0": "Mesh3D:vertex_positions"}
    for entity, component in shapes.items():
        assert rows[f"/world/bodies/{entity}", component] == 2
        assert rows[f"/world/bodies/{entity}", "InstancePoses3D:translations"] == 90
    still = {
        "boxes": "InstancePoses3D:translations",
        "segments": "LineStrips3D:strips",
        "chains": "LineStrips3D:strips",
    }
    for entity, component in still.items():
        assert rows[f"/world/static/{entity}", component] == 2  # it never moves


@pytest.mark.parametrize("name", CONTENT)
def test_any_change_of_what_there_is_is_noticed(tmp_path: Path, name: str) -> None:
    """A restored snapshot may have others of the same number."""
    frames = steady_frames(4, bodies=6)
    values = getattr(frames[0], name).copy()
    if name == "owners":
        values[-1] = (values[-1] + 1) % 6
    elif name == "corner_counts":
        first, last = np.flatnonzero(values)[[0, -1]]
        values[first], values[last] = values[first] + 1, values[last] - 1
    elif values.dtype == np.uint8:
        values[-1] ^= 1
    else:
        values[-1] = values[-1] + 1
    changed = [replace(frame, **{name: values}) if frame.step > 1 else frame for frame in frames]
    recording = recordings.read(write(tmp_path / "c.rrd", changed))
    for frame in changed:
        assert_same_bits(recording.state(frame.step), frame)


def _rows_by_path(path: Path) -> dict[object, int]:
    """Rows of each entity, and of each of its components."""
    from recordings.rrd import read_chunks

    rows: dict[object, int] = {}
    for chunk in read_chunks(path, schema.APPLICATION):
        rows[chunk.path] = rows.get(chunk.path, 0) + chunk.batch.num_rows
        for name in chunk.batch.schema.names:
            rows[chunk.path, name] = rows.get((chunk.path, name), 0) + chunk.batch.num_rows
    return rows


def test_plots_and_arrows_show_the_numbers(tmp_path: Path) -> None:
    from recordings.rrd import read_chunks

    frames = list(tumbling(100))
    shown: dict[str, list[list]] = {}
    names = {"/diagnostics/": "Scalars:scalars", schema.IMPULSE_ARROWS: "Arrows3D:vectors"}
    for chunk in read_chunks(write(tmp_path / "p.rrd", frames), schema.APPLICATION):
        for start, name in names.items():
            if chunk.path.startswith(start) and name in chunk.batch.schema.names:
                shown.setdefault(chunk.path, []).extend(chunk.batch.column(name).to_pylist())
    assert shown[schema.COUNTS] == [[len(f.serials), f.diagnostics.contact_count, len(f.joints)] for f in frames]
    assert shown[schema.ENERGY] == [[*f.diagnostics[:2], sum(f.diagnostics[:2])] for f in frames]
    assert shown[schema.PENETRATION] == [[f.diagnostics.max_penetration] for f in frames]
    assert shown[schema.STAGE_TIMES] == [list(f.stage_ms.values()) for f in frames]
    vectors = np.array(shown[schema.IMPULSE_ARROWS][-1])
    lengths = np.hypot(vectors[:, 0], vectors[:, 1])
    assert (vectors[:, 1] > 0).all(), "the ground pushes upwards"
    assert 0.0 < lengths.min() < lengths.max() <= 0.1 * Start().view[2] * 1.001


def test_our_reader_and_reruns_see_the_same(tmp_path: Path) -> None:
    """The container is read by our own code: a release of rerun that changes it must not go unnoticed."""
    from rerun.chunk import RrdReader

    from recordings.rrd import read_chunks

    path = write(tmp_path / "r.rrd", list(tumbling(50)))
    theirs = [chunk for chunk in RrdReader(path).stream() if chunk.entity_path.startswith("/state")]
    ours = [chunk for chunk in read_chunks(path, schema.APPLICATION) if chunk.path.startswith("/state")]
    assert RrdReader(path).store() is not None  # raises without a footer
    assert len(ours) == len(theirs) > 5
    for mine, other in zip(ours, theirs, strict=True):
        batch = other.to_record_batch()
        assert (mine.path, mine.batch.num_rows) == (other.entity_path, batch.num_rows)
        for name in mine.batch.schema.names:
            if name.startswith("tumble.") or name in (schema.STEP_TIMELINE, schema.TIME_TIMELINE):
                assert mine.batch.column(name).equals(batch.column(name)), name


def test_writing_makes_no_warning(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    """rerun turns bad columns into warnings, and numpy numbers that only double holds."""
    write(tmp_path / "w.rrd", list(tumbling(90)))
    write(tmp_path / "x.rrd", steady_frames(9))
    assert [str(warning.message) for warning in recwarn] == []


def test_time_is_exact_and_the_timeline_rounded(tmp_path: Path) -> None:
    frames = [replace(frame, time=frame.step * DT + 1e-12) for frame in steady_frames(5)]
    recording = recordings.read(write(tmp_path / "time.rrd", frames))
    assert recording.times.tolist() == [frame.time for frame in frames[1:]]
