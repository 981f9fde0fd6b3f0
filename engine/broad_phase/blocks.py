"""All pairs at once, eight boxes at a time: what pays as soon as more than a few leaves have moved.

Leaves that are near each other stand in blocks of eight. The boxes of eight blocks are a block again, and so on up to
one. Each block of leaves is taken down from there, to those from itself on whose boxes it overlaps; there eight boxes
are compared with one. Every pair is found once.

A block is 32 numbers: eight lower x, eight lower y, eight upper x, eight upper y. What is not there is NaN, which
overlaps nothing.
"""

from __future__ import annotations

import math

import numpy as np

from engine.broad_phase.tree_nodes import HUGE
from engine.broad_phase.tree_pairs import RANK_BITS
from engine.jit import kernel
from engine.lanes import bits_of, eight_of
from engine.simd import WIDTH

SIDES = 4
SIZE = SIDES * WIDTH  # numbers of a block
LOWEST = np.array([(bits & -bits).bit_length() - 1 for bits in range(1 << WIDTH)])  # bit set in eight; -1: none


class Blocks:
    """Blocks of leaves, the dynamic ones first, and the blocks above them."""

    def __init__(self, fat: np.ndarray, dynamic: np.ndarray, others: np.ndarray) -> None:
        """Takes up leaves (N,) int64, and their boxes (4, S) float32 to see who is near whom."""
        parts = [np.append(_tiled(fat, part), np.full(-len(part) % WIDTH, -1)) for part in (dynamic, others)]
        self.leaves = np.concatenate(parts).astype(np.int64)  # (8 blocks,), -1: nothing
        self.dynamic = len(parts[0]) // WIDTH  # blocks of dynamic leaves
        self.below, self.last, self.above = _levels(len(self.leaves) // WIDTH)
        self.boxes = np.full(SIZE * len(self.above), np.nan, np.float32)
        self.stack = np.empty(WIDTH * len(self.above) + WIDTH, np.int64)


def _tiled(fat: np.ndarray, leaves: np.ndarray) -> np.ndarray:
    """Leaves in strips from left to right, and in each from bottom to top, so that each eight fill a tile.

    Source: S. Leutenegger et al., "STR: a simple and efficient algorithm for R-tree packing" (1997).
    """
    x, y = (np.maximum(fat[side], -HUGE) + np.minimum(fat[side + 2], HUGE) for side in range(2))
    blocks = -(-len(leaves) // WIDTH)
    strips = max(1, round(math.sqrt(blocks)))
    length = WIDTH * -(-blocks // strips)
    ordered = leaves[np.argsort(x[leaves], kind="stable")]
    heights = np.full(strips * length, np.inf, np.float32)
    heights[: len(ordered)] = y[ordered]
    upwards = np.argsort(heights.reshape(strips, length), axis=1, kind="stable")
    places = (upwards + length * np.arange(strips)[:, None]).ravel()
    return ordered[places[places < len(ordered)]]


def _levels(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How `count` blocks of leaves and those above them hang together: below, last, above, (blocks,) int64 each.

    Of a block of leaves `last` is its own number; of others, `below` is the first block under it, and `last` the
    last block of leaves. `above` is where its own box stands, the first of four numbers 8 apart; the root's is unused.
    """
    below, last = [np.full(count, -1)], [np.arange(count)]
    above: list[np.ndarray] = []
    first, number = 0, count
    while number > 1 or not above:
        upper = -(-number // WIDTH)
        above.append(SIZE * (first + number + np.arange(number) // WIDTH) + np.arange(number) % WIDTH)
        below.append(first + WIDTH * np.arange(upper))
        last.append(last[-1][np.minimum(WIDTH * np.arange(1, upper + 1), number) - 1])
        first, number = first + number, upper
    above.append(np.zeros(1, np.int64))
    more = np.full(WIDTH, -1)  # a last block of less than eight names some that are not there
    return np.concatenate(below), np.concatenate([*last, more]), np.concatenate(above)


@kernel
def fill(fat, leaves, above, boxes):
    """Writes the boxes of all blocks. fat (4, S) float32: boxes of the leaves."""
    for k in range(len(leaves)):
        leaf = leaves[k]
        if leaf >= 0:
            place = SIZE * (k // WIDTH) + k % WIDTH
            for side in range(SIDES):
                boxes[place + WIDTH * side] = fat[side, leaf]
    for block in range(len(above) - 1):
        for side in range(SIDES):
            begin = SIZE * block + WIDTH * side
            most = boxes[begin]  # a block's first is always there
            for k in range(begin + 1, begin + WIDTH):
                if (boxes[k] < most) if side < 2 else (boxes[k] > most):
                    most = boxes[k]
            boxes[above[block] + WIDTH * side] = most


@kernel
def overlaps(boxes, block, place):
    """Which boxes of a block overlap the one at a place: a bit each, the first the lowest."""
    left, bottom = boxes[place], boxes[place + WIDTH]
    right, top = boxes[place + 2 * WIDTH], boxes[place + 3 * WIDTH]
    begin = SIZE * block
    return bits_of(
        (eight_of(boxes, begin) <= right)
        & (eight_of(boxes, begin + WIDTH) <= top)
        & (eight_of(boxes, begin + 2 * WIDTH) >= left)
        & (eight_of(boxes, begin + 3 * WIDTH) >= bottom)
    )


@kernel
def meet(boxes, leaves, above, block, other, keys, found):
    """Writes the keys of the pairs of leaves of two blocks, or of one with itself; returns `found` plus their number.

    There must be room for 64.
    """
    near = overlaps(boxes, block, above[other])
    while near != 0:
        k = LOWEST[near]
        near &= near - 1
        bits = overlaps(boxes, other, SIZE * block + k)
        if block == other:
            bits &= -2 << k
        leaf = leaves[WIDTH * block + k]
        while bits != 0:
            second = leaves[WIDTH * other + LOWEST[bits]]
            bits &= bits - 1
            keys[found] = (min(leaf, second) << RANK_BITS) | max(leaf, second)
            found += 1
    return found


@kernel
def find_all_keys(boxes, leaves, below, last, above, dynamic, stack, keys):
    """Keys of all pairs of overlapping leaves of which one is of the first `dynamic` blocks, in no order.

    Returns their number, -1 if the table (capacity,) int64 is too small.
    """
    found = len(keys) * 0  # a literal would be a type of its own
    leaf_blocks = len(leaves) // WIDTH
    for block in range(dynamic):
        stack[0] = len(above) - 1
        waiting = 1
        while waiting > 0:
            waiting -= 1
            other = stack[waiting]
            if other >= leaf_blocks:
                near = overlaps(boxes, other, above[block])
                first = below[other]
                for lane in range(WIDTH):
                    stack[waiting] = first + lane
                    waiting += (near >> lane) & (last[first + lane] >= block)
            elif found + WIDTH * WIDTH > len(keys):
                return -1
            else:
                found = meet(boxes, leaves, above, block, other, keys, found)
    return found


@kernel
def sort_keys(keys, count, places, scratch):
    """Sorts keys: by the higher rank, then by the lower, which leaves those of one in order.

    places (S,) int64, scratch (at least count,) int64.
    """
    source, target = keys, scratch
    for turn in range(2):
        shift = turn * RANK_BITS
        places[:] = 0
        for k in range(count):
            places[(source[k] >> shift) & 0xFFFFFFFF] += 1
        total = count * 0  # typed, see above
        for rank in range(len(places)):
            number = places[rank]
            places[rank] = total
            total += number
        for k in range(count):
            key = source[k]
            rank = (key >> shift) & 0xFFFFFFFF
            target[places[rank]] = key
            places[rank] += 1
        source, target = target, source
