"""From numpy arrays to rerun's component columns, exact and without guessing types."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import rerun as rr

from recordings.schema import STEP_TIMELINE, TIME_TIMELINE, Table


class Sheet(NamedTuple):
    """Rows of one entity, ready to be sent."""

    path: str
    times: list[rr.TimeColumn]
    columns: list[rr.ComponentColumn]


class _Batch:
    """A component batch whose arrow array is already there.

    rerun's own `AnyBatchValue` infers a type from the first value it sees, and drops a column that starts out empty.
    """

    def __init__(self, descriptor: rr.ComponentDescriptor, array: pa.Array) -> None:
        self._descriptor = descriptor
        self._array = array

    def component_descriptor(self) -> rr.ComponentDescriptor:
        return self._descriptor

    def as_arrow_array(self) -> pa.Array:
        return self._array


def column(component: str, array: pa.Array, lengths: np.ndarray) -> rr.ComponentColumn:
    """A column named `archetype:field`, cut into rows of the given lengths, (K,)."""
    archetype = component.partition(":")[0]
    descriptor = rr.ComponentDescriptor(component=component, archetype=archetype)
    return rr.ComponentColumn(descriptor, _Batch(descriptor, array), lengths=lengths)


def batch(component: str, array: pa.Array) -> rr.DescribedComponentBatch:
    """One static component named `archetype:field`."""
    archetype = component.partition(":")[0]
    descriptor = rr.ComponentDescriptor(component=component, archetype=archetype)
    return rr.DescribedComponentBatch(_Batch(descriptor, array), descriptor)


def table_columns(table: Table, rows: np.ndarray, lengths: np.ndarray) -> list[rr.ComponentColumn]:
    """A column for each field of a table; `rows` are those of all steps, `lengths` (K,) how many belong to each."""
    return [
        column(table.component(name), pa.array(np.ascontiguousarray(rows[name])), lengths)
        for name in table.dtype.names or ()
    ]


def time_columns(steps: Sequence[int] | np.ndarray, times: Sequence[float] | np.ndarray) -> list[rr.TimeColumn]:
    """Both timelines, K long. Times are rounded to whole nanoseconds."""
    nanoseconds = np.rint(np.asarray(times, np.float64) * 1e9).astype("timedelta64[ns]")
    return [
        rr.TimeColumn(STEP_TIMELINE, sequence=np.asarray(steps)),
        rr.TimeColumn(TIME_TIMELINE, duration=nanoseconds),
    ]
