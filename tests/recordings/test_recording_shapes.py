"""What rerun is given to draw: an entity for many pieces that look alike, outlines as they are, lines that follow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recorded_frames import BOX, CAPSULE, CHAIN, CIRCLE, POLYGON, SEGMENT, Frame, steady_frames, tumbling, write

from engine import Capsule, Polygon
from recordings import schema
from recordings.drawn import Alike, Lines, Solids, Various
from recordings.looks import BAND_WIDTH, MOST_OUTLINES, looks
from recordings.outlines import outlines
from recordings.rrd import read_chunks
from recordings.shot import take

VIEW = 20.0  # height of the view [m]


def frame_of(kinds: list[int], sizes: list[tuple[float, float]], corners: list[np.ndarray] | None = None) -> Frame:
    """A body of each of these shapes, all dynamic but the first."""
    count = len(kinds)
    counts = np.zeros(count, np.uint8)
    counts[np.array(kinds) == POLYGON] = [len(own) for own in corners or []]
    return replace(
        steady_frames(1)[0],
        serials=np.arange(count),
        body_kinds=np.minimum(np.arange(count), 1).astype(np.uint8),
        positions=np.column_stack([3.0 * np.arange(count), np.zeros(count)]),
        angles=np.zeros(count),
        velocities=np.zeros((count, 2)),
        angular_velocities=np.zeros(count),
        shape_serials=np.arange(count),
        owners=np.arange(count),
        shape_kinds=np.array(kinds, np.uint8),
        sizes=np.array(sizes, float),
        places=np.zeros((count, 3)),
        corner_counts=counts,
        corners=np.concatenate([np.zeros((0, 2)), *(corners or [])]),
    )


def regular(corners: int, size: float = 1.0) -> np.ndarray:
    turns = 2.0 * np.pi * np.arange(corners) / corners
    return size * np.column_stack([np.cos(turns), np.sin(turns)])


def area(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Of a flat mesh, every triangle the same way round."""
    a, b, c = (vertices[triangles[:, k], :2].astype(float) for k in range(3))
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    assert (twice > -1e-7).all()
    return float(twice.sum() / 2)


@pytest.mark.parametrize("corners", [3, 4, 8])
@pytest.mark.parametrize("radius", [0.0, 0.02, 0.3])
def test_the_mesh_of_a_polygon_has_its_area_and_a_face_within(corners: int, radius: float) -> None:
    frame = frame_of([BOX, POLYGON], [(1, 1), (radius, 0)], [regular(corners)])
    (outline,) = outlines(take(frame), VIEW).values()
    is_face = outline.is_face[outline.triangles[:, 0]]
    rim, face = (area(outline.vertices, outline.triangles[own]) for own in (~is_face, is_face))
    assert rim == pytest.approx(Polygon(regular(corners).tolist(), radius).area, rel=0.01)
    assert 0.8 * rim < face < 0.99 * rim
    assert outline.vertices[~outline.is_face, 2].max() < outline.vertices[outline.is_face, 2].min(), "the rim is below"


def test_the_mesh_of_a_capsule() -> None:
    (outline,) = outlines(take(frame_of([BOX, CAPSULE], [(1, 1), (2.0, 0.5)])), VIEW).values()
    rim = outline.triangles[~outline.is_face[outline.triangles[:, 0]]]
    assert area(outline.vertices, rim) == pytest.approx(Capsule(2.0, 0.5).area, rel=0.01)
    assert np.abs(outline.vertices[:, :2]).max(axis=0).tolist() == pytest.approx([1.5, 0.5])


def test_impossible_numbers_do_not_end_a_recording() -> None:
    frame = frame_of([BOX, POLYGON, CAPSULE, POLYGON], [(1, 1), (np.nan, 0), (np.inf, -1.0), (1e300, 0)],
                     [np.full((3, 2), np.inf), np.zeros((4, 2))])  # fmt: skip
    with np.errstate(all="ignore"):
        assert len(outlines(take(frame), VIEW)) == 3


def test_equal_outlines_of_one_colour_are_one_entity() -> None:
    frame = frame_of([BOX] + [POLYGON] * 600, [(1, 1)] + [(0.1, 0)] * 600, [regular(6)] * 600)
    found = looks(take(frame), VIEW)
    alike = {path: look for path, look in found.items() if isinstance(look, Alike)}
    assert len(found) == 1 + len(alike) == 1 + 6  # one for each colour
    assert sum(len(look.members) for look in alike.values()) == 600
    assert all(path.startswith("/world/bodies/outlines/") for path in alike)


def test_outlines_of_many_kinds_share_one_mesh() -> None:
    count = 100
    frame = frame_of([BOX] + [POLYGON] * count, [(1, 1)] + [(0.05, 0)] * count,
                     [regular(3 + k % 6, 0.5 + 0.01 * k) for k in range(count)])  # fmt: skip
    frame = replace(frame, angles=np.full(count + 1, np.pi / 2))
    found = looks(take(frame), VIEW)
    various = found["/world/bodies/outlines/various"]
    assert isinstance(various, Various)
    assert len(found) == 1 + MOST_OUTLINES + 1
    assert len(various.members) == count - MOST_OUTLINES
    poses = np.zeros((2, len(various.members), 4), np.float32)
    poses[:, :, 0] = 3.0 * various.members
    poses[1, :, 3] = np.pi / 2
    (column,) = various.pose_columns(poses)
    points = np.array(column.as_arrow_array().flatten().flatten()).reshape(2, -1, 3)
    own = np.abs(points[0][:, 0] - 3.0 * various.members[-1]) < 1.4
    local = points[0][own] - (3.0 * various.members[-1], 0.0, 0.0)
    turned = points[1][own] - (3.0 * various.members[-1], 0.0, 0.0)
    np.testing.assert_allclose(turned[:, :2], np.column_stack([-local[:, 1], local[:, 0]]), atol=1e-4)
    assert np.hypot(*local[:, :2].T).max() == pytest.approx(0.5 + 0.01 * (count - 1) + 0.05, abs=0.02)


