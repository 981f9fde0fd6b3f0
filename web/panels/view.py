"""What is drawn, and how often. The switches are everybody's; the camera is each client's own."""

from __future__ import annotations

import viser

from sandbox.frame import Frame
from web.overlays import Overlay
from web.page import Page
from web.panels.desk import Desk, Event


class ViewPanel:
    def __init__(self, desk: Desk) -> None:
        add_view_controls(desk.page)

    def update(self, frame: Frame) -> None:
        pass


def add_view_controls(page: Page) -> None:
    """The folder itself, which the replay has too."""
    with page.gui.add_folder("View", expand_by_default=False):
        for overlay in page.overlays:
            _add_switch(page, overlay)
        grid = page.gui.add_checkbox("grid", True)
        rate = page.gui.add_slider("frames/s", 5, 60, 1, 60, hint="at most; fewer for very many bodies")
        frame_button = page.gui.add_button("Frame the scene", icon=viser.Icon.FOCUS_CENTERED, hint="F")

    @grid.on_update
    async def show_grid(_: Event) -> None:
        page.canvas.show_grid(grid.value)

    @rate.on_update
    async def limit(_: Event) -> None:
        page.publisher.rate_limit = float(rate.value)

    @frame_button.on_click
    async def press(event: Event) -> None:
        _aim(page, event.client)

    @page.gui.add_command("Frame the scene", hotkey="F").on_trigger
    async def key(event: viser.CommandEvent) -> None:
        _aim(page, event.client)


def _add_switch(page: Page, overlay: Overlay) -> None:
    switch = page.gui.add_checkbox(overlay.label, overlay.shown_at_first, hint=overlay.hint)

    @switch.on_update
    async def show(_: Event) -> None:
        overlay.show(switch.value)
        page.publisher.again()


def _aim(page: Page, client: viser.ClientHandle | None) -> None:
    if client is not None:
        page.camera.aim(client)
