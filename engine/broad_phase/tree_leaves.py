"""The leaves of the dynamic tree: which came, which went, which have left their fat boxes, and where they are put."""

from __future__ import annotations

import numpy as np

from engine.broad_phase.tree_nodes import fit_above, insert, remove
from engine.jit import kernel

MARGIN_MAX = np.float32(0.1)
"""A fat box is larger than the tight one by this on each side [m], for bodies of 1 m and more. Larger: more pairs that
do not touch; smaller: bodies leave their boxes more often."""

MARGIN_SHARE = np.float32(0.125)
"""... and for smaller bodies by this part of their longer side."""

MARGIN_RELATIVE = np.float32(2.0**-20)
"""... and by this part of the coordinate, 8 to 16 steps of float32: far from the origin 0.1 m would vanish."""

STATIC_GROUP, DYNAMIC_GROUP = 0, 1


@kernel
def match(old_rows, old_serials, old_pushed, rows, serials, pushed, now):
    """now[i] = rank of the old leaf i among the new ones, -1: gone. Both lists ascend by serial.

    A leaf is the same if its serial, its row and its tree are. Returns how many are gone.
    """
    gone = 0
    j = 0
    for i in range(len(old_serials)):
        while j < len(serials) and serials[j] < old_serials[i]:
            j += 1
        now[i] = -1
        if j < len(serials) and serials[j] == old_serials[i]:
            if rows[j] == old_rows[i] and pushed[j] == old_pushed[i]:
                now[i] = j
        gone += now[i] < 0
    return gone


@kernel
def carry_over(now, old_fat, old_node_of, old_pushed, fat, node_of, nodes0, nodes1):
    """Gives the leaves that stay their new rank. The others' boxes are empty, which no box is inside of."""
    fat[:2] = np.inf
    fat[2:] = -np.inf
    node_of[:] = -1
    for i in range(len(now)):
        j = now[i]
        if j >= 0:
            for k in range(4):
                fat[k, j] = old_fat[k, i]
            node_of[j] = old_node_of[i]
            if j != i and node_of[j] >= 0:
                if old_pushed[i] == 0:
                    nodes0[node_of[j]].leaf = j
                else:
                    nodes1[node_of[j]].leaf = j


@kernel
def mark_outside(bounds, fat, flags, leaves):
    """flags[i] = whether the tight box of leaf i is not inside its fat box. Returns how many are not.

    bounds, fat (4, S) float32; flags (S,) bool; leaves: not looked at, see below.
    """
    lower_x, lower_y, upper_x, upper_y = bounds[0], bounds[1], bounds[2], bounds[3]
    left, bottom, right, top = fat[0], fat[1], fat[2], fat[3]
    count = 0
    for i in range(len(flags)):
        inside = (lower_x[i] >= left[i]) & (lower_y[i] >= bottom[i]) & (upper_x[i] <= right[i]) & (upper_y[i] <= top[i])
        flags[i] = not inside
        count += not inside
    return count


@kernel
def mark_some_outside(bounds, fat, flags, leaves):
    """The same for these leaves (K,) int64; the others' flags stay as they are."""
    count = len(leaves) * 0  # a literal would be a type of its own
    for k in range(len(leaves)):
        i = leaves[k]
        inside = (bounds[0, i] >= fat[0, i]) & (bounds[1, i] >= fat[1, i])
        inside = inside & (bounds[2, i] <= fat[2, i]) & (bounds[3, i] <= fat[3, i])
        flags[i] = not inside
        count += not inside
    return count


@kernel
def outruns(bounds, fat, leaf, margin):
    """Whether a leaf has gone farther than its old margin and the new one together: in the next step, it will leave
    the new one as well.
    """
    for side in range(2):
        lower = fat[side, leaf] - bounds[side, leaf]  # how far the old box reached beyond the new
        upper = bounds[side + 2, leaf] - fat[side + 2, leaf]
        # half of their difference is how far it has gone, half of their sum the old margin, less than 0 where it turned
        if abs(upper - lower) + min(upper + lower, np.float32(0)) > 2 * margin:
            return True
    return False


@kernel
def fatten(bounds, fat, groups, moved):
    """New fat boxes for the leaves that have moved. No margin for what cannot move, and what would leave it at once."""
    for leaf in moved:
        longest = max(bounds[2, leaf] - bounds[0, leaf], bounds[3, leaf] - bounds[1, leaf])
        margin, relative = min(MARGIN_MAX, MARGIN_SHARE * longest), MARGIN_RELATIVE
        if groups[leaf] == STATIC_GROUP or (fat[0, leaf] <= fat[2, leaf] and outruns(bounds, fat, leaf, margin)):
            margin = relative = np.float32(0)
        for side in range(2):
            lower, upper = bounds[side, leaf], bounds[side + 2, leaf]
            fat[side, leaf] = lower - (margin + relative * abs(lower)) if relative > 0 else lower
            fat[side + 2, leaf] = upper + (margin + relative * abs(upper)) if relative > 0 else upper


@kernel
def place(nodes, trees, fat, node_of, moved, in_place, hand):
    """Takes the moved leaves of one tree to where they are now.

    in_place: a leaf stays where it stands in the tree, and the boxes above it are fitted; otherwise it is taken out and
    put in anew, which keeps the tree better and costs more. hand (1,): a node outside the tree.
    """
    trees[0].changes += len(moved)
    for leaf in moved:
        stays = in_place and node_of[leaf] >= 0
        node = nodes[node_of[leaf]] if stays else hand[0]
        node.lower_x, node.lower_y, node.upper_x, node.upper_y = fat[0, leaf], fat[1, leaf], fat[2, leaf], fat[3, leaf]
        if stays:
            fit_above(nodes, node_of[leaf])
        else:
            if node_of[leaf] >= 0:
                remove(nodes, trees, node_of, leaf)
            node.child, node.leaf = -1, leaf
            insert(nodes, trees, node_of, leaf, node)
