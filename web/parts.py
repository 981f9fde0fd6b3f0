"""What pictures of shapes are put together from: a few unit meshes, each drawn many times over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sandbox.frame import Frame
from web.stage import Layer
from web.theme import RIM_TONE

DISC_CORNERS = 40
MARK_WIDTH = 0.07  # of the radius
MARK_LIFT = Layer.MARK - Layer.RIM  # layers above the rim, hence above the face
RIM_WIDTH = 0.0045  # of the view's height
RIM_SHARE = 0.22  # at most this part of a shape's smaller half extent, so that small ones keep a face


class Mesh(NamedTuple):
    """A flat mesh."""

    name: str  # as long as it is used, no other mesh has it
    vertices: np.ndarray  # (V, 3) float32
    faces: np.ndarray  # (F, 3) uint32


@dataclass(frozen=True)
class Pieces:
    """All pieces of one kind in a frame, K of them."""

    frame: Frame
    members: np.ndarray  # (K,) their indices in the frame
    view_height: float  # m, of the stage: lines are as thick as the eye needs

    @property
    def sizes(self) -> np.ndarray:
        """(K, 2) [m]"""
        return self.frame.sizes[self.members]

    def rim(self, half_extents: np.ndarray) -> np.ndarray:
        """(K,) width of the rims of pieces that reach so far from their middle [m]."""
        return np.minimum(RIM_WIDTH * self.view_height, RIM_SHARE * half_extents)


@dataclass(frozen=True)
class Part:
    """One mesh, drawn once for each of K pieces, in their own frames: first scaled, then moved."""

    mesh: Mesh
    layer: Layer
    tone: float  # against the body's colour: darker below 1
    pieces: np.ndarray  # (K,) indices in the frame
    scales: np.ndarray  # (K, 2)
    offsets: np.ndarray  # (K, 2) [m]


@dataclass(frozen=True)
class Loose:
    """Pieces of which hardly two look the same: one mesh of them all, whose vertices follow the pieces."""

    layer: Layer
    tone: float
    vertices: np.ndarray  # (V, 2) each in its piece's own frame [m]
    pieces: np.ndarray  # (V,) index of the piece
    faces: np.ndarray  # (F, 3) uint32


def rimmed(rim: Mesh, face: Mesh, pieces: Pieces, half_extents: np.ndarray) -> tuple[Part, Part]:
    """A dark mesh of these half extents (K, 2), and a lighter one on top of it that leaves a rim."""
    members, middle = pieces.members, np.zeros_like(half_extents)
    inner = half_extents - pieces.rim(half_extents.min(axis=1))[:, None]
    return (
        Part(rim, Layer.RIM, RIM_TONE, members, half_extents, middle),
        Part(face, Layer.FACE, 1.0, members, inner, middle),
    )


def square_corners() -> tuple[np.ndarray, np.ndarray]:
    """From -1 to 1 in x and y: vertices and faces."""
    vertices = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
    return vertices, np.array([(0, 1, 2), (0, 2, 3)], np.uint32)


def fan(outline: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A convex outline (V, 2) as vertices and faces."""
    vertices = np.zeros((len(outline), 3), np.float32)
    vertices[:, :2] = outline
    second = np.arange(1, len(outline) - 1)
    return vertices, np.column_stack([np.zeros_like(second), second, second + 1]).astype(np.uint32)


def _disc() -> tuple[np.ndarray, np.ndarray]:
    turns = np.linspace(0.0, 2.0 * np.pi, DISC_CORNERS, endpoint=False)
    return fan(np.column_stack([np.cos(turns), np.sin(turns)]))


def _marked_disc() -> tuple[np.ndarray, np.ndarray]:
    """A disc with a bar from the middle to the edge, without which one could not see a circle roll."""
    vertices, faces = _disc()
    bar, bar_faces = square_corners()
    bar = bar * (0.49, MARK_WIDTH / 2, 1.0) + (0.49, 0.0, MARK_LIFT)
    return np.vstack([vertices, bar]).astype(np.float32), np.vstack([faces, bar_faces + len(vertices)])


SQUARE = Mesh("square", *square_corners())  # from -1 to 1
DISC = Mesh("disc", *_disc())  # of radius 1
MARKED_DISC = Mesh("marked_disc", *_marked_disc())
WEDGE = Mesh("wedge", *fan(np.array([(0, 0), (0, -1), (1, -1)])))  # half of what a mitre adds
