"""In which order the joints of an island are eliminated, and where the blocks of the system are.

The one that is coupled to the fewest is next (least degree), as W. F. Tinney and J. W. Walker do for networks (Proc.
IEEE 55, 1967): from the ends of chains inwards, so that these fill in nothing. Made when content changes.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np

from engine.tables import empty

COUPLING = np.dtype(
    [
        ("block", np.int64),
        ("row", np.int64),  # the joint that comes later in the order, by its place in it
        ("column", np.int64),  # the earlier one
        ("row_side", np.int64),  # which of its bodies they share: 0 or 1
        ("column_side", np.int64),
    ]
)
UPDATE = np.dtype(
    [
        ("left", np.int64),  # block of L
        ("right", np.int64),  # block as it was before
        ("target", np.int64),  # the block that changes, or the diagonal one
        ("on_diagonal", np.int64),  # 1: that of a joint
    ]
)
COLUMN = np.dtype([("first", np.int64), ("update", np.int64)])
"""The first block below the diagonal of each column, and the first update that eliminating it brings."""

ISLAND = np.dtype([(name, np.int64) for name in ("first", "last", "first_coupling", "last_coupling")])


class Order(NamedTuple):
    """The order of one island's joints, and which later ones each is coupled to when it is eliminated."""

    order: list[int]
    below: list[list[int]]

    @property
    def blocks(self) -> int:
        return sum(map(len, self.below))


def least_degree(neighbours: dict[int, set[int]], most_blocks: int) -> Order | None:
    """The order; None if there would be more blocks than that."""
    neighbours = {joint: set(others) for joint, others in neighbours.items()}
    waiting = [(len(others), joint) for joint, others in neighbours.items()]
    heapq.heapify(waiting)
    order, below, blocks = [], [], 0
    while waiting:
        degree, joint = heapq.heappop(waiting)
        if joint not in neighbours or degree != len(neighbours[joint]):
            continue
        others = neighbours.pop(joint)
        order.append(joint)
        below.append(sorted(others))
        blocks += len(others)
        if blocks > most_blocks:
            return None
        for other in others:
            neighbours[other] |= others
            neighbours[other] -= {joint, other}
            heapq.heappush(waiting, (len(neighbours[other]), other))
    return Order(order, below)


class Plan(NamedTuple):
    """Lists that the kernels follow; joints are numbered by their place in `order`."""

    order: np.ndarray  # (n,) int64 rows of the joints, island after island
    islands: np.ndarray  # ISLAND
    couplings: np.ndarray  # COUPLING
    columns: np.ndarray  # (n + 1,) COLUMN
    places: np.ndarray  # (blocks,) int64: the row of each block
    updates: np.ndarray  # UPDATE


def make_plan(islands: list[Order], bodies: np.ndarray, moves: np.ndarray) -> Plan:
    """bodies (joints, 2): rows of the bodies of every joint; moves (bodies,) bool: whether an impulse moves it."""
    order: list[int] = []
    ranges: list[tuple] = []
    couplings: list[tuple] = []
    columns: list[tuple] = []
    updates: list[tuple] = []
    places: list[int] = []
    for island in islands:
        first, first_coupling = len(order), len(couplings)
        place = {joint: first + k for k, joint in enumerate(island.order)}
        blocks: dict[tuple[int, int], int] = {}
        starts = []
        for joint, below in zip(island.order, island.below, strict=True):
            starts.append(len(places))
            for row in sorted(place[other] for other in below):
                blocks[row, place[joint]] = len(places)
                places.append(row)
        for k, (joint, below) in enumerate(zip(island.order, island.below, strict=True)):
            column = place[joint]
            columns.append((starts[k], len(updates)))
            rows = sorted(place[other] for other in below)
            for a, right in enumerate(rows):
                updates.append((blocks[right, column], blocks[right, column], right, 1))
                updates += [
                    (blocks[row, column], blocks[right, column], blocks[row, right], 0) for row in rows[a + 1 :]
                ]
        couplings += _couplings(island, place, blocks, bodies, moves)
        order += island.order
        ranges.append((first, len(order), first_coupling, len(couplings)))
    columns.append((len(places), len(updates)))
    return Plan(
        np.array(order, np.int64), _table(ranges, ISLAND), _table(couplings, COUPLING), _table(columns, COLUMN),
        np.array(places, np.int64), _table(updates, UPDATE),
    )  # fmt: skip


def _table(rows: list[tuple], dtype: np.dtype) -> np.ndarray:
    table = empty(len(rows), dtype)
    table[:] = np.array(rows, dtype)
    return table


def _couplings(
    island: Order, place: dict[int, int], blocks: dict[tuple[int, int], int], bodies: np.ndarray, moves: np.ndarray
) -> list[tuple[int, int, int, int, int]]:
    """Which blocks get something from which body."""
    found = []
    at_body: dict[int, list[tuple[int, int]]] = {}
    for joint in island.order:
        for side in (0, 1):
            body = int(bodies[joint, side])
            if not moves[body]:
                continue
            for other, other_side in at_body.get(body, ()):
                row, column = place[joint], place[other]
                if row > column:
                    found.append((blocks[row, column], row, column, side, other_side))
                else:
                    found.append((blocks[column, row], column, row, other_side, side))
            at_body.setdefault(body, []).append((joint, side))
    return found
