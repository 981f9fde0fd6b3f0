"""Hard cases, each with a criterion from physics: does it hold, with which settings, and what does that cost?"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from engine import SOLVERS, World
from sandbox.scenes import find_scene
from sandbox.scenes.criterion import Criterion, Reading, apply
from sandbox.simulation import TIME_STEP

CASES = {
    "stack_10": "Stacking/Vertical Stack 10",
    "stack_20": "Stacking/Vertical Stack 20",
    "stack_40": "Stacking/Vertical Stack 40",
    "pyramid": "Stacking/Pyramid 100",
    "mass_ratio_400": "Stacking/Mass Ratio 400",
    "overlap_recovery": "Stacking/Overlap Recovery",
    "card_house": "Stacking/Card House",
    "arch": "Stacking/Arch",
    "dominoes": "Stacking/Dominoes",
    "friction_ramp": "Effects/Friction Ramp",
}
LARGE = ("pyramid",)  # run with the defaults only: they take seconds

Progress = Callable[[], None]  # is told of every run that was made


@dataclass(frozen=True)
class Variant:
    """Settings of a solver to try; none: its defaults."""

    solver: str
    settings: tuple[tuple[str, Any], ...] = ()
    steps: int = 1  # in 1/60 s

    @property
    def default(self) -> bool:
        return not self.settings and self.steps == 1

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return TIME_STEP / self.steps


VARIANTS = (
    Variant("soft_step"),
    Variant("soft_step", (("substeps", 2),)),
    Variant("soft_step", (("substeps", 8),)),
    Variant("soft_step", (("substeps", 16),)),
    Variant("soft_step", (("recycling", False),)),
    Variant("sequential_impulses"),
    Variant("sequential_impulses", (("iterations", 40),)),
    Variant("sequential_impulses", (), 4),
)


@dataclass(frozen=True)
class Row:
    """One case with one variant. The value is that of the criterion it missed by most; of the first if it passed."""

    case: str
    solver: str
    settings: dict[str, Any]
    default: bool
    passed: bool
    value: float  # inf if a step failed
    limit: float
    unit: str
    ms: float  # CPU time of a simulated second [ms]
    criterion: Criterion
    reading: Reading
    variant: Variant

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        names = ("case", "solver", "settings", "default", "passed", "value", "limit", "unit", "ms")
        values = {name: getattr(self, name) for name in names}
        return {**values, "value": self.value if math.isfinite(self.value) else None}


def variants_of(case: str) -> list[Variant]:
    """What is tried of a case."""
    return [variant for variant in VARIANTS if variant.default or case not in LARGE]


def check(case: str, variant: Variant) -> Row:
    """Runs a case with a variant."""
    scene = find_scene(CASES[case])
    world = scene.make(**{"solver": variant.solver, "sleeping": False, **dict(variant.settings)})
    clock = Clock(world)
    readings = apply(scene.shows, world, variant.dt, clock.step)
    criterion, reading = worst(scene.shows, readings)
    return Row(
        case=case,
        solver=variant.solver,
        settings=shown(world, variant.dt),
        default=variant.default,
        passed=all(one.passed for one in readings),
        value=reading.value,
        limit=reading.limit,
        unit=criterion.unit,
        ms=clock.ms_a_second(),
        criterion=criterion,
        reading=reading,
        variant=variant,
    )


def check_all(cases: Sequence[str], progress: Progress) -> list[Row]:
    """All rows, a case after the other."""
    rows = []
    for case in cases:
        for variant in variants_of(case):
            rows.append(check(case, variant))
            progress()
    return rows


def worst(criteria: Sequence[Criterion], readings: Sequence[Reading]) -> tuple[Criterion, Reading]:
    """The one that is missed by most, in parts of its limit; the first if none is."""
    pairs = list(zip(criteria, readings, strict=True))
    missed = [pair for pair in pairs if not pair[1].passed]
    return max(missed, key=lambda pair: pair[1].misses) if missed else pairs[0]


def shown(world: World, dt: float) -> dict[str, Any]:
    """The settings that matter here."""
    names = ["substeps", "iterations", "stiffness", "recycling"]
    if not SOLVERS[world.settings.solver].has_substeps:
        names = ["iterations"]
    return {"dt": dt, **{name: getattr(world.settings, name) for name in names}}


class Clock:
    """Steps a world, and adds up the CPU time that this takes."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._seconds = 0.0

    def step(self, dt: float) -> None:
        before = time.process_time()
        try:
            self._world.step(dt)
        finally:
            self._seconds += time.process_time() - before

    def ms_a_second(self) -> float:
        """CPU time of a simulated second [ms]."""
        return 1e3 * self._seconds / self._world.time if self._world.time > 0.0 else 0.0
