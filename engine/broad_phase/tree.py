"""One bounding box tree: its tables, room in them, and whether it has degraded."""

from __future__ import annotations

from engine.broad_phase.tree_nodes import NODE, TREE, total_size
from engine.tables import empty

DEGRADED = 1.2
"""A tree is built anew when the boxes of its inner nodes, for each leaf, have grown by this factor since it was built.
Higher: lookups visit more nodes; 1: built at every check."""

CHECK_SHARE = 0.25  # part of the leaves that must have changed before the cost is looked at again
STALE_ROUNDS = 32  # built anew when every leaf has changed so often, whatever the cost: one infinite box hides it


class Tree:
    """The tables of one tree."""

    def __init__(self) -> None:
        self.nodes = empty(2, NODE)
        self.table = empty(1, TREE)
        self.table[0] = (0, 2, -1, 0, 0, 0.0)
        self.nodes["child"] = self.nodes["parent"] = -1
        self.in_order = True  # no leaf came or went since: children stand after their parents

    @property
    def count(self) -> int:
        return int(self.table["count"][0])

    def reserve(self, leaves: int) -> None:
        """Room for so many leaves: a pair of nodes each."""
        if len(self.nodes) < 2 * leaves:
            before, self.nodes = self.nodes, empty(4 * leaves, NODE)
            self.nodes[: len(before)] = before

    def is_degraded(self) -> bool:
        """Whether it should be built anew. Looks only now and then: the answer takes a walk over all nodes."""
        tree = self.table[0]
        if tree["changes"] - tree["checked"] < CHECK_SHARE * tree["count"] or tree["count"] < 2:
            return False
        self.table["checked"] = tree["changes"]
        return self.costs_more(total_size(self.nodes, self.table))

    def costs_more(self, total: float) -> bool:
        """Whether it should be built anew, by the sum of the half perimeters of its inner nodes [m]."""
        tree = self.table[0]
        if tree["changes"] > STALE_ROUNDS * tree["count"]:
            return True
        return bool(total > DEGRADED * tree["cost"] * tree["count"])
