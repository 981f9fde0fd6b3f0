"""What is drawn from a frame, without a browser: numbers in, arrays and text out."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from engine import CONTACT_RECORD, JOINT_RECORD
from sandbox.commands import SetIterations, StartRecording, StopRecording
from sandbox.frame import Status
from tests.web.fake_session import BODY, FakeSession, make_frame, pyramid, wait_until
from tests.web.raw_client import CAMERA, RawClient, raw_client
from web import App
from web.overlays import OVERLAYS
from web.overlays.impulses import Impulses
from web.overlays.joints import Joints
from web.page import Page
from web.panels.plots import Plot, _medians
from web.panels.status import status_html
from web.pointer import body_at
from web.publisher import Publisher
from web.stage import Stage
from web.theme import body_colours, to_linear

STAGE = Stage(0.0, 5.0, 20.0)
TURNED: BODY = ("dynamic", "box", 4.0, 1.0, 2.0, 3.0, np.pi / 2)
DISC: BODY = ("dynamic", "circle", 0.5, 0.0, -3.0, 0.5, 0.0)
WALL: BODY = ("static", "box", 1.0, 1.0, 6.0, 6.0, 0.0)


class FakeScene:
    """Hands out nodes that keep what was assigned to them."""

    def __getattr__(self, _: str) -> Any:
        return lambda *_, **__: SimpleNamespace(visible=True, points=None)


def test_the_body_under_a_point() -> None:
    frame = make_frame([TURNED, DISC, WALL])
    assert body_at(frame, 2.4, 4.9) == 0  # the box stands on its end
    assert body_at(frame, 3.5, 3.0) is None
    assert body_at(frame, -3.3, 0.8) == 1
    assert body_at(frame, -3.4, 0.9) is None  # in the square around the disc, but not in the disc
    assert body_at(frame, 6.0, 6.0) is None  # static bodies cannot be taken hold of
    assert body_at(make_frame([]), 0.0, 0.0) is None


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


@pytest.mark.parametrize("kind", OVERLAYS)
def test_an_overlay_that_is_off_draws_nothing_and_an_empty_frame_is_fine(kind: Any) -> None:
    overlay = kind(FakeScene())
    overlay.draw(make_frame([]), STAGE)
    overlay.show(False)
    for node in overlay._nodes:
        assert not node.visible
        node.points = None
    overlay.draw(make_frame([TURNED]), STAGE)
    assert all(node.points is None for node in overlay._nodes)


def test_a_far_scene_is_drawn_around_its_own_middle() -> None:
    joints, contacts = np.zeros(1, JOINT_RECORD), np.zeros(1, CONTACT_RECORD)
    joints["x2"], contacts["y"] = 1e6 + 1.0, 5.5
    frame = make_frame([(*TURNED[:4], 1e6 + 0.25, 7.0, 0.0)], joints=joints, contacts=contacts)
    shifted = Stage(1e6, 5.0, 20.0).shifted(frame)
    assert shifted.positions.tolist() == [[0.25, 2.0]]
    assert (shifted.joints["x2"][0], shifted.contacts["y"][0]) == (1.0, 0.5)
    assert frame.positions[0, 0] == 1e6 + 0.25
    assert STAGE.shifted(frame) is frame


def test_colours_stay_with_their_bodies_and_tell_static_ones_apart() -> None:
    serials, is_static = np.arange(50), np.arange(50) == 3
    colours = body_colours(serials, is_static)
    assert len(np.unique(colours, axis=0)) == 9
    np.testing.assert_array_equal(colours[40:], body_colours(serials[40:], is_static[40:]))
    assert to_linear(np.array([0, 128, 255])).tolist() == [0, 55, 255]


def test_the_status_tells_what_is_wrong_in_safe_text() -> None:
    status = Status(steps_per_second=41.2, behind=True, failure="<script>body 7</script>")
    text = status_html(make_frame([WALL], status=status), {"<solve>": 2.5})
    assert "cannot keep real time: 41 of 60 steps/s" in text
    assert "&lt;script&gt;body 7" in text
    assert "<script>" not in text
    assert "&lt;solve&gt;" in text
    assert "waiting" in status_html(None, {})
    assert "steps/s" not in status_html(make_frame([WALL]), {}, is_live=False)


def test_the_publisher_draws_the_latest_frame_and_survives_a_fault(caplog: pytest.LogCaptureFixture) -> None:
    drawn: list[int] = []
    gate = threading.Event()

    def draw(frame: Any) -> None:
        gate.wait(5.0)
        drawn.append(frame.step)
        if frame.step == 0:
            raise RuntimeError("no such thing")

    publisher = Publisher(draw)
    frame = make_frame([WALL])
    publisher.put(frame)
    wait_until(lambda: not publisher._is_new)
    start = time.monotonic()
    for step in range(1, 1000):
        publisher.put(replace(frame, step=step))
    assert time.monotonic() - start < 0.5  # whoever puts frames does not wait for whoever draws them
    gate.set()
    wait_until(lambda: len(drawn) == 2)
    assert drawn == [0, 999]
    assert "no such thing" in caplog.text
    publisher.close()


@pytest.mark.parametrize("count", [1, 1000])
def test_a_frame_is_a_few_messages_however_many_bodies_move(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    page = Page(lambda _: (0.0, 5.0, 20.0), "127.0.0.1", 0)
    sent: list[Any] = []
    try:
        frame = make_frame([TURNED, DISC] * count)
        page._draw(frame)
        monkeypatch.setattr(page.server._websock_server, "queue_message", sent.append)
        page._draw(replace(frame, step=1, positions=frame.positions + 0.01))
    finally:
        page.close()
    poses = [message.name for message in sent if "batched_positions" in getattr(message, "updates", {})]
    assert sorted(poses) == [f"/bodies/{kind}/{part}" for kind in ("box", "circle") for part in ("face", "rim")]
    assert len(sent) <= 16  # those, their turns, and the overlays
    assert not any("batched_scales" in getattr(message, "updates", {}) for message in sent)


def test_a_recording_is_announced_and_sent_to_the_one_who_asks(tmp_path: Path) -> None:
    session = FakeSession(pyramid(1))
    app = App(session, port=0)  # type: ignore[arg-type]
    try:
        with raw_client(app.url) as client, raw_client(app.url) as other:
            client.set("Record", True)
            session.wait_for(StartRecording)
            wait_until(lambda: _label(client, "Stop recording"))
            client.set("Record", True)
            session.wait_for(StopRecording)
            session.last_recording = tmp_path / "run.rrd"
            session.last_recording.write_bytes(b"recorded" * 1000)
            session.publish(status=Status(notice="recorded run.rrd"))
            assert client.read_until("NotificationShowMessage")["props"]["body"] == "recorded run.rrd"
            client.set("Download", True)
            assert client.read_until("FileTransferStartDownload")["filename"] == "run.rrd"
            assert client.read_until("FileTransferPart")["content"] == b"recorded" * 1000
            other.set("iterations", 3)
            session.wait_for(SetIterations)
            assert not any(message["type"].startswith("FileTransfer") for message in other.read())
    finally:
        app.close()
        session.close()


def _label(client: Any, label: str) -> bool:
    return any(message.get("updates", {}).get("label") == label for message in client.read())


def test_a_tilted_camera_is_put_upright_and_an_early_report_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    page = Page(lambda _: (2.0, 5.0, 20.0), "127.0.0.1", 0)
    page._draw(make_frame([WALL]))
    page.open()
    tilted = CAMERA | {"position": [3.0, 5.0, 4.0], "look_at": [0.0, 5.0, 0.0]}
    try:
        with raw_client(page.url) as client:
            wait_until(lambda: page.server.get_clients())
            client.send(tilted)
            told = _next_place(client)
            assert told[0] == 2.0
            assert told[1] > 5.0  # the scene is below the window
            assert told[2] > 190.0
            monkeypatch.setattr("web.camera.SETTLE_TIME", 0.0)
            client.send(tilted)
            wait_until(lambda: _next_place(client) == pytest.approx([0.0, 5.0, 5.0]))
    finally:
        page.close()


def _next_place(client: RawClient) -> list[float]:
    """Where the camera is told to be, apart from what holds for those who come later."""
    while True:
        message = client.read_until("SetCameraPositionMessage")
        if not message["initial"]:
            return list(message["position"])


def test_plots_show_the_median_of_each_stage_and_begin_again_with_a_scene() -> None:
    class Gui:
        def add_uplot(self, *_: Any, **__: Any) -> Any:
            return SimpleNamespace(series=None, data=None)

    plot = Plot(Gui())  # type: ignore[arg-type]
    plot.send()
    assert plot._handle.data is None
    values = _medians([{"solve": 1.0}, {"solve": 90.0}, {"solve": 2.0, "sleep": 5.0}])
    assert values == {"solve": 2.0, "sleep": 5.0}
    plot.add(0.5, values)
    plot.add(0.6, values)
    plot.send()
    np.testing.assert_array_equal(plot._handle.data, [[0.5, 0.6], [2.0, 2.0], [5.0, 5.0]])
    plot.add(0.7, {"solve": 3.0})  # another solver has other stages
    plot.send()
    np.testing.assert_array_equal(plot._handle.data, [[0.7], [3.0]])
