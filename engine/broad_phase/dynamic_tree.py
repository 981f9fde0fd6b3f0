"""The dynamic tree: which pairs of pieces may touch, for thousands of bodies.

Every piece has a fat box, larger than its own by a margin. As long as it stays inside, nothing is done for it. When it
leaves, it gets a new fat box and is looked up in two trees of boxes: one of what nothing pushes (static and kinematic),
one of dynamic bodies. Where many leave at once, all pairs are found anew instead, see blocks.py. The pairs are exactly
those whose fat boxes overlap, one of them dynamic: they follow from the fat boxes alone, whatever the trees look like.
So a snapshot needs the fat boxes and nothing else of this.
"""

from __future__ import annotations

import numpy as np

from engine.broad_phase.blocks import Blocks, fill, find_all_keys, sort_keys
from engine.broad_phase.tree import Tree
from engine.broad_phase.tree_build import build, fit
from engine.broad_phase.tree_leaves import (
    DYNAMIC_GROUP,
    carry_over,
    fatten,
    mark_outside,
    mark_some_outside,
    match,
    place,
)
from engine.broad_phase.tree_nodes import NODE, remove
from engine.broad_phase.tree_pairs import find_keys, merge, renumber, write_pairs
from engine.tables import empty

REBUILD_SHARE = 0.25  # part of the leaves new or gone at once from which building anew is cheaper than one by one
IN_PLACE_SHARE = 0.01  # part of the leaves moved at once from which they stay where they are in the tree, see `place`
CROWD_SHARE = 0.06  # part of the leaves moved at once from which all pairs are found anew, see blocks.py

NOBODY = np.empty(0, np.int64)


