"""Pairs of bodies that are joined and asked not to collide."""

from __future__ import annotations

from engine.jit import kernel


@kernel
def is_listed(listed, serial1, serial2):
    """Whether (serial1, serial2) is a row of `listed` (P, 2), which is in ascending order: binary search."""
    low = 0
    high = len(listed)
    while low < high:
        middle = (low + high) // 2
        first = listed[middle, 0]
        second = listed[middle, 1]
        if first < serial1 or (first == serial1 and second < serial2):
            low = middle + 1
        else:
            high = middle
    return low < len(listed) and listed[low, 0] == serial1 and listed[low, 1] == serial2


@kernel
def drop_ignored(pairs, count, order, bodies, ignored):
    """Takes the ignored pairs out of the first `count` pairs of ranks, keeping the order. Returns how many are left."""
    kept = 0
    for index in range(count):
        serial1 = bodies[order[pairs[index, 0]]].serial
        serial2 = bodies[order[pairs[index, 1]]].serial
        if not is_listed(ignored, serial1, serial2):
            pairs[kept, 0] = pairs[index, 0]
            pairs[kept, 1] = pairs[index, 1]
            kept += 1
    return kept
