"""Which settings are worth their price."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from sandbox.lab.accuracy.rows import Row

TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)  # errors in parts of a measure's scale

Price = Callable[[Row], float | None]


def milliseconds(row: Row) -> float | None:
    """CPU time of a simulated second [ms]."""
    return row.cost_ms


def solves(row: Row) -> float | None:
    """Constraints visited, which no machine changes; None where nobody counted."""
    return row.solves


def front(rows: Sequence[Row], price: Price = milliseconds) -> list[Row]:
    """Those of one measure that no other beats in both error and price, the cheapest first (V. Pareto's optimum)."""
    priced = [(price(row), row) for row in rows if math.isfinite(row.error) and price(row) is not None]
    priced.sort(key=lambda pair: (pair[0], pair[1].error))
    best, found = math.inf, []
    for _, row in priced:
        if row.error < best:
            best = row.error
            found.append(row)
    return found


def cheapest(rows: Sequence[Row], target: float, price: Price = milliseconds) -> Row | None:
    """The cheapest of one measure whose error is at most so much of the measure's scale; None if none is."""
    return next((row for row in front(rows, price) if row.relative <= target), None)
