"""Several solvers on one scene: the live one is drawn as ever, the others as outlines in their colours."""

from __future__ import annotations

import threading
from typing import Any

from engine import SOLVERS
from sandbox.commands import Reset
from sandbox.frame import Frame
from sandbox.lab.accuracy.style import colour_of
from sandbox.lab.side_by_side import SideBySide
from web.overlays.ghosts import Ghosts
from web.panels.desk import Desk, small_text
from web.theme import Colour

INTRODUCTION = "The scene begins again, and beside it each of these solvers steps it too, with its own numbers."
COMPILING = "compiling what they call for ..."


class ComparingPanel:
    """A switch for each solver."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._notice = ""
        self._choosing = threading.Lock()
        self._others = SideBySide(self._note)
        self._ghosts = Ghosts(desk.page.server.scene, {name: rgb(colour_of(name, ())) for name in SOLVERS})
        with desk.gui.add_folder("Compare solvers", expand_by_default=False):
            self._text = desk.gui.add_html(small_text(INTRODUCTION))
            self._switches: dict[str, Any] = {
                name: desk.gui.add_checkbox(name.replace("_", " "), False) for name in SOLVERS
            }
            self._legend = desk.gui.add_html(legend())
        for switch in self._switches.values():
            switch.on_update(self._on_switch)
        desk.session.add_viewer(self._others)

    def update(self, frame: Frame) -> None:
        frames = self._others.frames
        chosen = {name: frames[name] for name, switch in self._switches.items() if switch.value and name in frames}
        self._ghosts.draw(
            {name: one for name, one in chosen.items() if one.scene == frame.scene}, self._desk.page.stage
        )

    def _on_switch(self, event: Any) -> None:
        """On a thread of viser's pool, for it may compile; then the scene begins again, for all to start at once."""
        if event.client is None:
            return
        with self._choosing:
            wanted = tuple(name for name, switch in self._switches.items() if switch.value)
            self._text.content = small_text(COMPILING if wanted else INTRODUCTION)
            try:
                self._others.choose(wanted, self._desk.session.frame)
            except Exception as error:  # noqa: BLE001 - whatever it is, the page goes on and says so
                self._note(f"{type(error).__name__}: {error}")
            self._text.content = small_text(self._notice or INTRODUCTION)
            if wanted:
                self._desk.submit(Reset)
            self._desk.page.publisher.again()

    def _note(self, text: str) -> None:
        self._notice = text
        self._text.content = small_text(text or INTRODUCTION)
        if self._others.ended:
            for switch in self._switches.values():
                switch.value = False


def rgb(colour: str) -> Colour:
    """Of "#rrggbb"."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def legend() -> str:
    """Which colour is whose."""
    entries = "".join(
        f'<span><i style="display:inline-block;width:14px;height:3px;margin:0 5px 3px 0;'
        f'background:{colour_of(name, ())}"></i>{name}</span>'
        for name in SOLVERS
    )
    return f'<div style="padding:2px 14px 8px;font-size:.82em;display:flex;flex-wrap:wrap;gap:2px 14px">{entries}</div>'