class DynamicTree:
    """Rows of pieces and their boxes go in, pairs of rows come out.

    pairs (capacity, 2) int64, valid up to pair_count: rows of the SHAPE table, the one created first first, in
    ascending order of the two serials.
    """

    def __init__(self) -> None:
        self.trees = (Tree(), Tree())  # what nothing pushes, and the dynamic ones
        self.pairs = np.empty((0, 2), np.int64)
        self.pair_count = 0
        self.rows = self.serials = np.empty(0, np.int64)
        self._groups = self._pushed = np.empty(0, np.uint8)
        self._fat = np.empty((4, 0), np.float32)
        self._node_of = np.empty(0, np.int64)  # where a leaf stands in its tree; -1: not there yet
        self._keys = np.empty(16, np.int64)  # of the pairs, see tree_pairs.py
        self._merged = np.empty(16, np.int64)
        self._found = np.empty(16, np.int64)
        self._flags = np.empty(0, np.bool_)
        self._stack = np.empty((2, 3), np.int64)
        self._hand = empty(1, NODE)
        self._blocks: Blocks | None = None  # of all leaves; None: to be made anew
        self._changed = False
        self._ranks: np.ndarray | None = None  # of the boxes that the last update looked at

    def sync(self, rows: np.ndarray, serials: np.ndarray, groups: np.ndarray) -> None:
        """Takes over which pieces there are: rows, serials (S,) int64, ascending by serial, and groups (S,) uint8.

        groups: 0 cannot move, 1 dynamic, 2 kinematic. A piece is the same as before if its serial, its row and whether
        it is dynamic are; then it keeps its fat box. Pairs of those that are gone are dropped.
        """
        rows, serials, groups = np.array(rows, np.int64), np.array(serials, np.int64), np.array(groups, np.uint8)
        pushed = (groups == DYNAMIC_GROUP).astype(np.uint8)
        now = np.empty(len(self.rows), np.int64)
        gone = match(self.rows, self.serials, self._pushed, rows, serials, pushed, now)
        rebuild = self._remove_gone(np.flatnonzero(now < 0)) if gone else []
        fat, node_of = np.empty((4, len(rows)), np.float32), np.empty(len(rows), np.int64)
        carry_over(now, self._fat, self._node_of, self._pushed, fat, node_of, self.trees[0].nodes, self.trees[1].nodes)
        self.rows, self.serials, self._groups, self._pushed = rows, serials, groups, pushed
        self._fat, self._node_of = fat, node_of
        self._flags = np.empty(len(rows), np.bool_)
        self._ranks = None
        self._stack = np.empty((len(rows) + 2, 3), np.int64)
        for which in rebuild:
            self._build(which)
        if gone or len(now) < len(rows):
            self._blocks = None
            self.trees[0].in_order = self.trees[1].in_order = False
        if gone or (len(now) > 0 and now[-1] != len(now) - 1):  # ranks have changed
            kept = renumber(self._keys, self.pair_count, now)
            self._changed |= kept != self.pair_count
            self.pair_count = kept
            write_pairs(self._keys, kept, rows, self.pairs)

    def update(self, bounds: np.ndarray, ranks: np.ndarray | None = None) -> bool:
        """Finds the pairs for these tight boxes, (4, S) float32 in the order of `rows`. Returns whether they changed.

        Each pair whose tight boxes overlap, one of them dynamic, is there; so is each that has not parted yet.
        ranks: of the boxes that may have changed since the last update, None: all.
        """
        if bounds.shape != self._fat.shape:
            raise ValueError(f"bounds of shape {bounds.shape} for {len(self.rows)} pieces")
        bounds = np.ascontiguousarray(bounds, np.float32)
        if ranks is None:
            outside = mark_outside(bounds, self._fat, self._flags, NOBODY)
        else:
            if ranks is not self._ranks:  # flags of others are those of an earlier update
                self._flags[:] = False
            outside = mark_some_outside(bounds, self._fat, self._flags, ranks)
        self._ranks = ranks
        if outside:
            moved = np.flatnonzero(self._flags)
            fatten(bounds, self._fat, self._groups, moved)
            self._follow(moved)
        changed, self._changed = self._changed, False
        return changed

    def restore(self, rows: np.ndarray, serials: np.ndarray, groups: np.ndarray, fat: np.ndarray) -> None:
        """Begins anew with the fat boxes of a snapshot, (S, 4) as `fat_bounds` gave them.

        The pairs are those of the snapshot; the next update says whether they change from there.
        """
        self.__init__()  # type: ignore[misc]
        self.sync(rows, serials, groups)
        self._fat[:] = fat.T
        self._flags[:] = True
        self._follow(np.arange(len(self.rows)))
        self._changed = False

    def borders(self) -> tuple[np.ndarray, np.ndarray]:
        """What `mark_outside` takes beside the tight boxes: the fat ones, (4, S), and room for flags, until a sync."""
        return self._fat, self._flags

    def fat_bounds(self) -> np.ndarray:
        """A copy of the fat boxes, (S, 4) float32 in the order of `rows`: lower x, lower y, upper x, upper y [m]."""
        return np.ascontiguousarray(self._fat.T)

    def _remove_gone(self, gone: np.ndarray) -> list[int]:
        """Takes leaves out of the trees. Returns those that are better built anew, which it leaves as they are."""
        rebuild = []
        for which, tree in enumerate(self.trees):
            leaves = gone[self._pushed[gone] == which]
            if len(leaves) > REBUILD_SHARE * tree.count:
                rebuild.append(which)
            else:
                for leaf in leaves[self._node_of[leaves] >= 0]:
                    remove(tree.nodes, tree.table, self._node_of, leaf)
                tree.table["changes"] += len(leaves)
        return rebuild

    def _follow(self, moved: np.ndarray) -> None:
        """Brings trees and pairs up to date with the fat boxes of the leaves that have moved."""
        pushed = self._pushed[moved] != 0
        crowd = len(moved) > CROWD_SHARE * len(self.rows)
        for which, leaves in enumerate((moved[~pushed], moved[pushed])):
            if crowd:
                self._fit(which, leaves)
            elif len(leaves) > 0:
                self._place(which, leaves)
        if crowd:
            self._find_all_pairs()
        else:
            self._find_pairs(moved)

    def _fit(self, which: int, moved: np.ndarray) -> None:
        """Brings one tree up to date, and in order, of which many leaves have moved."""
        tree = self.trees[which]
        if not tree.in_order:
            self._build(which)
        elif len(moved) > 0:
            if tree.costs_more(fit(tree.nodes, tree.table, self._fat, self._node_of, moved)):
                self._build(which)

    def _place(self, which: int, moved: np.ndarray) -> None:
        """Brings one tree up to date."""
        tree = self.trees[which]
        new = int(np.count_nonzero(self._node_of[moved] < 0))
        if new > REBUILD_SHARE * tree.count:
            self._build(which)
            return
        tree.reserve(tree.count + new)
        in_place = len(moved) > IN_PLACE_SHARE * tree.count
        if new or not in_place:
            tree.in_order = False
        place(tree.nodes, tree.table, self._fat, self._node_of, moved, in_place, self._hand)
        if tree.is_degraded():
            self._build(which)

    def _build(self, which: int) -> None:
        """Builds one tree anew, of all leaves that have a box."""
        tree = self.trees[which]
        leaves = np.flatnonzero((self._pushed == which) & (self._fat[0] <= self._fat[2]))
        tree.reserve(len(leaves))
        build(tree.nodes, tree.table, self._fat, self._node_of, leaves, self._stack)
        tree.in_order = True
        self._blocks = None

    def _find_all_pairs(self) -> None:
        """Finds all pairs anew."""
        if self._blocks is None:
            leaves = (np.flatnonzero(self._pushed == which) for which in (1, 0))
            self._blocks = Blocks(self._fat, *leaves)
        blocks = self._blocks
        fill(self._fat, blocks.leaves, blocks.above, blocks.boxes)
        while True:
            number = find_all_keys(
                *(blocks.boxes, blocks.leaves, blocks.below, blocks.last, blocks.above, blocks.dynamic),
                *(blocks.stack, self._found),
            )
            if number >= 0:
                break
            self._found = np.empty(max(2 * len(self._found), 1024), np.int64)
        if len(self._merged) < number:
            self._merged = np.empty(2 * number, np.int64)
        sort_keys(self._found, number, np.empty(len(self.rows), np.int64), self._merged)
        self._merged, self._found = self._found, self._merged
        self._take_keys(number)

    def _find_pairs(self, moved: np.ndarray) -> None:
        """Looks the moved leaves up and merges what they meet with the pairs of all others."""
        static, dynamic = self.trees
        stack = self._stack.reshape(-1)
        if len(self._found) < 8 * len(moved):
            self._found = np.empty(8 * len(moved), np.int64)
        while True:
            number = find_keys(
                *(static.nodes, static.table, dynamic.nodes, dynamic.table, self._fat, self._pushed),
                *(moved, self._flags, stack, self._found),
            )
            if number <= len(self._found):
                break
            self._found = np.empty(2 * number, np.int64)
        found = self._found[:number]
        found.sort(kind="stable")  # most of them are in order: one leaf after the other was looked up
        if len(self._merged) < self.pair_count + number:
            self._merged = np.empty(2 * (self.pair_count + number), np.int64)
        self._take_keys(merge(self._keys, self.pair_count, found, self._flags, self._merged))

    def _take_keys(self, total: int) -> None:
        """Makes the pairs those of the keys in `_merged`."""
        if not np.array_equal(self._keys[: self.pair_count], self._merged[:total]):
            self._keys, self._merged, self.pair_count = self._merged, self._keys, total
            self._changed = True
            if len(self.pairs) < total:
                self.pairs = np.empty((2 * total, 2), np.int64)
            write_pairs(self._keys, total, self.rows, self.pairs)
