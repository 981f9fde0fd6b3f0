"""Rows that come and go: capacity growth, the order of creation, and serials that are never given twice.

A row's place may be used again; its serial may not. So a handle that remembers both knows when its row has been
destroyed, or destroyed and given to another, or brought back by a restored snapshot.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping

import numpy as np

from engine.tables import empty

SMALLEST_CAPACITY = 16


class Storage:
    """Parallel tables with one row a thing. The first table's dtype has the field `serial`."""

    def __init__(self, dtypes: Mapping[str, np.dtype]) -> None:
        self.tables = {name: empty(SMALLEST_CAPACITY, dtype) for name, dtype in dtypes.items()}
        self.main = next(iter(dtypes))
        self.next_serial = 0
        self.forget()

    def forget(self) -> None:
        """Empties the tables; serials go on."""
        self.tables[self.main]["serial"] = -1
        self._order = np.empty(0, np.int64)
        self._free: list[int] = []
        self._used = 0  # rows from here on were never used
        self._ascending = True  # whether rows stand in the order of creation

    @property
    def order(self) -> np.ndarray:
        """(N,) int64: rows in the order of creation."""
        return self._order

    @property
    def count(self) -> int:
        return len(self._order)

    @property
    def dense(self) -> bool:
        """Whether row k holds the k-th thing created: true while nothing was destroyed."""
        return self._used == len(self._order) and not self._free and self._ascending

    def add(self) -> int:
        """Takes a row, zeroed but for its serial, and returns its place."""
        if self._free:
            row = heapq.heappop(self._free)
        else:
            row = self._used
            self._used += 1
            self._reserve(self._used)
        for table in self.tables.values():
            table[row] = np.zeros((), table.dtype)
        self.tables[self.main]["serial"][row] = self.next_serial
        self.next_serial += 1
        self._ascending = self._ascending and row == len(self._order)
        self._order = np.append(self._order, row)
        return row

    def remove(self, row: int) -> None:
        """Gives a row back, with nothing left in it: what stood there may have been why it had to go."""
        for table in self.tables.values():
            table[row] = np.zeros((), table.dtype)
        self.tables[self.main]["serial"][row] = -1
        self._order = self._order[self._order != row]
        self._ascending = False
        heapq.heappush(self._free, row)

    def holds(self, row: int, serial: int) -> bool:
        """Whether the thing of this serial is in this row."""
        return row < self._used and int(self.tables[self.main]["serial"][row]) == serial

    def find(self, serial: int) -> int:
        """The row of a serial, -1 if there is none."""
        if serial < 0:
            return -1
        rows = np.flatnonzero(self.tables[self.main]["serial"][: self._used] == serial)
        return int(rows[0]) if len(rows) else -1

    def gather(self, table: str) -> np.ndarray:
        """A copy of a table's rows in the order of creation."""
        rows = self.tables[table]
        return np.array(rows[: self.count]) if self.dense else rows[self._order]

    def save(self) -> dict[str, np.ndarray]:
        """Copies of the rows in use, and the serial to come."""
        saved = {name: np.array(table[: self._used]) for name, table in self.tables.items()}
        saved["next_serial"] = np.array(self.next_serial, np.int64)
        return saved

    def load(self, saved: Mapping[str, np.ndarray]) -> None:
        """Takes the rows of `save` back. Serials never go back: handles made since stay invalid."""
        self.next_serial = max(self.next_serial, int(saved["next_serial"]))
        self.forget()
        self._used = len(saved[self.main])
        self._reserve(self._used)
        for name, table in self.tables.items():
            table[: self._used] = saved[name]
        serials = self.tables[self.main]["serial"][: self._used]
        rows = np.flatnonzero(serials >= 0)
        self._order = rows[np.argsort(serials[rows])]
        self._ascending = bool(np.all(self._order == np.arange(len(rows))))
        self._free = [int(row) for row in np.flatnonzero(serials < 0)]  # ascending, so already a heap

    def _reserve(self, count: int) -> None:
        capacity = len(self.tables[self.main])
        if count <= capacity:
            return
        while capacity < count:
            capacity *= 2
        for name, table in self.tables.items():
            larger = empty(capacity, table.dtype)
            larger[: len(table)] = table
            self.tables[name] = larger
        self.tables[self.main]["serial"][self._used :] = -1
