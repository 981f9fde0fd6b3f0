"""Recordings of earlier versions are read as if they had been written today."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import recordings
from recordings import schema

ROOT = Path(__file__).parents[2]
VERSION_1 = ROOT / "tests" / "data" / "recordings" / "version1.rrd.gz"
"""The Talk/Single Box, five steps: settings changed before the second, two circles spawned before the third."""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "version1.rrd"
    path.write_bytes(gzip.decompress(VERSION_1.read_bytes()))
    return path


def test_version_1_comes_back(path: Path) -> None:
    recording = recordings.read(path)
    assert recording.whole
    assert recording.schema == 1
    assert (recording.scene, recording.version) == ("The Talk/Single Box", "0.1.0")
    assert recording.steps.tolist() == [1, 2, 3, 4, 5]
    assert [command["command"] for command in recording.commands[2]] == [
        "set_gravity", "set_iterations", "set_switch", "set_solver",
    ]  # fmt: skip
    first, last = recording.state(0), recording.state(5)
    assert first.positions.tolist() == [[0.0, -10.0], [0.0, 4.0]]
    assert last.serials.tolist() == [0, 1, 2, 3]
    assert last.positions.tolist() == [
        [0.0, -10.0],
        [0.0027777781651820987, 3.959722216706723],
        [1.4516666669107507, 2.984166664769873],
        [2.5516666669107506, 2.984166664769873],
    ]


def test_each_body_of_version_1_has_one_piece_at_its_origin(path: Path) -> None:
    for step, count in ((0, 2), (2, 2), (3, 4), (5, 4)):
        state = recordings.read(path).state(step)
        assert state.shape_kinds.tolist() == [0, 0, 1, 1][:count]
        assert state.sizes.tolist() == [[100.0, 20.0], [1.0, 1.0], [0.5, 0.0], [0.5, 0.0]][:count]
        assert state.owners.tolist() == list(range(count))
        assert state.shape_serials.tolist() == state.serials.tolist()
        assert not state.places.any()
        assert not state.corner_counts.any()
        assert state.corners.shape == (0, 2)
        assert all(not array.flags.writeable for array in (state.owners, state.sizes, state.places, state.corners))


def test_version_1_is_still_checked(path: Path) -> None:
    """Its checksums were made of other tables than today's."""
    whole = path.read_bytes()
    found = whole.index(np.float64(3.959722216706723).tobytes()) if _stored_plainly(whole) else None
    refused = 0
    rng = np.random.default_rng(2)
    for position in rng.integers(60_000, len(whole) - 40, 60).tolist() if found is None else [found]:
        damaged = bytearray(whole)
        damaged[position] ^= 4
        path.write_bytes(damaged)
        try:
            recording = recordings.read(path)
        except recordings.RecordingError as error:
            assert "damaged" in str(error)
            refused += 1
        else:
            assert recording.state(5).positions[1, 1] == 3.959722216706723
    assert refused > 0


def _stored_plainly(whole: bytes) -> bool:
    return np.float64(3.959722216706723).tobytes() in whole


def test_version_1_cut_short_gives_its_first_steps(path: Path) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) - 100])
    recording = recordings.read(path)
    assert not recording.whole
    assert recording.steps.tolist() == [1, 2, 3, 4, 5]


def test_version_2_comes_back_without_events(tmp_path: Path) -> None:
    # The Talk/Single Box, from step 2: gravity changed before step 4
    path = tmp_path / "version2.rrd"
    path.write_bytes(gzip.decompress(VERSION_1.with_name("version2.rrd.gz").read_bytes()))
    recording = recordings.read(path)
    assert recording.whole
    assert (recording.schema, recording.start_step, recording.steps.tolist()) == (2, 2, [3, 4, 5, 6, 7, 8])
    assert recording.commands == {4: [{"command": "set", "setting": "gravity", "value": [0.5, -9.0]}]}
    assert recording.state(8).positions[1].tolist() == pytest.approx([1.82291686e-03, 3.91197915], rel=1e-8)
    assert not any(map(len, recording.state(8).events))


def test_today_is_version_3() -> None:
    """A change of the tables needs a version of its own, and a file of this one among the tests' data."""
    assert schema.VERSION == 3
    assert [table.path for table in schema.ON_CHANGE] == ["/state/roster", "/state/pieces", "/state/corners"]
    assert schema.ROSTER.dtype.names == ("serial", "body_kind")
    assert {kind: table.dtype.names for kind, table in schema.HAPPENINGS.items()} == {
        "begin": ("shape1", "shape2", "body1", "body2"),
        "end": ("shape1", "shape2", "body1", "body2"),
        "hit": ("shape1", "shape2", "body1", "body2", "x", "y", "nx", "ny", "speed"),
        "moved": ("body",),
        "fell_asleep": ("body",),
        "woke": ("body",),
        "broken": ("joint", "body1", "body2", "force", "torque"),
    }
    assert schema.PIECES.dtype.names == (
        "serial", "owner", "shape_kind", "size1", "size2", "x", "y", "angle", "corner_count",
    )  # fmt: skip
