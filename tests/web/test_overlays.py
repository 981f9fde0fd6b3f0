"""What is drawn over the bodies, without a browser: numbers in, arrays out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from engine import CONTACT_RECORD, HIT_EVENT, JOINT_RECORD
from engine.events import NOTHING
from tests.web.fake_session import BODY, make_frame
from web import ReplayApp
from web.overlays import OVERLAYS
from web.overlays.bounds import Bounds
from web.overlays.hits import CORNERS, LASTS, SMALLEST, Hits
from web.overlays.impulses import Impulses
from web.overlays.joints import Joints
from web.overlays.normals import Normals
from web.stage import Stage

STAGE = Stage(0.0, 5.0, 20.0)
TURNED: BODY = ("dynamic", "box", 4.0, 1.0, 2.0, 3.0, np.pi / 2)
DISC: BODY = ("dynamic", "circle", 0.5, 0.0, -3.0, 0.5, 0.0)
WALL: BODY = ("static", "box", 1.0, 1.0, 6.0, 6.0, 0.0)


class FakeScene:
    """Hands out nodes that keep what was assigned to them."""

    def __getattr__(self, _: str) -> Any:
        return lambda *_, **__: SimpleNamespace(visible=True, points=None)


def test_impulses_are_lines_in_proportion() -> None:
    contacts = np.zeros(2, CONTACT_RECORD)
    contacts["ny"], contacts["x"] = 1.0, (0.0, 4.0)
    contacts["normal_impulse"], contacts["tangent_impulse"] = (2.0, 1.0), (-1.0, 0.0)
    overlay = Impulses(FakeScene())  # type: ignore[arg-type]
    overlay.draw(make_frame([], contacts=contacts), STAGE)
    normal, friction = overlay._normal.points, overlay._friction.points
    lengths = np.linalg.norm(np.diff(normal, axis=1)[:, 0], axis=1)
    assert lengths[0] == pytest.approx(2 * lengths[1])
    assert normal[0, 1, 1] > normal[0, 0, 1]  # along the normal
    assert friction[0, 1, 0] < friction[0, 0, 0]  # against the tangent, which is the normal turned clockwise


def test_joints_go_from_centre_to_anchor_to_centre() -> None:
    joints = np.zeros(1, JOINT_RECORD)
    joints["body1"], joints["body2"] = 2, 1  # the wall, the disc
    joints[["x1", "y1", "x2", "y2"]] = (6.0, 5.0, 5.9, 5.0)
    overlay = Joints(FakeScene())  # type: ignore[arg-type]
    overlay.draw(make_frame([TURNED, DISC, WALL], joints=joints), STAGE)
    expected = [[(6, 5), (6, 5)], [(6, 5), (5.9, 5)], [(5.9, 5), (-3, 0.5)]]
    np.testing.assert_allclose(overlay._lines.points[:, :, :2], expected, rtol=1e-6)


def test_normals_are_arrows_from_the_contact_along_its_normal() -> None:
    contacts = np.zeros(1, CONTACT_RECORD)
    contacts[["x", "y", "nx", "ny"]] = (2.0, 3.0, 0.6, 0.8)
    overlay = Normals(FakeScene())  # type: ignore[arg-type]
    overlay.show(True)
    overlay.draw(make_frame([], contacts=contacts), STAGE)
    shaft, *barbs = overlay._lines.points[:, :, :2].astype(float)
    assert shaft[0] == pytest.approx([2.0, 3.0])
    length = np.hypot(*(shaft[1] - shaft[0]))
    assert shaft[1] - shaft[0] == pytest.approx(length * np.array([0.6, 0.8]), rel=1e-5)
    assert len(barbs) == 2
    for barb in barbs:
        assert barb[0] == pytest.approx(shaft[1])
        assert (barb[1] - barb[0]) @ (shaft[1] - shaft[0]) < 0.0, "back from the tip"


def test_bounding_boxes_are_the_broad_phases() -> None:
    bounds = np.array([(0, 1, 4, 3), (-2, -1, 0, 5)], np.float32)
    overlay = Bounds(FakeScene())  # type: ignore[arg-type]
    overlay.show(True)
    overlay.draw(make_frame([TURNED, DISC], bounds=bounds), STAGE)
    lines = overlay._lines.points
    assert lines.shape == (8, 2, 3)
    assert lines[:4, :, :2].tolist() == [[[0, 1], [4, 1]], [[4, 1], [4, 3]], [[4, 3], [0, 3]], [[0, 3], [0, 1]]]
    assert (lines[4:, :, :2].reshape(-1, 2).min(axis=0).tolist(), lines[4:, :, 0].max()) == ([-2, -1], 0)
    overlay.draw(make_frame([TURNED, DISC]), STAGE)  # before the first step there are none
    assert len(overlay._lines.points) == 0


def hit_frame(step: int, *hits: tuple[int, float, float, float], **changes: Any) -> Any:
    """A frame with these hits: step, x, y, speed."""
    rows = np.zeros(len(hits), HIT_EVENT)
    for row, (at, x, y, speed) in zip(rows, hits, strict=True):
        row["step"], row["x"], row["y"], row["speed"] = at, x, y, speed
    return make_frame([], step=step, time=step / 60, events=NOTHING._replace(hit=rows), **changes)


def test_hits_are_rings_that_shrink_for_a_second() -> None:
    overlay = Hits(FakeScene())  # type: ignore[arg-type]
    overlay.draw(hit_frame(100, (99, 1.0, 2.0, 4.0), (100, -3.0, 5.0, 1.0)), STAGE)

    def rings() -> np.ndarray:
        return overlay._lines.points[:, 0, :2].reshape(-1, CORNERS, 2)

    def radii() -> np.ndarray:
        return np.ptp(rings()[:, :, 0], axis=1) / 2

    assert rings().mean(axis=1) == pytest.approx(np.array([(1.0, 2.0), (-3.0, 5.0)]), abs=1e-5)
    assert radii()[0] / radii()[1] == pytest.approx(2.0, rel=0.02), "as the root of the speed"
    first = radii()[1]
    overlay.draw(hit_frame(159), STAGE)
    assert len(rings()) == 2
    overlay.draw(hit_frame(160, (160, 0.0, 0.0, 1.0)), STAGE)
    assert len(rings()) == 2, "the first one is more than a second old"
    assert radii()[0] / first == pytest.approx(1 - (1 - SMALLEST) * (60 / 60) / LASTS, rel=1e-3)
    assert radii()[1] == pytest.approx(first)
    overlay.draw(hit_frame(0), STAGE)
    assert len(rings()) == 0, "begun again"
    overlay.draw(hit_frame(5, (5, 0.0, 0.0, 1.0)), STAGE)
    overlay.draw(hit_frame(6, scene="another"), STAGE)
    assert len(rings()) == 0
    overlay.draw(hit_frame(6, (6, 5000.0, 1.0, 1.0), scene="another"), STAGE)
    far = Stage(5000.0, 0.0, 20.0)
    moved = far.shifted(hit_frame(6, (6, 5000.0, 1.0, 1.0)))
    assert moved.events.hit[["x", "y"]].tolist() == [(0.0, 1.0)]


def test_a_recording_has_no_switch_for_what_it_does_not_hold() -> None:
    class Recorded:
        def __len__(self) -> int:
            return 1

        def frame(self, _: int) -> Any:
            return make_frame([TURNED])

    app = ReplayApp(Recorded(), port=0)
    try:
        labels = [overlay.label for overlay in app._page.overlays]
    finally:
        app.close()
    assert labels == [kind.label for kind in OVERLAYS if kind is not Bounds]


@pytest.mark.parametrize("kind", OVERLAYS)
def test_an_overlay_that_is_off_draws_nothing_and_an_empty_frame_is_fine(kind: Any) -> None:
    overlay = kind(FakeScene())
    overlay.show(True)
    overlay.draw(make_frame([]), STAGE)
    overlay.show(False)
    for node in overlay._nodes:
        assert not node.visible
        node.points = None
    overlay.draw(make_frame([TURNED]), STAGE)
    assert all(node.points is None for node in overlay._nodes)
