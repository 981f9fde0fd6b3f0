"""Eight numbers as tables that kernels of either width can read, and comparison bit by bit."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st

from engine.rows import wide
from engine.simd import WIDTH
from engine.tables import empty

REALS = (np.float32, np.float64)


def floats(real: type) -> st.SearchStrategy:
    """Eight floats of every kind: infinite, NaN, subnormal, zeros of either sign."""
    kinds = st.floats(width=np.finfo(real).bits) | st.sampled_from([0.0, -0.0, 1.0, np.nan, np.inf, -np.inf])
    return st.lists(kinds, min_size=WIDTH, max_size=WIDTH).map(lambda numbers: np.array(numbers, real))


def bits(numbers: Any) -> bytes:
    """The bits of numbers, those of every NaN being the same: IEEE 754 does not say which NaN comes out."""
    numbers = np.array(numbers)
    if numbers.dtype.kind == "f":
        numbers[np.isnan(numbers)] = np.nan
    return numbers.tobytes()


def as_rows(columns: dict[str, np.ndarray]) -> np.ndarray:
    """A table of eight rows with those columns."""
    table = empty(WIDTH, np.dtype([(name, column.dtype) for name, column in columns.items()]))
    for name, column in columns.items():
        table[name] = column
    return table


def as_block(columns: dict[str, np.ndarray]) -> np.ndarray:
    """A table of one row, of eight-lane fields."""
    rows = as_rows(columns)
    table = empty(1, wide(rows.dtype))
    for name in rows.dtype.names or ():
        table[name][0] = rows[name]
    return table
