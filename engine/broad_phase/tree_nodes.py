"""The nodes of a bounding box tree: one leaf goes in, moves or comes out, and the tree stays good.

Siblings stand side by side, at an even index and the next: one cache line answers for both. Node 0 is the root, node 1
is never used. An inner node has `child`, the index of its first child; a leaf has child -1, and its number in `leaf`.
What a node holds (box, child, leaf) may move to another index; `parent` belongs to the index and stays. A way down for
the leaf that comes in keeps the tree fair; what it does not keep, a rebuild brings back.
"""

from __future__ import annotations

import numpy as np

from engine.jit import kernel

NODE = np.dtype(
    [
        ("lower_x", np.float32),  # box around all that is below [m]
        ("lower_y", np.float32),
        ("upper_x", np.float32),
        ("upper_y", np.float32),
        ("child", np.int32),  # index of the first of two children, the second is the next; -1: a leaf, or not in use
        ("leaf", np.int32),  # number of the leaf; -1: an inner node
        ("parent", np.int32),  # index; -1: the root. First of a free pair: that of the next free pair, or -1
        ("spare", np.int32),  # 32 bytes: two siblings fill a cache line
    ]
)

TREE = np.dtype(
    [
        ("count", np.int64),  # leaves
        ("top", np.int64),  # nodes from here on were never used
        ("free", np.int64),  # first pair of nodes that is free again, -1: none
        ("changes", np.int64),  # leaves put in, moved or taken out since the last rebuild
        ("checked", np.int64),  # `changes` when the cost was last looked at
        ("cost", np.float64),  # sum of the half perimeters of inner nodes after the last rebuild, for each leaf [m]
    ]
)
"""What holds for a whole tree: a table of one row."""

HUGE = np.float32(1e30)  # no side counts for more [m]: infinite boxes must not give inf - inf


@kernel
def side(length):
    return min(length, HUGE)


@kernel
def size(a):
    """Half the perimeter of a box [m]: how likely a random box meets it."""
    return side(a.upper_x - a.lower_x) + side(a.upper_y - a.lower_y)


@kernel
def joint_size(a, b):
    """Half the perimeter of the box around two."""
    width = max(a.upper_x, b.upper_x) - min(a.lower_x, b.lower_x)
    height = max(a.upper_y, b.upper_y) - min(a.lower_y, b.lower_y)
    return side(width) + side(height)


@kernel
def wrap(nodes, i):
    """Fits the box of an inner node around its children. Returns whether it was another one before."""
    node, a, b = nodes[i], nodes[nodes[i].child], nodes[nodes[i].child + 1]
    lower_x, lower_y = min(a.lower_x, b.lower_x), min(a.lower_y, b.lower_y)
    upper_x, upper_y = max(a.upper_x, b.upper_x), max(a.upper_y, b.upper_y)
    same = node.lower_x == lower_x and node.lower_y == lower_y and node.upper_x == upper_x and node.upper_y == upper_y
    node.lower_x, node.lower_y, node.upper_x, node.upper_y = lower_x, lower_y, upper_x, upper_y
    return not same


@kernel
def move(nodes, node_of, source, target):
    """Moves a node's content, and tells those who point at it: its children, or the list of leaves."""
    parent = nodes[target].parent
    nodes[target] = nodes[source]
    node = nodes[target]
    node.parent = parent
    if node.child >= 0:
        nodes[node.child].parent = target
        nodes[node.child + 1].parent = target
    else:
        node_of[node.leaf] = target


@kernel
def fit_above(nodes, i):
    """Fits the boxes above node i, as far up as they change."""
    i = nodes[i].parent
    while i >= 0 and wrap(nodes, i):
        i = nodes[i].parent


@kernel
def find_sibling(nodes, leaf_box):
    """The node beside which a new leaf adds least to the sum of all inner boxes, as a greedy way down finds it.

    A step down costs what the box passed grows by. It is taken while the lower of two bounds is below the price of
    staying: that of a leaf is exact, for an inner node the new box is at least as large as the leaf's.
    """
    i = 0
    own = size(leaf_box)
    while nodes[i].child >= 0:
        stay = joint_size(nodes[i], leaf_box)
        growth = stay - size(nodes[i])
        best, best_bound = -1, stay
        for child in range(nodes[i].child, nodes[i].child + 2):
            bound = joint_size(nodes[child], leaf_box)
            if nodes[child].child >= 0:
                bound = bound - size(nodes[child]) + own  # in this order: the first two may be huge
            if growth + bound < best_bound:
                best, best_bound = child, growth + bound
        if best < 0:
            break
        i = best
    return i


@kernel
def insert(nodes, trees, node_of, leaf, leaf_box):
    """Puts a leaf in. leaf_box: a node outside the tree with its box, child -1 and the leaf's number."""
    tree = trees[0]
    tree.count += 1
    place = 0
    if tree.count > 1:
        sibling = find_sibling(nodes, leaf_box)
        pair = tree.free
        if pair >= 0:
            tree.free = nodes[pair].parent
        else:
            pair = tree.top
            tree.top += 2
        move(nodes, node_of, sibling, pair)
        nodes[sibling].child, nodes[sibling].leaf = pair, -1
        nodes[pair].parent = nodes[pair + 1].parent = sibling
        place = pair + 1
    leaf_box.parent = nodes[place].parent
    nodes[place] = leaf_box
    node_of[leaf] = place
    fit_above(nodes, place)


@kernel
def remove(nodes, trees, node_of, leaf):
    """Takes a leaf out: its sibling takes the place of their parent."""
    tree = trees[0]
    tree.count -= 1
    place = node_of[leaf]
    node_of[leaf] = -1
    if place > 0:
        pair, parent = place & ~1, np.int64(nodes[place].parent)
        move(nodes, node_of, place ^ 1, parent)
        nodes[pair].child = nodes[pair + 1].child = -1
        nodes[pair].parent = tree.free
        tree.free = pair
        fit_above(nodes, parent)


@kernel
def total_size(nodes, trees):
    """Sum of the half perimeters of all inner nodes [m]: what looking up costs."""
    total = 0.0
    for i in range(trees[0].top):
        if nodes[i].child >= 0:
            total += size(nodes[i])
    return total
