"""All pairs by blocks of eight, against comparing each with each; and which fat boxes have no margin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from engine.broad_phase import dynamic_tree
from engine.broad_phase.blocks import SIZE, Blocks, fill, find_all_keys, sort_keys
from engine.broad_phase.dynamic_tree import DynamicTree
from engine.broad_phase.tree_leaves import MARGIN_MAX
from engine.simd import WIDTH
from tests.naive.broad_phase import overlapping_pairs

pytestmark = pytest.mark.kernel

INFINITE = ((-np.inf, -np.inf, np.inf, np.inf), (0.0, -np.inf, np.inf, 0.0))


def random_boxes(rng: np.random.Generator, count: int, spread: int, infinite: int = 0) -> np.ndarray:
    """(4, count) corners at whole numbers, so that many boxes just touch."""
    lower = rng.integers(0, spread, (2, count))
    boxes = np.concatenate([lower, lower + rng.integers(0, 4, (2, count))]).astype(np.float32)
    for k in range(min(infinite, count)):
        boxes[:, int(rng.integers(count))] = INFINITE[k % 2]
    return boxes


def found_by_blocks(boxes: np.ndarray, fixed: np.ndarray, room: int) -> tuple[int, np.ndarray]:
    blocks = Blocks(boxes, np.flatnonzero(~fixed), np.flatnonzero(fixed))
    fill(boxes, blocks.leaves, blocks.above, blocks.boxes)
    keys = np.full(room + 3, -7, np.int64)
    number = find_all_keys(
        *(blocks.boxes, blocks.leaves, blocks.below, blocks.last, blocks.above, blocks.dynamic),
        *(blocks.stack, keys[:room]),
    )
    assert (keys[room:] == -7).all(), "nothing is written beyond the table"
    return number, keys


@settings(max_examples=100, deadline=None)
@given(
    count=st.one_of(st.sampled_from([0, 1, 7, 8, 9, 63, 64, 65]), st.integers(0, 150)),
    spread=st.integers(1, 60),
    fixed_share=st.sampled_from([0.0, 0.3, 1.0]),
    infinite=st.integers(0, 2),
    seed=st.integers(0, 2**32 - 1),
)
@example(count=520, spread=40, fixed_share=0.2, infinite=2, seed=1)  # three floors of blocks
def test_same_pairs_as_comparing_all(count, spread, fixed_share, infinite, seed) -> None:
    rng = np.random.default_rng(seed)
    boxes, fixed = random_boxes(rng, count, spread, infinite), rng.random(count) < fixed_share
    expected = overlapping_pairs(boxes, fixed)
    number, keys = found_by_blocks(boxes, fixed, len(expected) + WIDTH * WIDTH)
    assert number == len(expected)
    scratch = np.empty(number, np.int64)
    sort_keys(keys, number, np.empty(count, np.int64), scratch)
    assert [(int(key) >> 32, int(key) & 0xFFFFFFFF) for key in keys[:number]] == expected


def test_too_small_a_table_is_said() -> None:
    boxes = np.tile(np.array([[0], [0], [1], [1]], np.float32), 40)
    assert found_by_blocks(boxes, np.zeros(40, bool), 40 * 39 // 2 - 1)[0] == -1


@pytest.mark.parametrize("count", [1, 8, 9, 64, 65, 513])
def test_every_block_is_below_another_but_one(count: int) -> None:
    boxes = random_boxes(np.random.default_rng(count), count, 50)
    blocks = Blocks(boxes, np.arange(count), np.arange(0))
    assert sorted(blocks.leaves[blocks.leaves >= 0].tolist()) == list(range(count))
    fill(boxes, blocks.leaves, blocks.above, blocks.boxes)
    places = blocks.above[:-1]
    assert len(set(places.tolist())) == len(places)
    assert (places // SIZE > np.arange(len(places))).all(), "from below upwards"
    root = blocks.boxes[-SIZE:].reshape(4, WIDTH)
    assert (np.nanmin(root[:2], axis=1) == boxes[:2].min(axis=1)).all()
    assert (np.nanmax(root[2:], axis=1) == boxes[2:].max(axis=1)).all()


def test_eight_neighbours_share_a_block() -> None:
    """A tidy grid, created in no order: each block is a tile, 3 by 3 places at most."""
    rng = np.random.default_rng(0)
    places = rng.permutation(1024)
    lower = np.stack([places % 32, places // 32]).astype(np.float32)
    boxes = np.concatenate([lower, lower + np.float32(0.9)])
    tiles = Blocks(boxes, np.arange(1024), np.arange(0)).leaves.reshape(-1, WIDTH)
    widths = [np.ptp(lower[:, tile], axis=1).max() for tile in tiles]
    assert np.mean(widths) <= 4.0


# --- margins ----------------------------------------------------------------------------------------------------------


def moved_by(first: float, second: float) -> np.ndarray:
    """The margins (4,) of a unit box [m] that moves to the right twice."""
    tree = DynamicTree()
    tree.sync(np.arange(1), np.arange(1), np.ones(1, np.uint8))
    box = np.array([[0], [0], [1], [1]], np.float32)
    tree.update(box)
    for way in (first, second):
        box[[0, 2]] += np.float32(way)
        tree.update(box)
    fat = tree.fat_bounds()[0]
    return np.concatenate([box[:2, 0] - fat[:2], fat[2:] - box[2:, 0]])


def test_what_has_left_its_margin_slowly_gets_another() -> None:
    assert moved_by(0.0, 1.5 * float(MARGIN_MAX)) == pytest.approx(MARGIN_MAX, rel=1e-3)


def test_what_would_leave_its_margin_at_once_gets_none() -> None:
    assert (moved_by(0.0, 2.5 * float(MARGIN_MAX)) == 0).all()
    assert (moved_by(5.0, 1.5 * float(MARGIN_MAX)) == 0).all(), "it had none before: that far in one step"


def test_what_has_slowed_down_gets_a_margin_again() -> None:
    assert moved_by(5.0, 0.5 * float(MARGIN_MAX)) == pytest.approx(MARGIN_MAX, rel=1e-3)


# --- which way is taken -----------------------------------------------------------------------------------------------


def test_both_ways_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same history, with all pairs found anew at each step and with leaves looked up one by one."""
    histories = []
    for share in (-1.0, 2.0):
        monkeypatch.setattr(dynamic_tree, "CROWD_SHARE", share)
        rng = np.random.default_rng(4)
        tree = DynamicTree()
        boxes = random_boxes(rng, 90, 20)
        tree.sync(np.arange(90), np.arange(90), rng.integers(0, 3, 90).astype(np.uint8))
        history = []
        for _ in range(30):
            moving = rng.permutation(90)[: int(rng.integers(90))]
            boxes[:, moving] += np.tile(rng.normal(0, 0.2, (2, len(moving))), (2, 1)).astype(np.float32)
            history.append((tree.update(boxes), tree.pairs[: tree.pair_count].tolist(), tree.fat_bounds().tolist()))
        histories.append(history)
    assert histories[0] == histories[1]
