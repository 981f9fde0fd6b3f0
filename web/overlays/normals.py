"""The directions of the contacts: arrows from the body created first to the other."""

from __future__ import annotations

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines, lines
from web.stage import Layer, Stage
from web.theme import NORMAL

LENGTH = 0.028  # of the view's height
BARB = 0.3  # of the length, and half of that to either side


class Normals(Overlay):
    label = "normals"
    hint = "in which direction a contact pushes: arrows from the body created first to the other"
    shown_at_first = False

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._lines = add_lines(scene, "/overlays/normals", NORMAL)
        return [self._lines]

    def fill(self, frame: Frame, stage: Stage) -> None:
        contacts, length = frame.contacts, LENGTH * stage.height
        starts = np.column_stack([contacts["x"], contacts["y"]])
        normals = np.column_stack([contacts["nx"], contacts["ny"]]) * length
        across = np.column_stack([normals[:, 1], -normals[:, 0]]) * (BARB / 2.0)
        tips = starts + normals
        barbs = [tips - BARB * normals + side * across for side in (-1.0, 1.0)]
        self._lines.points = lines(
            np.concatenate([starts, tips, tips]), np.concatenate([tips, *barbs]), stage.z(Layer.NORMAL)
        )
