"""`compare` finds one last bit, and names where it is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recorded_frames import Frame, steady_frames, write

import recordings


@pytest.fixture(scope="module")
def frames() -> list[Frame]:
    return steady_frames(6, bodies=4, contacts=3)


@pytest.fixture(scope="module")
def recording(frames: list[Frame], tmp_path_factory: pytest.TempPathFactory) -> recordings.Recording:
    return recordings.read(write(tmp_path_factory.mktemp("verify") / "v.rrd", frames))


def flipped(array: np.ndarray, row: Any) -> np.ndarray:
    """A copy with the last bit of one number changed."""
    copy = array.copy()
    copy.view(f"u{array.dtype.itemsize}")[row] ^= 1
    return copy


def with_frame(frames: list[Frame], step: int, **changes: Any) -> list[Frame]:
    return [replace(frame, **changes) if frame.step == step else frame for frame in frames]


def test_same_bits_are_no_difference(recording: recordings.Recording, frames: list[Frame]) -> None:
    assert recordings.compare(recording, frames) is None
    assert recordings.compare(recording, frames[1:]) is None  # the start may be left out
    again = (recording.state(int(step)) for step in recording.steps)
    assert recordings.compare(recording, again) is None


@pytest.mark.parametrize(
    ("name", "column", "field"),
    [
        ("positions", 0, "x"),
        ("positions", 1, "y"),
        ("angles", None, "angle"),
        ("velocities", 0, "velocity x"),
        ("velocities", 1, "velocity y"),
        ("angular_velocities", None, "angular velocity"),
        ("serials", None, "serial"),
        ("body_kinds", None, "kind"),
    ],
)
def test_one_last_bit_of_a_body(
    recording: recordings.Recording, frames: list[Frame], name: str, column: int | None, field: str
) -> None:
    row = 2 if column is None else (2, column)
    changed = with_frame(frames, 3, **{name: flipped(getattr(frames[3], name), row)})
    difference = recordings.compare(recording, changed)
    assert difference is not None
    assert (difference.step, difference.body, difference.field) == (3, int(frames[3].serials[2]), field)
    assert "\n" not in str(difference)
    assert str(difference).startswith(f"step 3, body {difference.body}: {field} was ")


@pytest.mark.parametrize(
    ("name", "column", "field"),
    [
        ("shape_serials", None, "piece serial"),
        ("owners", None, "piece owner"),
        ("shape_kinds", None, "piece kind"),
        ("corner_counts", None, "piece corner count"),
        ("sizes", 0, "piece size 1"),
        ("sizes", 1, "piece size 2"),
        ("places", 0, "piece place x"),
        ("places", 1, "piece place y"),
        ("places", 2, "piece place angle"),
    ],
)
def test_one_last_bit_of_a_piece(
    recording: recordings.Recording, frames: list[Frame], name: str, column: int | None, field: str
) -> None:
    row = 2 if column is None else (2, column)
    changed = with_frame(frames, 3, **{name: flipped(getattr(frames[3], name), row)})
    difference = recordings.compare(recording, changed)
    assert difference is not None
    owner = int(frames[3].serials[frames[3].owners[2]])
    assert (difference.step, difference.body, difference.field) == (3, owner, field)


@pytest.mark.parametrize("which", [0, -1])
def test_one_last_bit_of_a_corner(which: int, tmp_path: Path) -> None:
    frames = steady_frames(4, bodies=12)
    recording = recordings.read(write(tmp_path / "c.rrd", frames))
    frame = frames[3]
    polygons = frame.owners[np.flatnonzero(frame.corner_counts)]
    assert polygons[0] != polygons[-1]
    changed = with_frame(frames, 3, corners=flipped(frame.corners, (which, 1)))
    difference = recordings.compare(recording, changed)
    assert difference is not None
    assert (difference.step, difference.body) == (3, int(frame.serials[polygons[which]]))
    assert difference.field == "corner y"


@pytest.mark.parametrize(("name", "noun"), [("contacts", "contact"), ("joints", "joint")])
def test_one_last_bit_of_any_field_of_a_record(
    recording: recordings.Recording, frames: list[Frame], name: str, noun: str
) -> None:
    records = getattr(frames[4], name)
    for field in records.dtype.names:
        changed = records.copy()
        changed[field] = flipped(np.ascontiguousarray(records[field]), 1)
        difference = recordings.compare(recording, with_frame(frames, 4, **{name: changed}))
        assert difference is not None
        assert (difference.step, difference.field) == (4, f"{noun} {field}")
        assert difference.body == records["body1"][1]


def test_counts(recording: recordings.Recording, frames: list[Frame]) -> None:
    fewer = with_frame(frames, 2, contacts=frames[2].contacts[:2])
    assert recordings.compare(recording, fewer) == recordings.Difference(2, None, "contact count", 3, 2)
    more = with_frame(frames, 2, joints=np.concatenate([frames[2].joints, frames[2].joints]))
    assert recordings.compare(recording, more) == recordings.Difference(2, None, "joint count", 2, 4)
    none = {
        name: getattr(frames[2], name)[:-1] for name in ("shape_serials", "owners", "shape_kinds", "sizes", "places")
    }
    pieces = len(frames[2].owners)
    assert recordings.compare(recording, with_frame(frames, 2, **none)) == recordings.Difference(
        2, None, "piece count", pieces, pieces - 1
    )
    other = steady_frames(6, bodies=5)
    assert recordings.compare(recording, other) == recordings.Difference(0, None, "body count", 4, 5)


def test_first_step_and_first_body_win(recording: recordings.Recording, frames: list[Frame]) -> None:
    changed = with_frame(frames, 4, angles=flipped(frames[4].angles, 0))
    changed = with_frame(
        changed, 2, angles=flipped(frames[2].angles, 1), positions=flipped(frames[2].positions, (3, 0))
    )
    difference = recordings.compare(recording, changed)
    assert difference is not None
    assert (difference.step, difference.body, difference.field) == (2, int(frames[2].serials[1]), "angle")


def test_missing_and_skipped_steps(recording: recordings.Recording, frames: list[Frame]) -> None:
    ended = recordings.compare(recording, frames[:4])
    assert ended is not None
    assert (ended.step, ended.field) == (4, "step")
    assert str(ended) == "step 4: step was 4 when recorded, nothing when computed"
    skipped = recordings.compare(recording, [*frames[:2], *frames[3:]])
    assert skipped == recordings.Difference(2, None, "step", 2, 3)


def test_zero_has_a_sign_and_nan_equals_itself(tmp_path: Path) -> None:
    frame = replace(steady_frames(2)[1], angles=np.array([0.0, np.nan, 1.0]))
    frames = [steady_frames(2)[0], frame]
    recording = recordings.read(write(tmp_path / "z.rrd", frames))
    assert recordings.compare(recording, frames) is None
    negative = replace(frame, angles=np.array([-0.0, np.nan, 1.0]))
    difference = recordings.compare(recording, [negative])
    assert difference is not None
    assert (difference.recorded, str(difference.computed)) == (0.0, "-0.0")
