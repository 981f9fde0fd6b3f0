"""Which pairs of shapes may touch: one file a method, one line here.

A broad phase is an object that keeps pairs up to date:

- `sync(rows, serials, groups)` when content changed: rows (S,) int64 of the shapes in the order of creation, their
  serials, and groups (S,) uint8: 0 cannot move, 1 dynamic, 2 kinematic. Only pairs with a dynamic one count.
- `update(bounds, ranks) -> bool`: bounds (4, S) float32 in the order of `rows`; ranks of those that may have changed,
  None: all; whether the pairs changed.
- `pairs` (capacity, 2) int64 of rows, of which the first `pair_count` count: the one created first comes first, and
  they ascend. It is the order in which solvers visit arbiters, and the same for every method. Every two whose bounds
  overlap are among them; more may be.
- `fat_bounds()` (S, 4) float32: the boxes that it works with, to look at.
"""

from __future__ import annotations

from engine.broad_phase.all_pairs import AllPairs
from engine.broad_phase.dynamic_tree import DynamicTree

BROAD_PHASES: dict[str, type[AllPairs] | type[DynamicTree]] = {"dynamic_tree": DynamicTree, "all_pairs": AllPairs}
