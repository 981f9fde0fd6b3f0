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
from sandbox.commands import Set, StartRecording, StopRecording
from sandbox.frame import Status
from tests.web.fake_session import BODY, FakeSession, make_frame, pyramid, wait_until
from tests.web.raw_client import CAMERA, RawClient, raw_client
from web import App
from web.page import Page
from web.panels.plots import Plot, _medians
from web.panels.status import status_html
from web.publisher import Publisher
from web.stage import Stage
from web.theme import body_colours, to_linear

STAGE = Stage(0.0, 5.0, 20.0)
TURNED: BODY = ("dynamic", "box", 4.0, 1.0, 2.0, 3.0, np.pi / 2)
WALL: BODY = ("static", "box", 1.0, 1.0, 6.0, 6.0, 0.0)


def test_a_far_scene_is_drawn_around_its_own_middle() -> None:
    joints, contacts = np.zeros(1, JOINT_RECORD), np.zeros(1, CONTACT_RECORD)
    joints["x2"], contacts["y"] = 1e6 + 1.0, 5.5
    frame = make_frame([(*TURNED[:4], 1e6 + 0.25, 7.0, 0.0)], joints=joints, contacts=contacts)
    frame = replace(frame, bounds=np.array([(1e6 - 1.0, 6.0, 1e6 + 2.0, 8.0)], np.float32))
    shifted = Stage(1e6, 5.0, 20.0).shifted(frame)
    assert shifted.bounds.tolist() == [[-1.0, 1.0, 2.0, 3.0]]
    assert shifted.positions.tolist() == [[0.25, 2.0]]
    assert (shifted.joints["x2"][0], shifted.contacts["y"][0]) == (1.0, 0.5)
    assert frame.positions[0, 0] == 1e6 + 0.25
    assert STAGE.shifted(frame) is frame


def test_colours_stay_with_their_bodies_and_tell_those_apart_that_nothing_moves() -> None:
    serials, kinds = np.arange(50), np.where(np.arange(50) == 3, 0, np.where(np.arange(50) == 4, 2, 1))
    asleep = np.zeros(50, np.bool_)
    colours = body_colours(serials, kinds, asleep)
    assert len(np.unique(colours, axis=0)) == 8 + 2
    np.testing.assert_array_equal(colours[40:], body_colours(serials[40:], kinds[40:], asleep[40:]))
    assert to_linear(np.array([0, 128, 255])).tolist() == [0, 55, 255]


def test_what_sleeps_is_drawn_in_a_duller_colour_of_its_own() -> None:
    serials, kinds = np.arange(50), np.ones(50, np.int64)
    asleep = serials % 2 == 0
    awake, both = (body_colours(serials, kinds, who).astype(int) for who in (np.zeros(50, np.bool_), asleep))
    np.testing.assert_array_equal(both[~asleep], awake[~asleep])
    assert (np.ptp(both[asleep], axis=1) < 0.6 * np.ptp(awake[asleep], axis=1)).all(), "less colour"
    assert (both[asleep].sum(axis=1) < awake[asleep].sum(axis=1)).all(), "less light"
    assert len(np.unique(both[asleep], axis=0)) == len(np.unique(awake[asleep], axis=0)), "still told apart"


def test_the_status_counts_who_sleeps() -> None:
    frame = make_frame([WALL, TURNED, TURNED], asleep=np.array([False, True, True]))
    assert '<span style="opacity:.6">asleep</span><span>2</span>' in status_html(frame, {})


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
            session.wait_for(Set)
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
