"""The live page: a viewer of a session, and the hands that act on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sandbox.frame import Frame
from sandbox.scenes import SCENES
from web.page import Page
from web.panels import PANELS, Desk, JointsPanel, SpawnPanel
from web.panels.effects import Measure
from web.pointer import Pointer

if TYPE_CHECKING:
    from sandbox.session import Session

DEFAULT_HOST = "127.0.0.1"  # nobody else's machine, unless told otherwise
DEFAULT_PORT = 8080
DEFAULT_VIEW = (0.0, 5.0, 20.0)  # of a scene that is not in the list


class App:
    """Serves a session at `url` until `close`. A Viewer: frames come in on the session's thread, and leave it at once.

    measure_effects: gives what each effect of the running scene costs; without it there is no button for that.
    Raises web.ListenError (of which PortInUse is one) when it cannot have its address.
    """

    def __init__(
        self,
        session: Session,
        host: str = DEFAULT_HOST,
        port: int = DEFAULT_PORT,
        measure_effects: Measure | None = None,
    ) -> None:
        self._page = Page(_view_of, host, port)
        self.url = self._page.url
        self._closed = False
        self._desk = desk = Desk(self._page, session, measure_effects)
        panels = [kind(desk) for kind in PANELS]
        spawn = next(panel for panel in panels if isinstance(panel, SpawnPanel))
        joints = next(panel for panel in panels if isinstance(panel, JointsPanel))
        pointer = Pointer(desk, self._page, spawn, joints)
        self._page.listeners += [panel.update for panel in panels]
        self._page.listeners.append(pointer.update)
        session.add_viewer(self)  # which shows us the latest frame
        self._page.open()

    def show(self, frame: Frame) -> None:
        if not self._closed:
            self._page.publisher.put(frame)

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._desk.closing.set()
            self._page.close()


def _view_of(scene: str) -> tuple[float, float, float]:
    return SCENES[scene].view if scene in SCENES else DEFAULT_VIEW
