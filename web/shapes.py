"""What each kind of shape looks like: a dark rim with a lighter face on top, as unit meshes to be scaled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

DISC_CORNERS = 40
MARK_WIDTH = 0.07  # of the radius
MARK_LIFT = 2.0  # layers above the rim, hence above the face: Layer.MARK - Layer.RIM

Mesh = tuple[np.ndarray, np.ndarray]  # (V, 3) vertices, (F, 3) faces


@dataclass(frozen=True)
class ShapeLook:
    """How to draw one kind of shape. A new kind is one more entry in SHAPE_LOOKS."""

    rim: Mesh
    face: Mesh
    half_extents: Callable[[np.ndarray], np.ndarray]  # Frame.sizes (N, 2) -> scale of the unit meshes (N, 2) [m]


def square() -> Mesh:
    """From -1 to 1 in x and y."""
    vertices = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
    return vertices, np.array([(0, 1, 2), (0, 2, 3)], np.uint32)


def _disc() -> Mesh:
    turns = np.linspace(0.0, 2.0 * np.pi, DISC_CORNERS, endpoint=False)
    ring = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(DISC_CORNERS)])
    vertices = np.vstack([(0.0, 0.0, 0.0), ring]).astype(np.float32)
    first = np.arange(1, DISC_CORNERS + 1)
    return vertices, np.column_stack([np.zeros_like(first), first, np.roll(first, -1)]).astype(np.uint32)


def _marked_disc() -> Mesh:
    """A disc with a bar from the middle to the edge, without which one could not see a circle roll."""
    vertices, faces = _disc()
    bar, bar_faces = square()
    bar = bar * (0.49, MARK_WIDTH / 2, 1.0) + (0.49, 0.0, MARK_LIFT)
    return np.vstack([vertices, bar]).astype(np.float32), np.vstack([faces, bar_faces + len(vertices)])


SHAPE_LOOKS: dict[str, ShapeLook] = {
    "box": ShapeLook(square(), square(), lambda sizes: sizes / 2.0),
    "circle": ShapeLook(_marked_disc(), _disc(), lambda sizes: np.repeat(sizes[:, :1], 2, axis=1)),
}
