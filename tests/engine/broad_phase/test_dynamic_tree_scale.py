"""The dynamic tree with many leaves: how much it does, and that it stays a good tree."""

from __future__ import annotations

import numpy as np
import pytest

from engine.broad_phase import all_pairs, dynamic_tree
from engine.broad_phase.dynamic_tree import DynamicTree
from engine.broad_phase.tree import DEGRADED, Tree
from engine.broad_phase.tree_build import middle
from engine.broad_phase.tree_nodes import total_size


def pile(count: int, seed: int = 0) -> np.ndarray:
    """Boxes of about 1 m in a square, most of them touching their neighbours: (4, count)."""
    rng = np.random.default_rng(seed)
    width = int(np.sqrt(count))
    centers = np.stack([np.arange(count) % width, np.arange(count) // width]) + rng.uniform(-0.05, 0.05, (2, count))
    halves = rng.uniform(0.4, 0.55, (2, count))
    return np.concatenate([centers - halves, centers + halves]).astype(np.float32)


def made(bounds: np.ndarray, groups: np.ndarray) -> DynamicTree:
    tree = DynamicTree()
    numbers = np.arange(bounds.shape[1])
    tree.sync(numbers, numbers, groups)
    tree.update(bounds)
    return tree


def pairs_of_all(bounds: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """What all_pairs says of these boxes: ranks."""
    scratch = np.empty((len(groups) + 7) // 8 * 8, np.uint8)
    pairs = np.empty((40 * len(groups), 2), np.int64)
    return pairs[: all_pairs.find_pairs(bounds, (groups != 1).astype(np.uint8), scratch, pairs)]


def depth(tree: Tree) -> int:
    deepest, waiting = 0, [(0, 1)]
    while waiting:
        i, level = waiting.pop()
        deepest = max(deepest, level)
        child = int(tree.nodes["child"][i])
        if child >= 0:
            waiting += [(child, level + 1), (child + 1, level + 1)]
    return deepest


def cost(tree: Tree) -> float:
    return total_size(tree.nodes, tree.table) / tree.count


@pytest.mark.parametrize("speed", [0.3, 5.0, 100.0])
def test_same_pairs_as_all_pairs_on_the_fat_boxes(speed: float) -> None:
    """3,000 boxes fly about: for each speed another way to keep the tree up to date."""
    rng = np.random.default_rng(1)
    bounds = pile(3000)
    groups = rng.choice([0, 1, 1, 1, 2], 3000).astype(np.uint8)
    tree = made(bounds, groups)
    velocities = rng.normal(0, speed / 60, (2, 3000)).astype(np.float32) * (groups != 0)
    for _ in range(20):
        bounds += np.tile(velocities, (2, 1))
        tree.update(bounds)
        assert np.array_equal(tree.pairs[: tree.pair_count], pairs_of_all(tree.fat_bounds().T.copy(), groups))


def test_one_more_piece_leaves_all_others_where_they_are() -> None:
    bounds, groups = pile(5000), np.ones(5000, np.uint8)
    tree = made(bounds, groups)
    fat = tree.fat_bounds()
    nodes = tree.trees[1].nodes.copy()
    numbers = np.arange(5001)
    bounds = np.concatenate([bounds, bounds[:, 2500:2501] + np.float32(0.3)], axis=1)
    tree.sync(numbers, numbers, np.ones(5001, np.uint8))
    assert tree.update(bounds)
    assert (tree.fat_bounds()[:5000] == fat).all()
    touched = np.count_nonzero(tree.trees[1].nodes[: len(nodes)] != nodes)
    assert touched < 60, "the way down to its place, and no more"


def test_settled_pieces_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    bounds = pile(500)
    tree = made(bounds, np.ones(500, np.uint8))

    def never(*arguments: object) -> None:
        raise AssertionError("nothing has left its fat box")

    for name in ("fatten", "place", "build", "find_keys", "merge", "write_pairs"):
        monkeypatch.setattr(dynamic_tree, name, never)
    assert not tree.update(bounds + np.float32(0.02))
    with pytest.raises(AssertionError):
        tree.update(bounds + np.float32(0.2))


def test_put_in_one_by_one_it_stays_shallow_enough() -> None:
    """The worst order for a tree: a row of boxes from left to right."""
    bounds = np.zeros((4, 400), np.float32)
    bounds[2:] = 1
    bounds[[0, 2]] += np.arange(400, dtype=np.float32)
    tree = DynamicTree()
    for count in range(1, 401):
        numbers = np.arange(count)
        tree.sync(numbers, numbers, np.zeros(count, np.uint8))
        tree.update(np.ascontiguousarray(bounds[:, :count]))
    static = tree.trees[0]
    before = cost(static)
    assert depth(static) < 150, "400 if it were never built anew"
    tree._build(0)
    assert depth(static) < 13
    assert before < 2.5 * cost(static)


def test_an_infinite_box_does_not_spoil_the_tree_for_others() -> None:
    bounds = pile(400)
    bounds[:, 0] = [-np.inf, -np.inf, np.inf, 0]
    tree = DynamicTree()
    for count in range(20, 401, 2):
        numbers = np.arange(count)
        tree.sync(numbers, numbers, np.zeros(count, np.uint8))
        tree.update(np.ascontiguousarray(bounds[:, :count]))
    assert depth(tree.trees[0]) < 60


@pytest.mark.parametrize(("lower", "upper"), [(-np.inf, np.inf), (0, np.inf), (-np.inf, 0), (1, 2)])
def test_every_box_has_a_middle(lower: float, upper: float) -> None:
    assert np.isfinite(middle(np.float32(lower), np.float32(upper)))


def test_it_is_built_anew_when_it_has_degraded() -> None:
    """Boxes of a pile mix: the tree's cost stays within its factor of a new one's, times the drift between checks."""
    rng = np.random.default_rng(2)
    bounds = pile(1000)
    tree = made(bounds, np.ones(1000, np.uint8))
    for _ in range(60):
        bounds += np.tile(rng.normal(0, 0.4, (2, 1000)), (2, 1)).astype(np.float32)
        tree.update(bounds)
        kept = cost(tree.trees[1])
        twin = made(bounds, np.ones(1000, np.uint8))
        assert kept < 1.5 * DEGRADED * cost(twin.trees[1])
