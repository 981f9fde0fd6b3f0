"""The joints: a line from each moving body's origin to its anchor, and one between the anchors: the joint's error."""

from __future__ import annotations

import numpy as np
import viser

from engine import BODY_KINDS
from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines, lines
from web.stage import Layer, Stage
from web.theme import JOINT

STATIC_BODY = BODY_KINDS.index("static")


class Joints(Overlay):
    label = "joints"
    hint = "lines from the bodies' origins to the points where they are joined"

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._lines = add_lines(scene, "/overlays/joints", JOINT, thickness=2.5)
        return [self._lines]

    def fill(self, frame: Frame, stage: Stage) -> None:
        joints = frame.joints
        anchor1 = np.column_stack([joints["x1"], joints["y1"]])
        anchor2 = np.column_stack([joints["x2"], joints["y2"]])
        origin1 = _origins(frame, joints["body1"], anchor1)
        origin2 = _origins(frame, joints["body2"], anchor2)
        starts = np.concatenate([origin1, anchor1, anchor2])
        ends = np.concatenate([anchor1, anchor2, origin2])
        self._lines.points = lines(starts, ends, stage.z(Layer.JOINT))


def _origins(frame: Frame, serials: np.ndarray, anchors: np.ndarray) -> np.ndarray:
    """Where the bodies are. Of a static body, or one that the frame does not have, only the anchor counts."""
    if len(frame.serials) == 0:
        return anchors
    places = np.minimum(np.searchsorted(frame.serials, serials), len(frame.serials) - 1)
    moves = (frame.serials[places] == serials) & (frame.body_kinds[places] != STATIC_BODY)
    return np.where(moves[:, None], frame.positions[places], anchors)
