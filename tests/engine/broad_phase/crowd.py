"""Pieces that come, go and move at random, and a dynamic tree that must keep up with them."""

from __future__ import annotations

import json

import numpy as np

from engine.broad_phase.dynamic_tree import DynamicTree
from tests.engine.broad_phase.tree_check import check
from tests.naive.broad_phase import overlapping_pairs

STATIC, DYNAMIC, KINEMATIC = range(3)
ACTIONS = ("spawn", "destroy", "drift", "teleport", "regroup", "fly_away")


class Crowd:
    """Pieces that come, go and move, with rows used again as the engine does; and a tree that must keep up."""

    def __init__(self, seed: int, spread: float) -> None:
        self.rng = np.random.default_rng(seed)
        self.spread = spread
        self.tree = DynamicTree()
        self.rows = np.empty(0, np.int64)
        self.serials = np.empty(0, np.int64)
        self.groups = np.empty(0, np.uint8)
        self.centers = np.empty((2, 0))
        self.halves = np.empty((2, 0))
        self.free: list[int] = []
        self.next_row = self.next_serial = 0

    @property
    def count(self) -> int:
        return len(self.rows)

    @property
    def bounds(self) -> np.ndarray:
        return np.concatenate([self.centers - self.halves, self.centers + self.halves]).astype(np.float32)

    def spawn(self, number: int) -> None:
        for _ in range(number):
            if not self.free:
                self.free.append(self.next_row)
                self.next_row += 3  # not every row is a piece of this tree
            row = self.free.pop(int(self.rng.integers(len(self.free))))
            self.rows = np.append(self.rows, row)
            self.serials = np.append(self.serials, self.next_serial)
            self.next_serial += int(self.rng.integers(1, 3))
        self.groups = np.append(self.groups, self.rng.choice([0, 1, 1, 1, 2], number).astype(np.uint8))
        self.centers = np.append(self.centers, self.rng.uniform(0, self.spread, (2, number)), 1)
        self.halves = np.append(self.halves, self.rng.uniform(0, 1, (2, number)) ** 2, 1)

    def destroy(self, number: int) -> None:
        gone = self.chosen(number)
        self.free += self.rows[gone].tolist()
        keep = np.setdiff1d(np.arange(self.count), gone)
        self.rows, self.serials, self.groups = self.rows[keep], self.serials[keep], self.groups[keep]
        self.centers, self.halves = self.centers[:, keep], self.halves[:, keep]

    def chosen(self, number: int) -> np.ndarray:
        return self.rng.permutation(self.count)[:number]

    def drift(self, number: int) -> None:
        chosen = self.chosen(number)
        self.centers[:, chosen] += self.rng.normal(0, 0.15, (2, len(chosen)))

    def teleport(self, number: int) -> None:
        chosen = self.chosen(number)
        self.centers[:, chosen] = self.rng.uniform(0, self.spread, (2, len(chosen)))

    def regroup(self, number: int) -> None:
        chosen = self.chosen(number)
        self.groups[chosen] = self.rng.integers(0, 3, len(chosen))

    def fly_away(self, number: int) -> None:
        self.centers += self.rng.choice([-1e5, 0.0, 1e5], (2, 1))

    def sync(self) -> None:
        self.tree.sync(self.rows, self.serials, self.groups)

    def row_pairs(self) -> list[tuple[int, int]]:
        return [tuple(pair) for pair in self.tree.pairs[: self.tree.pair_count].tolist()]

    def act(self, action: str, number: int) -> None:
        """Does one of ACTIONS to so many pieces and tells the tree: of content only if it has changed."""
        getattr(self, action)(number)
        if action in ("spawn", "destroy", "regroup"):
            self.sync()
        self.step()

    def step(self) -> None:
        """Updates and compares with every truth there is."""
        before = self.row_pairs()
        assert len(set(before)) == len(before)
        changed = self.tree.update(self.bounds)
        check(self.tree, self.bounds, self.groups)
        pairs = self.row_pairs()
        rank = {row: i for i, row in enumerate(self.rows.tolist())}
        ranks = [(rank[a], rank[b]) for a, b in pairs]
        assert ranks == sorted(set(ranks)), "ascending, none twice"
        assert all(a < b for a, b in ranks), "the piece created first comes first"
        tight = overlapping_pairs(self.bounds, self.groups != DYNAMIC)
        assert set(tight) <= set(ranks), "whatever overlaps is there"
        assert changed or pairs == before
        assert not self.tree.update(self.bounds), "nothing has moved since"


def history() -> list:
    """Pairs and fat boxes after each step of a fixed history, to be compared between ways to run it."""
    crowd = Crowd(seed=3, spread=6.0)
    seen = []
    for action in ("spawn", "drift", "teleport", "destroy", "spawn", "regroup", "fly_away", "drift"):
        crowd.act(action, 20)
        seen.append([crowd.row_pairs(), crowd.tree.fat_bounds().tobytes().hex()])
    return seen


if __name__ == "__main__":
    print(json.dumps(history()))
