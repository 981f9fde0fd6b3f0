"""What must hold for a dynamic tree at any time."""

from __future__ import annotations

import numpy as np

from engine.broad_phase.dynamic_tree import DynamicTree, Tree
from tests.naive.broad_phase import overlapping_pairs

BOX = ("lower_x", "lower_y", "upper_x", "upper_y")


def node_box(nodes: np.ndarray, i: int) -> np.ndarray:
    return np.array([nodes[name][i] for name in BOX])


def check_tree(tree: Tree, leaves: list[int], fat: np.ndarray, node_of: np.ndarray) -> None:
    """Boxes are those of their children, links point both ways, every leaf is there once, no node is lost."""
    nodes = tree.nodes
    assert tree.count == len(leaves)
    found, pairs, waiting = [], 0, [(0, -1)] if leaves else []
    while waiting:
        i, parent = waiting.pop()
        assert nodes["parent"][i] == parent
        child = int(nodes["child"][i])
        if child < 0:
            leaf = int(nodes["leaf"][i])
            found.append(leaf)
            assert node_of[leaf] == i
            assert (node_box(nodes, i) == fat[leaf]).all(), "a leaf's box is its fat box"
        else:
            assert child % 2 == 0
            assert child > 0
            pairs += 1
            a, b = node_box(nodes, child), node_box(nodes, child + 1)
            wrapped = np.concatenate([np.minimum(a[:2], b[:2]), np.maximum(a[2:], b[2:])])
            assert (node_box(nodes, i) == wrapped).all(), "a box fits around its children, exactly"
            waiting += [(child, i), (child + 1, i)]
    assert sorted(found) == leaves
    free = int(tree.table["free"][0])
    while free >= 0:
        assert nodes["child"][free] == nodes["child"][free + 1] == -1
        pairs += 1
        free = int(nodes["parent"][free])
    assert int(tree.table["top"][0]) == 2 + 2 * pairs, "nodes are in the tree or free"


def check(tree: DynamicTree, bounds: np.ndarray, groups: np.ndarray) -> None:
    """All of it, after an update with these tight boxes: (4, S) float32, in the order of the last sync."""
    fat = tree.fat_bounds()
    assert fat.shape == (bounds.shape[1], 4)
    assert (fat[:, :2] <= bounds[:2].T).all()
    assert (fat[:, 2:] >= bounds[2:].T).all()
    for which in range(2):
        leaves = np.flatnonzero((groups == 1) == which).tolist()
        check_tree(tree.trees[which], leaves, fat, tree._node_of)
    pairs = [tuple(pair) for pair in tree.pairs[: tree.pair_count].tolist()]
    expected = overlapping_pairs(fat.T, groups != 1)
    assert pairs == [(tree.rows[i], tree.rows[j]) for i, j in expected], "exactly the pairs of overlapping fat boxes"
