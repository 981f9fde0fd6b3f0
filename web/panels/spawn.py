"""New bodies: what they are like; the button drops them from above, a click in the view where it is."""

from __future__ import annotations

import math
from typing import NamedTuple

import viser

from engine import SHAPE_KINDS
from sandbox.commands import CORNERS, LINES, Spawn
from sandbox.frame import Frame
from web.panels.desk import Desk

DROP_HEIGHT = 0.4  # of the view's height, above its middle


class Form(NamedTuple):
    """What one may choose of a shape, and what it is called there. A further shape needs an entry where it differs."""

    width: str = "width"
    height: str = "height"  # empty: it has none
    has_corners: bool = False


FORMS = {
    "circle": Form("diameter", ""),
    "polygon": Form(has_corners=True),
    "segment": Form("length", ""),
}


class SpawnPanel:
    def __init__(self, desk: Desk) -> None:
        self._page = desk.page
        gui = desk.gui
        with gui.add_folder("Spawn"):
            self._shape = gui.add_dropdown("shape", tuple(SHAPE_KINDS))
            self._width = gui.add_slider("width", 0.05, 5.0, 0.05, 1.0, hint="m")
            self._height = gui.add_slider("height", 0.05, 5.0, 0.05, 1.0, hint="m")
            self._corners = gui.add_slider("corners", *CORNERS, 1, 5, visible=False)
            self._rounding = gui.add_slider(
                "rounding", 0.0, 0.5, 0.01, 0.0, hint="m: radius of edges and corners", visible=False
            )
            self._angle = gui.add_slider("angle", -90, 90, 5, 0, hint="degrees, counter-clockwise")
            self._count = gui.add_slider("count", 1, 200, 1, 1)
            self._static = gui.add_checkbox("static", False, hint="never moves, whatever hits it")
            self._bullet = gui.add_checkbox("bullet", False, hint="goes through no moving body, however fast it is")
            self._mass = gui.add_number("mass", 10.0, min=0.01, max=1e6, step=0.01, hint="kg, of each")
            with gui.add_folder("Material", expand_by_default=False):
                self._friction = gui.add_slider("friction", 0.0, 2.0, 0.05, 0.6, hint="0 is ice, 1 is rubber")
                self._restitution = gui.add_slider(
                    "restitution", 0.0, 1.0, 0.05, 0.0, hint="how much it bounces: 0 not at all, 1 for ever"
                )
                self._rolling = gui.add_slider(
                    "rolling resistance", 0.0, 1.0, 0.01, 0.0, hint="how soon a round shape that rolls comes to rest"
                )
            button = gui.add_button("Spawn", icon=viser.Icon.PLUS, hint="or click into the view")
        desk.on_press(button, self._from_above)
        for control in (self._shape, self._static):
            control.on_update(self._show_what_matters)

    def command(self, x: float, y: float) -> Spawn:
        return Spawn(
            shape=self._shape.value,
            x=x,
            y=y,
            width=self._width.value,
            height=self._height.value,
            mass=self._mass.value,
            friction=self._friction.value,
            count=self._count.value,
            kind="static" if self._is_static() else "dynamic",
            angle=math.radians(self._angle.value),
            restitution=self._restitution.value,
            rolling_resistance=self._rolling.value,
            corners=self._corners.value,
            rounding=self._rounding.value,
            bullet=self._bullet.value and not self._is_static(),
        )

    def update(self, frame: Frame) -> None:
        pass

    def _from_above(self) -> Spawn:
        stage = self._page.stage
        return self.command(stage.center_x, stage.center_y + DROP_HEIGHT * stage.height)

    def _is_static(self) -> bool:
        return self._static.value or self._shape.value in LINES

    async def _show_what_matters(self, _: object) -> None:
        """The controls of this shape, under its own names."""
        form = FORMS.get(self._shape.value, Form())
        self._width.label = form.width
        self._height.visible = bool(form.height)
        for control in (self._corners, self._rounding):
            control.visible = form.has_corners
        self._static.visible = self._shape.value not in LINES
        self._mass.visible = self._bullet.visible = not self._is_static()
