"""A recording in the page: what is shown when."""

from __future__ import annotations

from dataclasses import replace

import pytest

from sandbox.frame import Frame
from tests.web.fake_session import DT, make_frame, pyramid, wait_until
from tests.web.raw_client import raw_client
from web import ReplayApp
from web.player import Player


class Recorded:
    """So many frames, of which the last cannot be read."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.asked: list[int] = []
        self.first = make_frame(pyramid(2), time=3.0)

    def __len__(self) -> int:
        return self.count

    def frame(self, index: int) -> Frame:
        self.asked.append(index)
        if index > 0 and index == self.count - 1:
            raise OSError("the file ends here")
        return replace(self.first, step=index, time=3.0 + index * DT)


def test_the_player_keeps_time_and_stops_at_the_end() -> None:
    player = Player(101, dt=0.01)
    assert player.advance(5.0) == 0
    assert player.advance(5.205) == 20
    player.speed = 2.0
    assert player.advance(5.305) == 40
    assert player.advance(9.0) == 100
    assert not player.playing
    player.toggle()  # from the start again
    assert player.playing
    assert player.advance(9.001) == 0


def test_the_player_seeks_and_steps_within_the_recording() -> None:
    player = Player(11, dt=0.1, start_time=2.0)
    assert player.index_at(2.5) == 5
    assert player.time_of(5) == pytest.approx(2.5)
    player.toggle()
    player.seek(99)
    assert player.advance(0.0) == 10
    player.step(1)
    player.step(-3)
    assert player.advance(1.0) == 7


def test_a_recording_is_played_and_sought_in_the_page() -> None:
    frames = Recorded(600)
    app = ReplayApp(frames, port=0)
    try:
        wait_until(lambda: max(frames.asked) > 5)
        with raw_client(app.url) as client:
            client.set("time", 3.0 + 400 * DT)
            wait_until(lambda: any(400 <= index < 500 for index in frames.asked))
            client.send({"type": "CommandTriggerMessage", "uuid": client.control("Pause or play")})
            wait_until(lambda: not app._player.playing)
            client.set("time", 1.0)  # before the recording began
            client.send({"type": "CommandTriggerMessage", "uuid": client.control("To the start")})
            wait_until(lambda: app._shown == 0)
    finally:
        app.close()
        app.close()


def test_a_frame_that_cannot_be_read_ends_the_playing_only(caplog: pytest.LogCaptureFixture) -> None:
    frames = Recorded(3)
    app = ReplayApp(frames, port=0)
    try:
        wait_until(lambda: "step 2 of the recording cannot be shown: the file ends here" in caplog.text)
        with raw_client(app.url) as client:
            client.send({"type": "CommandTriggerMessage", "uuid": client.control("One step back")})
            wait_until(lambda: app._shown == 1)
    finally:
        app.close()


def test_a_recording_without_frames_is_refused() -> None:
    with pytest.raises(ValueError, match="no frames"):
        ReplayApp(Recorded(0), port=0)
