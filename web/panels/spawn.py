"""New bodies: what they are like; the button drops them from above, a click in the view where it is."""

from __future__ import annotations

import viser

from engine import SHAPE_KINDS
from sandbox.commands import Spawn
from sandbox.frame import Frame
from web.panels.desk import Desk

DROP_HEIGHT = 0.4  # of the view's height, above its middle


class SpawnPanel:
    def __init__(self, desk: Desk) -> None:
        self._page = desk.page
        gui = desk.gui
        with gui.add_folder("Spawn"):
            self._kind = gui.add_dropdown("kind", tuple(SHAPE_KINDS))
            self._width = gui.add_slider("width", 0.05, 5.0, 0.05, 1.0, hint="m; of a circle, its diameter")
            self._height = gui.add_slider("height", 0.05, 5.0, 0.05, 1.0, hint="m")
            self._mass = gui.add_number("mass", 10.0, min=0.01, max=1e6, step=0.01, hint="kg")
            self._friction = gui.add_slider("friction", 0.0, 2.0, 0.05, 0.6)
            self._count = gui.add_slider("count", 1, 200, 1, 1)
            button = gui.add_button("Spawn", icon=viser.Icon.PLUS, hint="or click into the view")
        desk.on_press(button, self._from_above)

        @self._kind.on_update
        async def changed(_: object) -> None:
            self._height.visible = self._kind.value != "circle"

    def command(self, x: float, y: float) -> Spawn:
        return Spawn(
            shape=self._kind.value,
            width=self._width.value,
            height=self._height.value,
            mass=self._mass.value,
            friction=self._friction.value,
            x=x,
            y=y,
            count=self._count.value,
        )

    def _from_above(self) -> Spawn:
        stage = self._page.stage
        return self.command(stage.center_x, stage.center_y + DROP_HEIGHT * stage.height)

    def update(self, frame: Frame) -> None:
        pass
