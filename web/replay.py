"""A recording in the same page: play, pause, speed, and a slider for time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Protocol

import viser

from sandbox.frame import Frame
from web.guard import log
from web.overlays import OVERLAYS
from web.page import Page
from web.panels.desk import Event, add_hud, small_text
from web.panels.status import status_html
from web.panels.view import add_view_controls
from web.player import TICK, Player

REFRESH_INTERVAL = 0.1  # s between two looks at what the controls show
SLIDER_STEP = 0.01  # s
MOST_PASSED = 8  # steps between two pictures whose events are told: more are a leap
SETTLE_TIME = 0.4  # s after a hand left the slider, before the player moves it again


class Frames(Protocol):
    """A recording as a sequence of frames, at equal distances in time."""

    def __len__(self) -> int: ...

    def frame(self, index: int) -> Frame: ...


class ReplayApp:
    """Serves a recording at `url` until `close`. All clients see the same moment of it."""

    def __init__(
        self,
        frames: Frames,
        view: tuple[float, float, float] = (0.0, 5.0, 20.0),
        host: str = "127.0.0.1",
        port: int = 8080,
        title: str = "recording",
    ) -> None:
        if len(frames) == 0:
            raise ValueError("the recording has no frames")
        self._frames = frames
        start = frames.frame(0)
        self._player = Player(len(frames), start.dt, start.time)
        self._page = Page(lambda _: view, host, port, [kind for kind in OVERLAYS if kind.in_recordings])
        self.url = self._page.url
        self._shown = -1
        self._frame: Frame | None = None
        self._shows_playing = True
        self._next_refresh = 0.0
        self._closed = threading.Event()
        self._add_controls(title)
        add_view_controls(self._page)
        self._page.open()
        self._thread = threading.Thread(target=self._run, name="tumble-replay", daemon=True)
        self._thread.start()

    def close(self) -> None:
        if not self._closed.is_set():
            self._closed.set()
            self._thread.join(timeout=2.0)
            self._page.close()

    def _add_controls(self, title: str) -> None:
        gui, player = self._page.gui, self._player
        with gui.add_folder("Replay"):
            gui.add_html(small_text(title))
            self._play = gui.add_button("Pause", icon=viser.Icon.PLAYER_PAUSE, hint="space")
            first, last = round(player.time_of(0), 2), round(player.time_of(player.last), 2)
            last = max(last, first + SLIDER_STEP)  # a recording of one frame still needs a slider
            self._slider: Any = gui.add_slider("time", first, last, SLIDER_STEP, first, hint="s; drag to any moment")
            speed = gui.add_slider("speed", 0.1, 4.0, 0.1, 1.0, hint="recorded seconds per second")
        with add_hud(gui).add_tab("Status", viser.Icon.ACTIVITY):
            self._status = gui.add_html(status_html(None, {}))

        @speed.on_update
        async def change_speed(_: Event) -> None:
            player.speed = speed.value

        @self._slider.on_update
        async def seek(event: Event) -> None:
            if event.client is not None:
                player.seek(player.index_at(self._slider.value))

        @self._play.on_click
        async def press(_: Event) -> None:
            player.toggle()

        self._add_key("Pause or play", "space", player.toggle)
        self._add_key("One step on", ".", lambda: player.step(1))
        self._add_key("One step back", ",", lambda: player.step(-1))
        self._add_key("To the start", "R", lambda: player.seek(0))

    def _add_key(self, label: str, key: Any, act: Callable[[], None]) -> None:
        @self._page.gui.add_command(label, hotkey=key).on_trigger
        async def triggered(_: viser.CommandEvent) -> None:
            act()

    def _run(self) -> None:
        while not self._closed.wait(TICK):
            self._show(self._player.advance(time.monotonic()))
            now = time.monotonic()
            if now >= self._next_refresh:
                self._next_refresh = now + REFRESH_INTERVAL
                self._refresh(now)

    def _show(self, index: int) -> None:
        if index == self._shown:
            return
        passed = range(max(self._shown + 1, index - MOST_PASSED), index)
        self._shown = index
        try:
            for between in passed:  # not drawn, but what happened in them is told
                self._page.publisher.put(self._frames.frame(between))
            self._frame = self._frames.frame(index)
            self._page.publisher.put(self._frame)
        except Exception as error:  # noqa: BLE001 - whatever is wrong with the file, the page stays
            log.error("step %d of the recording cannot be shown: %s", index, error)
            self._player.playing = False

    def _refresh(self, now: float) -> None:
        """Let the controls show what the player does, unless a hand is on them."""
        if self._player.playing != self._shows_playing:
            self._shows_playing = self._player.playing
            self._play.label = "Pause" if self._shows_playing else "Play"
            self._play.icon = viser.Icon.PLAYER_PAUSE if self._shows_playing else viser.Icon.PLAYER_PLAY
        if now - self._player.sought > SETTLE_TIME:
            moment = round(self._player.time_of(self._shown), 2)
            self._slider.value = min(max(moment, self._slider.min), self._slider.max)
        if self._frame is not None:
            self._status.content = status_html(self._frame, self._frame.stage_ms, is_live=False)
