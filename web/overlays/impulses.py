"""The impulses of the contacts, as lines whose length is in proportion to their size."""

from __future__ import annotations

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines, lines
from web.stage import Layer, Stage
from web.theme import FRICTION_IMPULSE, NORMAL_IMPULSE

LONGEST = 0.06  # of the view's height, for the largest of late
FADE = 0.99  # a frame; how fast a large impulse ceases to set the scale


class Impulses(Overlay):
    label = "impulses"
    hint = "normal impulses (amber) and friction (green), as long as they are large"

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._largest = 0.0  # N s
        self._normal = add_lines(scene, "/overlays/impulses/normal", NORMAL_IMPULSE)
        self._friction = add_lines(scene, "/overlays/impulses/friction", FRICTION_IMPULSE)
        return [self._normal, self._friction]

    def fill(self, frame: Frame, stage: Stage) -> None:
        contacts = frame.contacts
        points = np.column_stack([contacts["x"], contacts["y"]])
        normals = np.column_stack([contacts["nx"], contacts["ny"]])
        tangents = np.column_stack([contacts["ny"], -contacts["nx"]])
        scale = self._scale(contacts["normal_impulse"], stage)
        z = stage.z(Layer.IMPULSE)
        self._normal.points = lines(points, points + normals * (scale * contacts["normal_impulse"])[:, None], z)
        self._friction.points = lines(points, points + tangents * (scale * contacts["tangent_impulse"])[:, None], z)

    def _scale(self, impulses: np.ndarray, stage: Stage) -> float:
        """m per N s. One scale for all lines of a frame; it follows the scene, as a hammer and a feather need."""
        self._largest = max(self._largest * FADE, float(impulses.max(initial=0.0)))
        return LONGEST * stage.height / self._largest if self._largest > 0.0 else 0.0
