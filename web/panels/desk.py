"""What the panels share: sending commands, and following values that others have changed."""

from __future__ import annotations

import html
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

import viser

from sandbox.frame import Frame
from web.page import Page

if TYPE_CHECKING:
    from sandbox.session import Session
    from web.panels.effects import Measure

SETTLE_TIME = 0.6  # s after a client's hand left a control, before the control follows the session again
HUD_PLACE = (14, 14, 640)  # pixels: left, top, width. Low and wide: web.camera.HUD_SHARE is all that it may cover

Make = Callable[[], Any]
Event = viser.GuiEvent[Any]


class Panel(Protocol):
    """One folder. It adds its controls once, and sees every frame that is drawn."""

    def __init__(self, desk: Desk) -> None: ...

    def update(self, frame: Frame) -> None: ...


class Desk:
    """Given to every panel. The session is touched by nothing but `submit`."""

    def __init__(self, page: Page, session: Session, measure_effects: Measure | None = None) -> None:
        self.page = page
        self.measure_effects = measure_effects  # None: nothing here can measure them
        self.gui = page.gui
        self.session = session
        self.closing = threading.Event()  # set when the page closes: what runs in the background ends
        self.hud = add_hud(page.gui)  # for what one watches, apart from what one sets

    def submit(self, make: Make) -> None:
        """Queue the command that `make` returns; values that a command refuses are logged, and nothing else happens."""
        try:
            if not self.session.submit(make()):
                self.page.report("ignored: too many commands wait already")
        except ValueError as error:
            self.page.report("ignored: %s", error)
        except Exception as error:  # noqa: BLE001 - no traceback reaches a user, and the page goes on
            self.page.report("a command failed: %s: %s", type(error).__name__, error)

    def on_change(self, control: Any, make: Make) -> None:
        """Submit when a client changes this control; when the page itself changes it, that is not news."""

        @control.on_update
        async def changed(event: Event) -> None:
            if event.client is not None:
                self.submit(make)

    def on_press(self, button: Any, make: Make) -> None:
        @button.on_click
        async def pressed(_: Event) -> None:
            self.submit(make)

    def on_key(self, label: str, key: Any, make: Make) -> None:
        """A hotkey, which is also found in the palette (Ctrl+K)."""

        @self.gui.add_command(label, hotkey=key).on_trigger
        async def triggered(_: viser.CommandEvent) -> None:
            self.submit(make)


def add_hud(gui: viser.GuiApi) -> viser.PanelHandle:
    """A window over the view, to be filled with tabs."""
    hud = gui.add_panel()
    hud.float(x=HUD_PLACE[0], y=HUD_PLACE[1], width=HUD_PLACE[2])
    return hud


def small_text(text: str) -> str:
    """A line of plain text between controls, as HTML."""
    return f'<div style="padding:2px 14px 8px;font-size:.82em;opacity:.7">{html.escape(text)}</div>'


class Follower:
    """Controls that show a value of the session, whoever changed it."""

    def __init__(self) -> None:
        self._followed: list[tuple[Any, Callable[[Frame], Any]]] = []

    def add(self, control: Any, read: Callable[[Frame], Any]) -> None:
        self._followed.append((control, read))

    def update(self, frame: Frame) -> None:
        for control, read in self._followed:
            value = _fitted(control, read(frame))
            # Frames lag behind a hand that drags a slider; following them at once would tear it from the hand.
            if value != control.value and time.time() - control.update_timestamp > SETTLE_TIME:
                control.value = value


def _fitted(control: Any, value: Any) -> Any:
    """The nearest value that the control can show."""
    if isinstance(control, viser.GuiSliderHandle):
        return min(max(value, control.min), control.max)
    if isinstance(control, viser.GuiDropdownHandle) and value not in control.options:
        return control.value
    return value
