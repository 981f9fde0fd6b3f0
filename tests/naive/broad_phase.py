"""Which bounding boxes overlap: every pair, compared one by one."""

from __future__ import annotations

import numpy as np


def overlapping_pairs(bounds: np.ndarray, fixed: np.ndarray) -> list[tuple[int, int]]:
    """Pairs i < j of columns of `bounds` (lower x and y, upper x and y) that share a point, less those both fixed."""
    count = bounds.shape[1]
    return [
        (i, j)
        for i in range(count)
        for j in range(i + 1, count)
        if not (fixed[i] and fixed[j])
        and max(bounds[0, i], bounds[0, j]) <= min(bounds[2, i], bounds[2, j])
        and max(bounds[1, i], bounds[1, j]) <= min(bounds[3, i], bounds[3, j])
    ]
