"""The impulses of the contacts, as lines whose length is in proportion to their size."""

from __future__ import annotations

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines, lines
from web.stage import Layer, Stage
from web.theme import FRICTION_IMPULSE, NORMAL_IMPULSE

USUAL = 0.05  # of the view's height: the length of a large impulse, where large is what LARGE of them are below
LARGE = 0.9
LONGEST = 0.25  # of the view's height, where a single blow would else cross the whole view
FOLLOWING = 0.05  # share of a new frame in the scale: what a line's length means should not jump


class Impulses(Overlay):
    label = "impulses"
    hint = "normal impulses (amber) and friction (green), as long as they are large"

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._large = 0.0  # N s
        self._normal = add_lines(scene, "/overlays/impulses/normal", NORMAL_IMPULSE)
        self._friction = add_lines(scene, "/overlays/impulses/friction", FRICTION_IMPULSE)
        return [self._normal, self._friction]

    def fill(self, frame: Frame, stage: Stage) -> None:
        contacts = frame.contacts
        points = np.column_stack([contacts["x"], contacts["y"]])
        normals = np.column_stack([contacts["nx"], contacts["ny"]])
        tangents = np.column_stack([contacts["ny"], -contacts["nx"]])
        scale = self._scale(contacts["normal_impulse"], stage)
        z, longest = stage.z(Layer.IMPULSE), LONGEST * stage.height
        for node, directions, name in (
            (self._normal, normals, "normal_impulse"),
            (self._friction, tangents, "tangent_impulse"),
        ):
            lengths = np.clip(scale * contacts[name], -longest, longest)
            node.points = lines(points, points + directions * lengths[:, None], z)

    def _scale(self, impulses: np.ndarray, stage: Stage) -> float:
        """m per N s. One scale for all lines of a frame; it follows the scene, as a hammer and a feather need."""
        acting = impulses[impulses > 0.0]
        if len(acting):
            large = float(np.quantile(acting, LARGE))
            self._large = large if self._large == 0.0 else self._large + FOLLOWING * (large - self._large)
        return USUAL * stage.height / self._large if self._large > 0.0 else 0.0
