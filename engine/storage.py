"""Rows that come and go: capacity growth, the order of creation, and serials that are never given twice.

The last row of a table is never given to anything: it stands for nobody where eight rows are worked on at once.

A column is a table that need not be there: it holds what few things have, such as restitution, and exists only while
some thing departs from the default.

A row's place may be used again; its serial may not. So a handle that remembers both knows when its row has been
destroyed, or destroyed and given to another, or brought back by a restored snapshot.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from engine.tables import empty

SMALLEST_CAPACITY = 16


class Column(NamedTuple):
    """What a column holds where nobody has said anything."""

    dtype: np.dtype
    default: float


class Storage:
    """Parallel tables with one row a thing. The first table's dtype has the field `serial`."""

    def __init__(self, dtypes: Mapping[str, np.dtype], possible: Mapping[str, Column] | None = None) -> None:
        self.possible = dict(possible or {})
        self.columns: dict[str, np.ndarray] = {}
        self.tables = {name: empty(SMALLEST_CAPACITY, dtype) for name, dtype in dtypes.items()}
        self.main = next(iter(dtypes))
        self.next_serial = 0
        self.forget()

    def forget(self) -> None:
        """Empties the tables; serials go on."""
        self.tables[self.main]["serial"] = -1
        self.columns = {}
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
        return int(self.add_many(1)[0])

    def add_many(self, count: int) -> np.ndarray:
        """Takes rows, zeroed but for their serials, and returns their places in the order of their serials."""
        reused = [heapq.heappop(self._free) for _ in range(min(count, len(self._free)))]
        fresh = np.arange(self._used, self._used + count - len(reused))
        rows = np.concatenate([np.array(reused, np.int64), fresh])
        self._used += len(fresh)
        self._reserve(self._used)
        self._clear(rows)
        self.tables[self.main]["serial"][rows] = np.arange(self.next_serial, self.next_serial + count)
        self.next_serial += count
        self._ascending = self._ascending and np.array_equal(rows, np.arange(self.count, self.count + count))
        self._order = np.concatenate([self._order, rows])
        return rows

    def remove(self, row: int) -> None:
        """Gives a row back, with nothing left in it: what stood there may have been why it had to go."""
        self._clear(np.array([row]))
        self.tables[self.main]["serial"][row] = -1
        self._order = self._order[self._order != row]
        self._ascending = False
        heapq.heappush(self._free, row)

    def _clear(self, rows: np.ndarray) -> None:
        for table in self.tables.values():
            table[rows] = np.zeros((), table.dtype)
        for name, values in self.columns.items():
            values[rows] = self.possible[name].default

    def get(self, name: str, row: int) -> Any:
        """A column's value for a row, there or not."""
        column = self.possible[name]
        values = self.columns.get(name)
        return column.dtype.type(column.default).item() if values is None else values[row].item()

    def put(self, name: str, rows: Any, value: Any) -> None:
        """Writes into a column, which comes into being where the value is not the default."""
        column = self.possible[name]
        if name not in self.columns:
            if np.all(np.asarray(value, column.dtype) == column.default):
                return
            self.ensure(name)
        self.columns[name][rows] = value

    def ensure(self, name: str) -> np.ndarray:
        """A column, made if it is not there."""
        if name not in self.columns:
            column = self.possible[name]
            self.columns[name] = np.full(len(self.tables[self.main]), column.default, column.dtype)
        return self.columns[name]

    def drop_idle_columns(self) -> None:
        """Lets go of columns in which nothing departs from the default."""
        for name in [name for name in self.columns if not self.departing(name)]:
            del self.columns[name]

    def departing(self, name: str) -> int:
        """How many things depart from a column's default."""
        values = self.columns.get(name)
        return 0 if values is None else int(np.count_nonzero(values[self._order] != self.possible[name].default))

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
        """Copies of the rows in use, of columns in which something departs from the default, and the serial to come."""
        saved = {name: np.array(table[: self._used]) for name, table in self.tables.items()}
        departing = [name for name in self.columns if self.departing(name)]
        saved |= {name: np.array(self.columns[name][: self._used]) for name in departing}
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
        for name in self.possible:
            if name in saved:
                self.put(name, slice(0, self._used), saved[name])
        serials = self.tables[self.main]["serial"][: self._used]
        rows = np.flatnonzero(serials >= 0)
        self._order = rows[np.argsort(serials[rows])]
        self._ascending = bool(np.all(self._order == np.arange(len(rows))))
        self._free = [int(row) for row in np.flatnonzero(serials < 0)]  # ascending, so already a heap

    def _reserve(self, count: int) -> None:
        capacity = len(self.tables[self.main])
        if count < capacity:
            return
        while capacity <= count:
            capacity *= 2
        for name, table in self.tables.items():
            larger = empty(capacity, table.dtype)
            larger[: len(table)] = table
            self.tables[name] = larger
        for name, values in self.columns.items():
            longer = np.full(capacity, self.possible[name].default, values.dtype)
            longer[: len(values)] = values
            self.columns[name] = longer
        self.tables[self.main]["serial"][self._used :] = -1
