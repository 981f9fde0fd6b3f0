"""The same scene as other solvers have it: the outlines of its bodies, in each solver's colour."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import viser

from engine import BODY_KINDS, SHAPE_KINDS
from sandbox.frame import Frame
from web.outlines import grown
from web.overlays.overlay import add_lines
from web.parts import Pieces
from web.polygons import corners_of
from web.stage import Layer, Stage
from web.theme import Colour

THICKNESS = 1.8  # pixels
ROUND_CORNERS = 24  # of a circle
ARC_POINTS = 5  # of a rounded corner
STATIC_BODY = BODY_KINDS.index("static")

_TURNS = np.linspace(0.0, 2.0 * np.pi, ROUND_CORNERS, endpoint=False)
_CIRCLE = np.column_stack([np.cos(_TURNS), np.sin(_TURNS)])
_SQUARE = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])


class Ghosts:
    """A node of lines for each of some solvers, made once."""

    def __init__(self, scene: viser.SceneApi, colours: Mapping[str, Colour]) -> None:
        self._lines = {
            name: add_lines(scene, f"/overlays/ghosts/{name}", colour, THICKNESS) for name, colour in colours.items()
        }
        self._drawn: set[str] = set()

    def draw(self, frames: Mapping[str, Frame], stage: Stage) -> None:
        """Shows these, and hides all others."""
        for name, node in self._lines.items():
            frame = frames.get(name)
            if frame is not None:
                node.points = at_height(outlines(stage.shifted(frame)), stage.z(Layer.GHOST))
            elif name in self._drawn:
                node.points = np.zeros((0, 2, 3), np.float32)
        self._drawn = set(frames)


def at_height(segments: np.ndarray, z: float) -> np.ndarray:
    """(K, 2, 3) float32 of (K, 2, 2)."""
    points = np.full((*segments.shape[:2], 3), z, np.float32)
    points[:, :, :2] = segments
    return points


def outlines(frame: Frame) -> np.ndarray:
    """(K, 2, 2) the edges of all pieces of bodies that are not static [m]; of a circle also a radius: it may turn."""
    moving = frame.body_kinds[frame.owners] != STATIC_BODY
    positions, angles = frame.shape_poses()
    found = [np.zeros((0, 2, 2))]
    for members, local in local_outlines(frame, moving):
        c, s = np.cos(angles[members])[:, None], np.sin(angles[members])[:, None]
        x, y = local[:, :, 0], local[:, :, 1]
        places = positions[members][:, None] + np.stack([c * x - s * y, s * x + c * y], axis=2)
        found.append(np.stack([places, np.roll(places, -1, axis=1)], axis=2).reshape(-1, 2, 2))
    return np.concatenate(found)


def local_outlines(frame: Frame, moving: np.ndarray) -> Iterable[tuple[np.ndarray, np.ndarray]]:
    """Pieces (n,) and their closed outlines (n, k, 2) in their own frames; moving (S,): which pieces are wanted."""

    def of(*names: str) -> np.ndarray:
        return np.flatnonzero(moving & np.isin(frame.shape_kinds, [SHAPE_KINDS.index(name) for name in names]))

    sizes = frame.sizes
    if len(boxes := of("box")):
        yield boxes, _SQUARE * (sizes[boxes, None] / 2.0)
    if len(circles := of("circle")):
        centre = np.zeros((1, 2))  # out along the radius and back
        yield circles, np.concatenate([centre, _CIRCLE, _CIRCLE[:1]])[None] * sizes[circles, None, :1]
    if len(lines := of("segment", "chain")):
        yield lines, np.array([(-0.5, 0.0), (0.5, 0.0)]) * sizes[lines, None, :1]
    for piece in of("capsule"):
        length, radius = sizes[piece]
        arc = _TURNS[: ROUND_CORNERS // 2 + 1] - np.pi / 2.0
        right = radius * np.column_stack([np.cos(arc), np.sin(arc)]) + (length / 2.0, 0.0)
        yield np.array([piece]), np.concatenate([right, -right])[None]
    for piece in of("polygon"):
        (corners,) = corners_of(Pieces(frame, np.array([piece]), 1.0))
        yield np.array([piece]), grown(corners, float(sizes[piece, 0]), ARC_POINTS)[None]
