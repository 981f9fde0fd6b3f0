"""What every overlay has in common: a label for its switch, and drawing only while it is switched on."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
import viser

from sandbox.frame import Frame
from web.stage import Stage
from web.theme import Colour


class Overlay(ABC):
    """Drawn on top of the bodies. A subclass names itself, adds its nodes once and fills them for every frame."""

    label: ClassVar[str]
    hint: ClassVar[str]
    shown_at_first: ClassVar[bool] = True
    in_recordings: ClassVar[bool] = True  # whether a recording holds what it draws

    def __init__(self, scene: viser.SceneApi) -> None:
        self._shown = self.shown_at_first
        self._nodes = self.add_nodes(scene)

    @abstractmethod
    def add_nodes(self, scene: viser.SceneApi) -> list[viser.SceneNodeHandle]: ...

    @abstractmethod
    def fill(self, frame: Frame, stage: Stage) -> None: ...

    def draw(self, frame: Frame, stage: Stage) -> None:
        if self._shown:
            self.fill(frame, stage)

    def show(self, shown: bool) -> None:
        self._shown = shown
        for node in self._nodes:
            node.visible = shown


def add_lines(scene: viser.SceneApi, name: str, colour: Colour, thickness: float = 2.0) -> viser.LineSegmentsHandle:
    """Lines without any yet, `thickness` pixels wide."""
    points = np.zeros((0, 2, 3), np.float32)
    return scene.add_line_segments(name, points, colour, thickness=thickness, thickness_units="screen")


def lines(starts: np.ndarray, ends: np.ndarray, z: float) -> np.ndarray:
    """(N, 2, 3) float32 segments at height z, from two arrays (N, 2) [m]."""
    points = np.full((len(starts), 2, 3), z, np.float32)
    points[:, 0, :2] = starts
    points[:, 1, :2] = ends
    return points
