"""Which pairs of bodies may touch: one file a method, one line here.

A broad phase is `find_pairs(bounds, fixed, scratch, pairs) -> count`: pairs (capacity, 2) int64 of ranks, the lower
first, in ascending order: it is the order in which the solver visits the arbiters, and the same for every method. It
returns how many pairs there are, and has written them all unless that is more than the capacity.
"""

from __future__ import annotations

from engine.broad_phase import all_pairs

BROAD_PHASES = {"all_pairs": all_pairs.find_pairs}
