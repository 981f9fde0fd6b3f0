"""Recording on and off, and the last finished file for download."""

from __future__ import annotations

import time
from pathlib import Path

import viser

from sandbox.commands import StartRecording, StopRecording
from sandbox.frame import Frame
from web.panels.desk import Desk, Event, small_text

LARGEST_DOWNLOAD = 256 * 1024 * 1024  # bytes; the browser gets it through the page's own socket
DOWNLOAD_RATE = 50e6  # bytes/s, on average and to all clients together: what is not sent yet fills memory


class RecordingPanel:
    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._recording = ""
        self._next_download = 0.0
        self._finished = desk.session.last_recording
        with desk.gui.add_folder("Recording", expand_by_default=False):
            self._switch = desk.gui.add_button(
                "Record",
                icon=viser.Icon.PLAYER_RECORD,
                disabled=not desk.session.can_record,
                hint="write what happens into a file",
            )
            self._download = desk.gui.add_button(
                "Download",
                icon=viser.Icon.DOWNLOAD,
                disabled=self._finished is None,
                hint="the last finished recording",
            )
            self._line = desk.gui.add_html(small_text("not recording"))
        desk.on_press(self._switch, lambda: StopRecording() if self._recording else StartRecording())
        self._download.on_click(self._on_download)

    def update(self, frame: Frame) -> None:
        recording, finished = frame.status.recording, self._desk.session.last_recording
        if recording != self._recording:
            self._show(recording)
            self._recording = recording
        if finished is not None and finished != self._finished:
            self._finished = finished
            self._download.disabled = False
            self._line.content = small_text(f"saved {finished.name} ({_size(finished)})")

    def _show(self, recording: str) -> None:
        self._switch.label = "Stop recording" if recording else "Record"
        self._switch.icon = viser.Icon.PLAYER_STOP if recording else viser.Icon.PLAYER_RECORD
        self._switch.color = "red" if recording else None
        self._line.content = small_text(f"recording {Path(recording).name}" if recording else "not recording")

    def _on_download(self, event: Event) -> None:
        """To the client who asked, and to no other. On a thread of viser's pool: a large file takes a while to read."""
        path = self._desk.session.last_recording
        if event.client is None or path is None or time.monotonic() < self._next_download:
            return
        try:
            size = path.stat().st_size
            self._next_download = time.monotonic() + 1.0 + size / DOWNLOAD_RATE
            if size > LARGEST_DOWNLOAD:
                _tell(event.client, f"{path.name} is too large to send ({_size(path)}); it is in the record directory.")
                return
            content = path.read_bytes()
        except OSError as error:
            self._desk.page.report("cannot send %s: %s", path.name, error.strerror)
            _tell(event.client, f"{path.name} cannot be read.")
            return
        event.client.send_file_download(path.name, content, save_immediately=True)


def _tell(client: viser.ClientHandle, text: str) -> None:
    client.add_notification("No download", text, auto_close_seconds=8.0, color="red")


def _size(path: Path) -> str:
    try:
        return f"{path.stat().st_size / 1e6:.1f} MB"
    except OSError:
        return "size unknown"
