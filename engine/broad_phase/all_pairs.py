"""The talk's broad phase: every body against every later one, "horribly slow O(N^2)".

It compares bounding boxes only, one body against all later ones in a loop that the compiler turns into vector
instructions, so that the horrible N^2 is about a third of a nanosecond a pair.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

WORD = 8  # flags that are looked at together, as one integer


@kernel
def mark_overlaps(bounds, i, first, flags):
    """flags[j] = whether the bounding boxes of i and j overlap, for all j >= first."""
    left, bottom, right, top = bounds[0, i], bounds[1, i], bounds[2, i], bounds[3, i]
    # slices that start at zero: only so does the compiler see that no index is negative, and vectorise
    lower_x, lower_y, upper_x, upper_y = bounds[0, first:], bounds[1, first:], bounds[2, first:], bounds[3, first:]
    marked = flags[first:]
    for j in range(len(lower_x)):
        apart = (lower_x[j] > right) | (upper_x[j] < left) | (lower_y[j] > top) | (upper_y[j] < bottom)
        marked[j] = not apart


@kernel
def find_pairs(bounds, fixed, flags, pairs):
    """Pairs of ranks whose bounding boxes overlap, in ascending order (i, j), i < j.

    bounds (4, N) float32: lower x and y, upper x and y. fixed (N,) uint8: 1 for a body that cannot move; two such
    never meet. flags: (M,) uint8 of scratch, M the next multiple of 8 from N. pairs (capacity, 2) int64.
    Returns the number of pairs; where that is more than the capacity, the rest were counted but not written.
    """
    count = 0
    n = len(fixed)
    words = flags.view(np.uint64)
    flags[n:] = 0
    for i in range(n - 1):
        first_word = (i + 1) // WORD
        mark_overlaps(bounds, i, first_word * WORD, flags)
        flags[first_word * WORD : i + 1] = 0
        for word in range(first_word, len(words)):
            if words[word] != 0:
                for j in range(word * WORD, word * WORD + WORD):
                    if flags[j] != 0 and not (fixed[i] != 0 and fixed[j] != 0):
                        if count < len(pairs):
                            pairs[count, 0] = i
                            pairs[count, 1] = j
                        count += 1
    return count


class AllPairs:
    """The talk's broad phase as the step uses it; see broad_phase/__init__.py."""

    def __init__(self) -> None:
        self.pairs = np.empty((0, 2), np.int64)
        self.pair_count = 0
        self._rows = np.empty(0, np.int64)

    def sync(self, rows: np.ndarray, serials: np.ndarray, groups: np.ndarray) -> None:
        """Takes up shapes."""
        self._rows = np.array(rows)
        self._fixed = (groups != 1).astype(np.uint8)
        self._flags = np.zeros((len(rows) + WORD - 1) // WORD * WORD, np.uint8)
        self._ranks = np.empty((16, 2), np.int64)
        self._count = -1

    def update(self, bounds: np.ndarray, ranks: np.ndarray | None = None) -> bool:
        """Compares all with all, whatever has changed."""
        self._bounds = bounds
        ranks = np.empty_like(self._ranks)
        count = find_pairs(bounds, self._fixed, self._flags, ranks)
        if count > len(ranks):
            ranks = np.empty((count + count // 2, 2), np.int64)
            count = find_pairs(bounds, self._fixed, self._flags, ranks)
        same = count == self._count and np.array_equal(ranks[:count], self._ranks[:count])
        self._ranks, self._count = ranks, count
        if not same:
            self.pairs = self._rows[ranks[:count]]
            self.pair_count = count
        return not same

    def fat_bounds(self) -> np.ndarray:
        """(S, 4) float32: the boxes that were compared."""
        return np.ascontiguousarray(self._bounds.T)
