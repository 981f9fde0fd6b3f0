"""What the benchmark scenes share: how far something has got that should have stayed, and rows of places."""

from __future__ import annotations

import numpy as np

from engine import World
from engine.constants import SLOP
from sandbox.scenes.parts import GRAVITY, Predict


def outside(world: World, first: int, bounds: tuple[float, float, float, float]) -> float:
    """The farthest that bodies from number `first` on are outside of (lower x, y, upper x, y) [m]; < 0: none is."""
    places = world.positions[first:]
    low, high = np.array(bounds[:2]), np.array(bounds[2:])
    return float(max((low - places).max(), (places - high).max()))


def farthest(world: World, first: int, x: float, y: float) -> float:
    """The farthest that bodies from number `first` on are from a point [m]."""
    return float(np.hypot(*(world.positions[first:] - (x, y)).T).max())


def one_steps_fall(after: float) -> Predict:
    """How deep a body that has fallen for so long [s] gets into what it meets in a step; and what is left alone."""
    return lambda world, dt: GRAVITY * after * dt + SLOP


def overlap(world: World) -> float:
    """The deepest of all contacts [m]."""
    return world.diagnostics().max_penetration


def pyramid_places(base: int, x: float, y: float) -> np.ndarray:
    """(base (base + 1) / 2, 2) centres of unit boxes in a pyramid on (x, y), the middle of its foot, row by row [m]."""
    rows = [np.stack([x + np.arange(n) - 0.5 * (n - 1), np.full(n, y + base - n + 0.5)], axis=1)
            for n in range(base, 0, -1)]  # fmt: skip
    return np.concatenate(rows)


def grid_places(columns: int, rows: int, x: float, y: float, dx: float, dy: float) -> np.ndarray:
    """(columns rows, 2) places from (x, y) on, column by column [m]."""
    across, up = np.meshgrid(x + dx * np.arange(columns), y + dy * np.arange(rows), indexing="ij")
    return np.stack([across.ravel(), up.ravel()], axis=1)
