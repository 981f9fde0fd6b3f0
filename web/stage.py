"""Where the picture is: the part of the world to show, and the layers in which things lie on top of each other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from sandbox.frame import Frame

FAR_AWAY = 1000.0  # m from the origin; beyond it the browser's single precision would show as jitter
LAYER_GAP = 0.002  # of the view's height: more than the depth buffer's grain, less than the eye sees


class Layer(IntEnum):
    """From the bottom up. The pick plane lies at 0, where a click is worth exact world coordinates; all else is above,
    so that the line which viser itself draws there during a drag stays out of sight.
    """

    BACKDROP = 1
    GRID = 2
    RIM = 3
    FACE = 4
    MARK = 5  # the radius on a circle; part of the rim's mesh
    BOUNDS = 6
    JOINT = 7
    NORMAL = 8
    IMPULSE = 9
    CONTACT = 10
    HIT = 11
    GHOST = 12
    HAND = 13


@dataclass(frozen=True)
class Stage:
    """The view of one scene. What is drawn is relative to `origin`, so that a far scene is as sharp as a near one."""

    center_x: float  # m
    center_y: float  # m
    height: float  # m

    @property
    def origin(self) -> tuple[float, float]:
        """The world's point that is drawn at the browser's origin [m]."""
        is_far = max(abs(self.center_x), abs(self.center_y)) > FAR_AWAY
        return (self.center_x, self.center_y) if is_far else (0.0, 0.0)

    @property
    def gap(self) -> float:
        """Distance from one layer to the next [m]."""
        return LAYER_GAP * self.height

    def z(self, layer: Layer) -> float:
        return layer * self.gap

    def shifted(self, frame: Frame) -> Frame:
        """The frame relative to `origin`."""
        x, y = self.origin
        if x == 0.0 and y == 0.0:
            return frame
        contacts, joints = frame.contacts.copy(), frame.joints.copy()
        for records, names in ((contacts, "x"), (joints, "x1 x2")):
            for name in names.split():
                records[name] -= x
        for records, names in ((contacts, "y"), (joints, "y1 y2")):
            for name in names.split():
                records[name] -= y
        bounds = frame.bounds.astype(np.float64) - (x, y, x, y)
        hits = frame.events.hit.copy()
        hits["x"] -= x
        hits["y"] -= y
        return replace(
            frame, positions=frame.positions - (x, y), bounds=bounds, contacts=contacts, joints=joints,
            events=frame.events._replace(hit=hits),
        )  # fmt: skip
