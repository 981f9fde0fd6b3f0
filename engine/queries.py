"""Asking a world what is where."""

from __future__ import annotations

import numpy as np

from engine.shapes import SHAPES
from engine.state import State


def rows_at(state: State, x: float, y: float) -> np.ndarray:
    """Rows of the bodies that cover a point of the world [m], in the order of creation.

    Only + - * / and comparison, so that every machine finds the same ones: a recorded grab must repeat.
    """
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    shapes = state.shapes.gather("shapes")
    owner = shapes["body"]
    c, s = motions["cosine"][owner].astype(np.float64), motions["sine"][owner].astype(np.float64)
    away_x, away_y = x - bodies["x"][owner], y - bodies["y"][owner]
    body_x = c * away_x + s * away_y - shapes["local_x"]
    body_y = c * away_y - s * away_x - shapes["local_y"]
    c, s = shapes["local_cosine"], shapes["local_sine"]
    local_x, local_y = c * body_x + s * body_y, c * body_y - s * body_x
    covered = np.zeros(len(shapes), bool)
    with np.errstate(over="ignore"):  # a body that far away does not cover the point, whatever its square
        for kind in np.unique(shapes["kind"]):
            own = shapes["kind"] == kind
            hulls = state.hulls.tables["hulls"]
            covered[own] = SHAPES[kind].contains(local_x[own], local_y[own], shapes[own], hulls)
    order = state.bodies.order
    return order[np.isin(order, owner[covered])]
