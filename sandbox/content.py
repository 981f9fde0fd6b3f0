"""What there is in a world, as frames tell it: made when bodies or shapes came or went, and then kept."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine import World
from engine.shapes import SHAPES


class Content(NamedTuple):
    """Read-only arrays under the names that they have in sandbox.frame.Frame."""

    serials: np.ndarray
    body_kinds: np.ndarray
    shape_serials: np.ndarray
    owners: np.ndarray
    shape_kinds: np.ndarray
    sizes: np.ndarray
    places: np.ndarray
    corner_counts: np.ndarray
    corners: np.ndarray


class ContentKeeper:
    """Gives the same arrays as long as they hold, so that whoever compares two frames is soon done."""

    def __init__(self) -> None:
        self._number = -1
        self._kept: Content | None = None

    def content(self, world: World, number: int) -> Content:
        """Of the world as it is; another number makes it anew in any case."""
        bodies, shapes = world.body_records(), world.shape_records()
        kept = self._kept
        if (
            kept is None
            or number != self._number
            or not np.array_equal(bodies["serial"], kept.serials)
            or not np.array_equal(bodies["kind"], kept.body_kinds)
            or not np.array_equal(shapes["serial"], kept.shape_serials)
        ):
            self._number = number
            self._kept = kept = _content(world, bodies, shapes)
        return kept


def _content(world: World, bodies: np.ndarray, shapes: np.ndarray) -> Content:
    sizes = np.zeros((len(shapes), 2))
    for kind, shape in enumerate(SHAPES):
        own = shapes["kind"] == kind
        sizes[own, 0], sizes[own, 1] = shape.sizes(shapes[own])
    counts, corners = _corners(shapes, world.hull_records())
    rows = world._state.bodies.order
    index = np.zeros(rows.max(initial=-1) + 1, np.int64)
    index[rows] = np.arange(len(rows))
    content = Content(
        serials=bodies["serial"].copy(),
        body_kinds=bodies["kind"].astype(np.uint8),
        shape_serials=shapes["serial"].copy(),
        owners=index[shapes["body"]],
        shape_kinds=shapes["kind"].astype(np.uint8),
        sizes=sizes,
        places=np.column_stack([shapes["local_x"], shapes["local_y"], shapes["local_angle"]]),
        corner_counts=counts,
        corners=corners,
    )
    for array in content:
        array.flags.writeable = False
    return content


def _corners(shapes: np.ndarray, hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many corners each piece has, and all of them one after another, (sum, 2)."""
    counts = np.zeros(len(shapes), np.uint8)
    own = shapes["hull"] >= 0
    hull = hulls[shapes["hull"][own]]
    counts[own] = hull["count"]
    used = np.arange(hulls["x"].shape[1]) < hull["count"][:, None]
    return counts, np.column_stack([hull["x"][used], hull["y"][used]])
