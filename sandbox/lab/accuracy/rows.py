"""One point of a diagram, as the sweep makes it and reports take it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from sandbox.lab.experiments import EXPERIMENTS, Measure

KEYS = ("scene", "solver", "settings", "precision", "measure", "error", "cost_ms", "solves")  # of the JSON


@dataclass(frozen=True)
class Row:
    """An experiment's error with one setting, and what it cost."""

    scene: str
    solver: str  # or the peer's name
    settings: dict[str, Any]
    precision: str
    measure: str
    error: float  # in the measure's unit; infinite where the run was lost
    cost_ms: float  # CPU time of a simulated second [ms], the median of several runs
    spread_ms: float  # from the least to the greatest of those [ms]
    solves: int | None  # constraints visited: passes x substeps x steps x (contacts + joints), of the whole run; of a
    # peer nobody knows
    series: str
    label: str
    predicted: float | None  # the error that is known beforehand

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        values = {name: getattr(self, name) for name in KEYS}
        return {**values, "error": self.error if math.isfinite(self.error) else None}

    @property
    def relative(self) -> float:
        """The error in parts of its measure's scale."""
        return self.error / measure_of(self.scene, self.measure).scale

    @property
    def setting(self) -> str:
        """What it was run with, in a few words: "8 substeps", "20 iterations, dt 1/240, double"."""
        words = [f"{count} {name}" for name in ("substeps", "iterations") if (count := self.settings.get(name))]
        if words[1:] == ["1 iterations"]:
            words = words[:1]
        steps = round(1.0 / self.settings["dt"])
        words += [f"dt 1/{steps}"] if steps != 60 or not words else []
        words += ["fixed stiffness"] if self.settings.get("stiffness") == "fixed" else []
        words += ["double"] if self.precision == "double" else []
        return ", ".join(words)


def measure_of(scene: str, measure: str) -> Measure:
    """The measure by its name, which ends with its unit."""
    return next(one for one in EXPERIMENTS[scene].measures if one.name == measure)
