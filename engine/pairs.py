"""Which pairs of near shapes become arbiters: those that a collider knows, of two bodies that may collide."""

from __future__ import annotations

from engine.jit import kernel


@kernel
def may_touch(shape1, shape2, colliders):
    """Whether two shapes are of two bodies, and some collider knows their kinds: none knows two segments, say.

    colliders (K, K) int32: by the kinds of the two shapes which collider it is, -1 for none.
    """
    return shape1.body != shape2.body and colliders[shape1.kind, shape2.kind] >= 0


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
def drop_joined(pairs, count, shapes, bodies, joined):
    """Takes out pairs of bodies joined without colliding: joined (P, 2) serials, ascending, the lower first."""
    kept = 0
    for index in range(count):
        a = bodies[shapes[pairs[index, 0]].body].serial
        b = bodies[shapes[pairs[index, 1]].body].serial
        if not is_listed(joined, min(a, b), max(a, b)):
            pairs[kept, 0] = pairs[index, 0]
            pairs[kept, 1] = pairs[index, 1]
            kept += 1
    return kept
