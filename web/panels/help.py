"""What the mouse and the keys do, for those who see the page for the first time."""

from __future__ import annotations

from sandbox.frame import Frame
from web.panels.desk import Desk

MOUSE = (
    ("click", "drops bodies"),
    ("drag", "pulls a body"),
    ("right drag", "moves the view"),
    ("wheel", "zooms"),
)
KEYS = (
    ("space", "pause, play"),
    ("S or .", "one step"),
    ("R", "reset"),
    ("B", "bomb"),
    ("Esc", "puts the joint tool away"),
    ("arrows", "drive"),
    ("F", "frame the scene"),
    ("Ctrl K", "all commands"),
)
_ROW = '<div style="display:flex;gap:10px"><span style="width:6.5em;opacity:.6">{}</span><span>{}</span></div>'
_PAGE = (
    '<div style="padding:2px 14px 8px;font-size:.85em;line-height:1.5;display:grid;grid-auto-flow:column;'
    'grid-template-rows:repeat(4,auto);column-gap:22px">{}</div>'
)


class HelpPanel:
    def __init__(self, desk: Desk) -> None:
        rows = "".join(_ROW.format(*row) for row in (*MOUSE, *KEYS))
        with desk.hud.add_tab("Help", None):
            desk.gui.add_html(_PAGE.format(rows))

    def update(self, frame: Frame) -> None:
        pass
