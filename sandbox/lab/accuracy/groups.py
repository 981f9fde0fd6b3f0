"""Rows in groups, as all reports show them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from engine import SOLVERS
from sandbox.lab.accuracy.rows import Row, measure_of
from sandbox.lab.experiments import EXPERIMENTS

LEAST = 1e-12  # what is less is drawn as this: an error may be zero


class Group(NamedTuple):
    """Rows of one measure."""

    scene: str
    measure: str
    rows: list[Row]

    @property
    def title(self) -> str:
        """Such as "ballistic: a ball thrown upwards; height after 2 s [m]"."""
        return f"{self.scene}: {EXPERIMENTS[self.scene].says}; {self.says}"

    @property
    def says(self) -> str:
        """What it measures, with its unit."""
        measure = measure_of(self.scene, self.measure)
        return f"{measure.says} [{measure.unit}]"

    @property
    def scale(self) -> float:
        return measure_of(self.scene, self.measure).scale

    @property
    def against(self) -> str:
        """What the error is a part of: "1e-3 of 7.2 m, the height it rises"."""
        measure = measure_of(self.scene, self.measure)
        if measure.unit == "relative":
            return measure.against
        return f"{measure.scale:.3g} {measure.unit}, {measure.against}"


def by_measure(rows: Iterable[Row]) -> list[Group]:
    """Rows of the same measure."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row.scene, row.measure), []).append(row)
    return [Group(*key, group) for key, group in groups.items()]


def by_series(rows: Iterable[Row]) -> dict[str, list[Row]]:
    """Rows of one measure by their series."""
    lines: dict[str, list[Row]] = {}
    for row in rows:
        lines.setdefault(row.series, []).append(row)
    return lines


def solvers_of(rows: Iterable[Row]) -> list[str]:
    """Ours in the engine's order, then the peers."""
    found = {row.solver for row in rows}
    return [name for name in SOLVERS if name in found] + sorted(found - set(SOLVERS))


def drawable(rows: Sequence[Row]) -> list[Row]:
    """Those with a place in a diagram."""
    return [row for row in rows if math.isfinite(row.error) and row.cost_ms > 0.0]


def height(row: Row) -> float:
    """Its error as it is drawn."""
    return max(row.error, LEAST)


def number(value: float) -> str:
    """An error, to two digits."""
    return f"{value:.1e}" if math.isfinite(value) else "lost"
