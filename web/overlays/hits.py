"""Where bodies hit each other in the last second, as rings: the faster the larger, and the older the smaller."""

from __future__ import annotations

import math

import numpy as np
import viser

from sandbox.frame import Frame
from web.overlays.overlay import Overlay, add_lines
from web.stage import Layer, Stage
from web.theme import HIT

LASTS = 1.0  # simulated time that a ring is seen [s]
RADIUS = 0.012  # of a hit of 1 m/s, of the view's height; it grows with the root of the speed
LARGEST = 0.08  # of the view's height
SMALLEST = 0.25  # what is left of a ring when it goes
CORNERS = 16
MOST = 400  # rings at once: the latest

_TURNS = np.arange(CORNERS + 1) * (2.0 * math.pi / CORNERS)
_RING = np.column_stack([np.cos(_TURNS), np.sin(_TURNS)])


class Hits(Overlay):
    label = "hits"
    hint = "where bodies hit each other in the last second, larger if faster; needs the setting tell events"

    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]:
        self._scene_name = ""
        self._hits = np.zeros((0, 4))  # x, y [m], speed [m/s], step
        self._drawn = 0
        self._lines = add_lines(scene, "/overlays/hits", HIT)
        return [self._lines]

    def fill(self, frame: Frame, stage: Stage) -> None:
        new = frame.events.hit
        if frame.scene != self._scene_name:
            self._scene_name, self._hits = frame.scene, self._hits[:0]
        hits = np.concatenate([self._hits, np.column_stack([new["x"], new["y"], new["speed"], new["step"]])])
        ages = (frame.step - hits[:, 3]) * frame.dt  # < 0: of a run that was reset, or of a recording put back
        kept = np.flatnonzero((ages >= 0.0) & (ages <= LASTS))[-MOST:]
        self._hits = hits[kept]
        if len(kept) or self._drawn:
            self._lines.points = rings(self._hits, ages[kept], stage)
        self._drawn = len(kept)


def rings(hits: np.ndarray, ages: np.ndarray, stage: Stage) -> np.ndarray:
    """(N * CORNERS, 2, 3) float32 segments."""
    sizes = stage.height * np.minimum(RADIUS * np.sqrt(hits[:, 2]), LARGEST)
    sizes *= 1.0 - (1.0 - SMALLEST) * ages / LASTS
    places = hits[:, None, :2] + sizes[:, None, None] * _RING
    points = np.full((len(hits), CORNERS, 2, 3), stage.z(Layer.HIT), np.float32)
    points[:, :, 0, :2] = places[:, :-1]
    points[:, :, 1, :2] = places[:, 1:]
    return points.reshape(-1, 2, 3)
