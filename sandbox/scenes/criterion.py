"""What a scene shows, as a number: measured in the world after a while, and compared with what physics says."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from engine import StepError, World

Measure = Callable[[World], float]
Limit = float | Callable[[World, float], float]  # or a function of the world at its beginning and the time step [s]

Step = Callable[[float], object]

NO_LIMIT = math.inf


class Reading(NamedTuple):
    """A criterion, applied: whether the value is between the limits."""

    value: float  # inf if the step failed
    at_least: float
    at_most: float

    @property
    def passed(self) -> bool:
        return self.at_least <= self.value <= self.at_most

    @property
    def limit(self) -> float:
        """The one that it missed, or else the one it has."""
        return self.at_least if self.value < self.at_least or not math.isfinite(self.at_most) else self.at_most

    @property
    def misses(self) -> float:
        """How far beyond its limit it is, in parts of that; below 0 if it passed."""
        scale = max(abs(limit) for limit in (self.at_least, self.at_most) if math.isfinite(limit)) or 1.0
        return max(self.at_least - self.value, self.value - self.at_most) / scale


@dataclass(frozen=True)
class Criterion:
    """A claim that can be measured: `says` is its sentence, of which the measured number is the subject.

    after: simulated time at which the measure is taken [s]; with `throughout`, it is the greatest of all steps until
    then, for a claim that must hold all the time.
    """

    says: str
    measure: Measure
    unit: str
    after: float
    at_most: Limit = NO_LIMIT
    at_least: Limit = -NO_LIMIT
    throughout: bool = False

    def limits(self, world: World, dt: float) -> tuple[float, float]:
        """(least, most) that the value may be, from the world at its beginning."""
        low, high = (limit(world, dt) if callable(limit) else limit for limit in (self.at_least, self.at_most))
        return float(low), float(high)

    def claim(self, world: World, dt: float) -> str:
        """The sentence with its limits: "the top box has sunk by ≤ 0.16 m, after 20 s"."""
        low, high = self.limits(world, dt)
        unit = f" {self.unit}" if self.unit else ""
        if math.isfinite(low) and math.isfinite(high):
            limits = f"{low:.3g}{unit}" if low == high else f"{low:.3g} to {high:.3g}{unit}"
        else:
            limits = f"≤ {high:.3g}{unit}" if math.isfinite(high) else f"≥ {low:.3g}{unit}"
        return f"{self.says} {limits}, {self.when}"

    def to_dict(self, world: World, dt: float) -> dict[str, Any]:
        """As JSON takes it, with its limits in a world at its beginning; None where there is none."""
        low, high = (limit if math.isfinite(limit) else None for limit in self.limits(world, dt))
        about = {"says": self.says, "unit": self.unit, "after": self.after, "throughout": self.throughout}
        return {**about, "at_least": low, "at_most": high}

    @property
    def when(self) -> str:
        """Such as "after 20 s"."""
        return f"{'within' if self.throughout else 'after'} {self.after:g} s"


def apply(criteria: Sequence[Criterion], world: World, dt: float, step: Step | None = None) -> list[Reading]:
    """Runs the world from its beginning as long as the criteria ask for, and reads them all. A failed step is infinite.

    step: what makes a step of dt, if not the world itself.
    """
    make_step = step or world.step
    limits = [criterion.limits(world, dt) for criterion in criteria]
    ends = [round(criterion.after / dt) for criterion in criteria]
    values = [-math.inf] * len(criteria)
    for number in range(1, max(ends) + 1):
        try:
            make_step(dt)
        except StepError:
            values = [math.inf if number <= end else value for value, end in zip(values, ends, strict=True)]
            break
        for k, criterion in enumerate(criteria):
            if number == ends[k] or (criterion.throughout and number < ends[k]):
                values[k] = max(values[k], float(criterion.measure(world)))
    return [Reading(value, *limit) for value, limit in zip(values, limits, strict=True)]
