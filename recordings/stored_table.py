"""A table as it came out of a file: all rows in one array, and where each step's begin."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from recordings.rrd import Chunk
from recordings.schema import STEP_TIMELINE, RecordingError, Table


class StoredTable(NamedTuple):
    """K entries in the order of their steps."""

    steps: np.ndarray  # (K,) int64, increasing
    starts: np.ndarray  # (K + 1,) int64, where each step's rows begin
    rows: np.ndarray  # of the table's dtype, read-only

    def at(self, step: int) -> np.ndarray:
        """The rows of the last entry up to a step; none before the first entry."""
        entry = int(np.searchsorted(self.steps, step, side="right")) - 1
        return self.rows[self.starts[entry] : self.starts[entry + 1]] if entry >= 0 else self.rows[:0]

    def exactly(self, step: int) -> np.ndarray:
        """The rows of that step's own entry; none if it has none."""
        entry = int(np.searchsorted(self.steps, step))
        there = entry < len(self.steps) and self.steps[entry] == step
        return self.rows[self.starts[entry] : self.starts[entry + 1]] if there else self.rows[:0]

    def first(self, count: int) -> StoredTable:
        """The same table with its first entries only."""
        return StoredTable(self.steps[:count], self.starts[: count + 1], self.rows[: self.starts[count]])


def gather(path: Path, table: Table, chunks: list[Chunk]) -> StoredTable:
    """Puts the chunks of one table together.

    Raises:
        RecordingError: a column is missing or has another type, or a step is there twice.
    """
    try:
        parts = sorted((_decode(table, chunk.batch) for chunk in chunks), key=lambda part: _first_step(part.steps))
    except (KeyError, ValueError, pa.ArrowException) as error:
        raise RecordingError(f"{path}: damaged in {table.path}") from error
    steps = np.concatenate([np.empty(0, np.int64), *(part.steps for part in parts)])
    if np.any(np.diff(steps) <= 0):
        raise RecordingError(f"{path}: damaged: steps out of order in {table.path}")
    lengths = np.concatenate([np.empty(0, np.int64), *(np.diff(part.starts) for part in parts)])
    rows = np.concatenate([np.empty(0, table.dtype), *(part.rows for part in parts)])
    rows.flags.writeable = False
    return StoredTable(steps, np.concatenate([[0], np.cumsum(lengths)]), rows)


def _decode(table: Table, batch: pa.RecordBatch) -> StoredTable:
    """One chunk's share of the table."""
    names = table.dtype.names or ()
    steps = batch.column(STEP_TIMELINE).to_numpy(zero_copy_only=False)
    if steps.dtype != np.int64:
        raise ValueError("steps must be whole numbers")
    rows = np.empty(0, table.dtype)
    starts = np.zeros(len(steps) + 1, np.int64)
    for index, name in enumerate(names):
        lists = batch.column(table.component(name))
        values = lists.flatten().to_numpy()
        bounds = lists.offsets.to_numpy().astype(np.int64)
        if values.dtype != table.dtype[name]:
            raise ValueError(f"{name} has another type")
        if index == 0:
            starts = bounds - bounds[0]
            rows = np.empty(len(values), table.dtype)
        elif not np.array_equal(starts, bounds - bounds[0]):
            raise ValueError(f"{name} has other rows")
        rows[name] = values
    return StoredTable(steps, starts, rows)


def _first_step(steps: np.ndarray) -> int:
    return int(steps[0]) if len(steps) else 0
