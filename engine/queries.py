"""Asking a world what is where."""

from __future__ import annotations

import numpy as np

from engine.shapes import SHAPES
from engine.state import State


def rows_at(state: State, x: float, y: float) -> np.ndarray:
    """Rows of the bodies that cover a point of the world [m], in the order of creation.

    Only + - * and comparison, so that every machine finds the same ones: a recorded grab must repeat.
    """
    bodies = state.bodies.gather("bodies")
    motions = state.bodies.gather("motions")
    c, s = motions["cosine"].astype(np.float64), motions["sine"].astype(np.float64)
    away_x, away_y = x - bodies["x"], y - bodies["y"]
    local_x, local_y = c * away_x + s * away_y, c * away_y - s * away_x
    covered = np.zeros(len(bodies), bool)
    with np.errstate(over="ignore"):  # a body that far away does not cover the point, whatever its square
        for kind, shape in enumerate(SHAPES):
            inside = shape.contains(local_x, local_y, bodies["half_x"], bodies["half_y"])
            covered |= (bodies["shape_kind"] == kind) & inside
    return state.bodies.order[covered]