def test_a_chains_band_lies_on_its_right() -> None:
    """A floor from left to right is solid below."""
    frame = frame_of([CHAIN, SEGMENT], [(4.0, 0.0), (2.0, 0.0)])
    found = looks(take(frame), VIEW)
    assert set(found) == {"/world/static/chains", "/world/static/chains/solid_side", "/world/bodies/segments"}
    poses = np.zeros((1, 1, 4), np.float32)
    heights = {}
    for path, look in found.items():
        assert isinstance(look, Lines)
        (column,) = look.pose_columns(poses)
        ends = np.array(column.as_arrow_array().flatten().flatten().flatten()).reshape(2, 3)
        assert ends[:, 0].tolist() == ([-1.0, 1.0] if "segments" in path else [-2.0, 2.0])
        heights[path] = set(ends[:, 1].tolist())
    assert heights["/world/static/chains"] == heights["/world/bodies/segments"] == {0.0}
    assert list(heights["/world/static/chains/solid_side"]) == [pytest.approx(-BAND_WIDTH * VIEW / 2)]


def test_static_shapes_stand_apart_and_kinematic_ones_among_the_moving() -> None:
    frame = replace(frame_of([BOX, BOX, CIRCLE], [(1, 1), (1, 1), (1, 0)]), body_kinds=np.array([0, 2, 1], np.uint8))
    found = looks(take(frame), VIEW)
    assert set(found) == {"/world/static/boxes", "/world/bodies/boxes", "/world/bodies/circles",
                          "/world/bodies/circles/spokes"}  # fmt: skip
    boxes = found["/world/bodies/boxes"]
    assert isinstance(boxes, Solids)
    assert np.ptp(boxes.colors[0].astype(int)) < 40, "grey: nothing moves it"


def columns_of(path: Path, entity: str) -> list[tuple[int, dict[str, Any]]]:
    """What was sent of an entity: its step, and how many items of each component."""
    rows: list[tuple[int, dict[str, Any]]] = []
    for chunk in read_chunks(path, schema.APPLICATION):
        if chunk.path != entity:
            continue
        names = [name for name in chunk.batch.schema.names if ":" in name and "rerun.controls" not in name]
        for row, step in enumerate(chunk.batch.column(schema.STEP_TIMELINE).to_pylist()):
            values = {name: chunk.batch.column(name)[row].as_py() for name in names}
            rows.append((step, {name: None if value is None else len(value) for name, value in values.items()}))
    return rows


def test_an_entity_that_lost_its_last_piece_is_emptied(tmp_path: Path) -> None:
    before = frame_of([BOX, POLYGON, CIRCLE], [(1, 1), (0.1, 0), (1, 0)], [regular(5)])
    after = replace(frame_of([BOX], [(1, 1)]), step=1)
    path = write(tmp_path / "e.rrd", [before, after, replace(after, step=2)])
    assert columns_of(path, "/world/bodies/outlines/0")[-1] == (1, {"Mesh3D:vertex_positions": 0})
    assert columns_of(path, "/world/bodies/circles")[-1][1]["Cylinders3D:radii"] == 0
    assert columns_of(path, "/world/static/boxes")[-1][0] == 1


def test_pieces_follow_their_bodies(tmp_path: Path) -> None:
    """The second piece of a body is where the body's frame has it."""
    frame = frame_of([BOX, BOX, BOX], [(1, 1)] * 3)
    frame = replace(frame, owners=np.array([0, 1, 1]), places=np.array([(0, 0, 0), (0, 0, 0), (2.0, 0, 0.5)]))
    frame = replace(frame, angles=np.array([0.0, np.pi / 2, 0.0]))
    path = write(tmp_path / "p.rrd", [frame])
    for chunk in read_chunks(path, schema.APPLICATION):
        if chunk.path == "/world/bodies/boxes" and "InstancePoses3D:translations" in chunk.batch.schema.names:
            (first, second) = chunk.batch.column("InstancePoses3D:translations")[0].as_py()
            turn = chunk.batch.column("InstancePoses3D:quaternions")[0].as_py()[1]
    assert first[:2] == pytest.approx([3.0, 0.0])
    assert second[:2] == pytest.approx([3.0, 2.0])
    assert 2 * np.arctan2(turn[2], turn[3]) == pytest.approx(np.pi / 2 + 0.5)


def test_a_recording_of_every_shape_names_them_all(tmp_path: Path) -> None:
    path = write(tmp_path / "t.rrd", list(tumbling(3)))
    entities = {chunk.path for chunk in read_chunks(path, schema.APPLICATION, under="/world/")}
    assert {"/world/static/boxes", "/world/static/chains", "/world/static/chains/solid_side", "/world/static/segments",
            "/world/bodies/boxes", "/world/bodies/circles", "/world/bodies/outlines/0"} <= entities  # fmt: skip
