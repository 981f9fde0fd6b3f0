"""The contact points that the arbiters hold."""

from __future__ import annotations

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay
from web.stage import Layer, Stage
from web.theme import CONTACT

POINT_SIZE = 0.004  # of the view's height


class Contacts(Overlay):
    label = "contacts"
    hint = "a point where two bodies touch"

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._points = scene.add_point_cloud(
            "/overlays/contacts",
            np.zeros((0, 3), np.float32),
            CONTACT,
            point_shape="circle",
            precision="float32",
            point_shading="flat",
        )
        return [self._points]

    def fill(self, frame: Frame, stage: Stage) -> None:
        points = np.full((len(frame.contacts), 3), stage.z(Layer.CONTACT), np.float32)
        points[:, 0] = frame.contacts["x"]
        points[:, 1] = frame.contacts["y"]
        self._points.point_size = POINT_SIZE * stage.height
        self._points.points = points
