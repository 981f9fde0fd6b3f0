"""The bounding boxes of a world's pieces, as the broad phase gets them."""

from __future__ import annotations

import numpy as np

from engine import World
from engine.stages import broad_phase, prepare_step
from tests.engine.worlds import DT


def bounds_of(world: World) -> np.ndarray:
    """(S, 4) lower x and y, upper x and y of every piece [m]."""
    prepare_step(world._state, world.settings, DT)
    broad_phase(world._state, world.settings)
    return world._state.bounds.T.astype(np.float64)
