"""The boxes that the broad phase compares: only where two of them overlap is it worth looking for contacts."""

from __future__ import annotations

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines
from web.stage import Layer, Stage
from web.theme import BOUNDS

ROUND = (0, 1), (2, 1), (2, 3), (0, 3)  # a box's corners, counter-clockwise: which of its bounds are x and y


class Bounds(Overlay):
    label = "bounding boxes"
    hint = "upright boxes around the shapes, with a margin; the broad phase looks for those that overlap"
    shown_at_first = False
    in_recordings = False

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._lines = add_lines(scene, "/overlays/bounds", BOUNDS, thickness=1.2)
        return [self._lines]

    def fill(self, frame: Frame, stage: Stage) -> None:
        corners = frame.bounds[:, ROUND]  # (S, 4, 2)
        points = np.full((len(corners), 4, 2, 3), stage.z(Layer.BOUNDS), np.float32)
        points[:, :, 0, :2] = corners
        points[:, :, 1, :2] = np.roll(corners, -1, axis=1)
        self._lines.points = points.reshape(-1, 2, 3)
