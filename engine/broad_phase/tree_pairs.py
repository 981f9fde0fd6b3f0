"""The pairs of the dynamic tree: those whose fat boxes overlap, found again for the leaves that have moved.

A pair is one integer, its key: the lower rank times 2^32, plus the higher. Ranks follow the order of creation, so
ascending keys are pairs in ascending order.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

RANK_BITS = 32
RANK_MASK = 2**RANK_BITS - 1


@kernel
def look_up(nodes, trees, fat, leaf, moved, stack, keys, found):
    """Writes the key of every leaf of a tree whose box overlaps that of `leaf`; returns `found` plus their number.

    A moved leaf with a lower rank is left out: it finds the pair itself. Keys beyond the table are only counted.
    """
    if trees[0].count == 0:
        return found
    left, bottom, right, top = fat[0, leaf], fat[1, leaf], fat[2, leaf], fat[3, leaf]
    first, waiting, last = 0, 0, 1  # the root has no sibling
    while True:
        for i in range(first, first + last):
            node = nodes[i]
            if node.lower_x <= right and node.upper_x >= left and node.lower_y <= top and node.upper_y >= bottom:
                if node.child >= 0:
                    stack[waiting] = node.child
                    waiting += 1
                elif node.leaf > leaf or (node.leaf < leaf and not moved[node.leaf]):
                    if found < len(keys):
                        keys[found] = (min(leaf, np.int64(node.leaf)) << RANK_BITS) | max(leaf, node.leaf)
                    found += 1
        if waiting == 0:
            return found
        waiting -= 1
        first, last = stack[waiting], 2


@kernel
def find_keys(nodes0, trees0, nodes1, trees1, fat, pushed, moved, flags, stack, keys):
    """Keys of all pairs of which a leaf has moved, in no order. Returns their number, which may exceed the table.

    Tree 0 holds what nothing pushes, tree 1 the dynamic ones: only these are looked up in both. moved (N,) int64:
    leaves; flags (S,) bool: those. stack (S + 2,) int64: scratch. keys (capacity,) int64.
    """
    found = len(moved) * 0  # a literal would be a type of its own
    for leaf in moved:
        if pushed[leaf] != 0:
            found = look_up(nodes0, trees0, fat, leaf, flags, stack, keys, found)
        found = look_up(nodes1, trees1, fat, leaf, flags, stack, keys, found)
    return found


@kernel
def merge(keys, count, found, flags, merged):
    """The pairs of which no leaf has moved and those found anew, in ascending order. Returns their number."""
    total = 0
    k = 0
    for i in range(count):
        key = keys[i]
        if not (flags[key >> RANK_BITS] or flags[key & RANK_MASK]):
            while k < len(found) and found[k] < key:
                merged[total] = found[k]
                k += 1
                total += 1
            merged[total] = key
            total += 1
    while k < len(found):
        merged[total] = found[k]
        k += 1
        total += 1
    return total


@kernel
def renumber(keys, count, now):
    """Gives the pairs the new ranks of their leaves, without those whose leaf is gone. Returns how many are left."""
    kept = 0
    for i in range(count):
        low, high = now[keys[i] >> RANK_BITS], now[keys[i] & RANK_MASK]
        if low >= 0 and high >= 0:
            keys[kept] = (low << RANK_BITS) | high
            kept += 1
    return kept


@kernel
def write_pairs(keys, count, rows, pairs):
    """The rows of the shapes of each pair."""
    for i in range(count):
        pairs[i, 0] = rows[keys[i] >> RANK_BITS]
        pairs[i, 1] = rows[keys[i] & RANK_MASK]
