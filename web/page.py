"""What the live page and the replay share: the server behind its guard, the canvas, the overlays, the camera."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import viser

from sandbox.frame import Frame
from web.camera import Camera
from web.canvas import Canvas
from web.listen import page_url
from web.overlays import OVERLAYS, Overlay
from web.publisher import Publisher
from web.server import start_server, stop_server
from web.stage import Stage
from web.theme import apply_theme

ViewOf = Callable[[str], tuple[float, float, float]]  # scene -> center x, center y, height [m]
Update = Callable[[Frame], None]


class Page:
    """Serves a view of frames. Nobody gets in before `open`, so nobody sees half a page."""

    def __init__(self, view_of: ViewOf, host: str, port: int, overlays: Iterable[type[Overlay]] = OVERLAYS) -> None:
        self._view_of = view_of
        self.server, self._guard = start_server(host, port)
        self.url = page_url(host, self.server.get_port())
        apply_theme(self.server)
        self.gui.main_panel.dock_right()
        self.canvas = Canvas(self.server)
        self.overlays: list[Overlay] = [kind(self.server.scene) for kind in overlays]
        self.camera = Camera(self.server)
        self.stage = Stage(0.0, 0.0, 20.0)
        self.listeners: list[Update] = []  # called with every frame that is drawn
        self._scene: str | None = None
        self.publisher = Publisher(self._draw)

    @property
    def gui(self) -> viser.GuiApi:
        return self.server.gui

    def open(self) -> None:
        self._guard.open(self.server)

    def close(self) -> None:
        self.publisher.close()
        stop_server(self.server)

    def report(self, line: str, *values: object) -> None:
        """Log what a client caused. It may do so again and again, so the guard limits how much is written."""
        self._guard.report(line, *values)

    def notify(self, title: str, text: str) -> None:
        """Tell every client, for a while."""
        for client in self.server.get_clients().values():
            client.add_notification(title, text, auto_close_seconds=8.0)

    def _draw(self, frame: Frame) -> None:
        if frame.scene != self._scene:
            self._scene = frame.scene
            self.stage = Stage(*self._view_of(frame.scene))
            self.camera.show(self.stage)
        shifted = self.stage.shifted(frame)
        with self.server.atomic():
            self.canvas.draw(shifted, self.stage)
            for overlay in self.overlays:
                overlay.draw(shifted, self.stage)
            for listener in self.listeners:
                listener(frame)
        self.server.flush()
