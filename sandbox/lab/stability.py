"""Hard cases, each with a criterion from physics: does it hold, with which settings, and what does that cost?"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from engine import SOLVERS, StepError, TooLarge
from engine.compilation import timed_compilation
from sandbox.lab.hard_cases import CASES, Case, NotApplicable
from sandbox.lab.hard_cases.case import is_finite
from sandbox.lab.stability_ladder import PEERS, Variant, climb
from sandbox.lab.stability_stage import OurStage, PeerStage, open_stage
from sandbox.scenes.criterion import Criterion, Reading

LONGEST = 30.0  # CPU time that a run may take [s]: what takes longer is not applicable


class OutOfTime(Exception):
    """The deadline has passed; what was begun is not told."""


@dataclass(frozen=True)
class Row:
    """One case with one variant. The value is that of the criterion it missed by most; of the first if it passed."""

    case: str
    solver: str
    settings: dict[str, Any]
    default: bool
    passed: bool | None  # None: this solver cannot have the case
    value: float  # inf if a step failed
    limit: float
    unit: str
    ms: float  # CPU time of a simulated second [ms]
    label: str  # of the settings
    claim: str  # what is measured, or why the case is not applicable
    at_least: float = -math.inf
    at_most: float = math.inf

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        names = ("case", "solver", "settings", "default", "passed", "value", "limit", "unit", "ms")
        values = {name: getattr(self, name) for name in names}
        finite = {name: values[name] if math.isfinite(values[name]) else None for name in ("value", "limit", "ms")}
        return {**values, **finite}


def check(name: str, variant: Variant, deadline: float = math.inf) -> Row:
    """Runs a case with a variant. deadline: in time.time(); OutOfTime when it has passed."""
    case = CASES[name]
    try:
        stage = open_stage(case, variant)
    except NotApplicable as reason:
        return not_applicable(name, variant, str(reason))
    try:
        shown = variant.shown(stage.world, case.dt)
        with timed_compilation() as compiling:
            readings = run(case, stage, variant, deadline)
    except NotApplicable as reason:
        return not_applicable(name, variant, str(reason))
    finally:
        stage.close()
    criterion, reading = worst(readings)
    return Row(
        case=name,
        solver=variant.solver,
        settings=shown,
        default=variant.default,
        passed=all(reading.passed for _, reading in readings),
        value=reading.value,
        limit=reading.limit,
        unit=criterion.unit,
        ms=1e3 * max(stage.seconds - sum(compiling.values()), 0.0) / stage.timed if stage.timed > 0.0 else 0.0,
        label=variant.label,
        claim=claim(criterion),
        at_least=reading.at_least,
        at_most=reading.at_most,
    )


def run(
    case: Case, stage: OurStage | PeerStage, variant: Variant, deadline: float = math.inf
) -> list[tuple[Criterion, Reading]]:
    """From its beginning until the last criterion is read, or one is missed: those that were read.

    A step that fails, and a body that is nowhere, are infinite.
    """
    part = case.dt / variant.parts
    limits = {criterion: criterion.limits(stage.world, part) for criterion in case.criteria}
    values: dict[Criterion, float] = {}
    waiting = list(case.criteria)
    number = 0
    while waiting:
        dt = case.program(stage, number, case.dt) if case.program else case.dt
        number += 1
        if not advance(stage, dt, variant.parts):
            return [(criterion, Reading(math.inf, *limit)) for criterion, limit in limits.items()]
        for criterion in tuple(waiting):
            over = stage.world.time >= criterion.after - 0.5 * part
            if over or criterion.throughout:
                value = float(criterion.measure(stage.world))
                value = values[criterion] = max(value, values.get(criterion, -math.inf))
                if value > limits[criterion][1] or (over and value < limits[criterion][0]):
                    waiting.clear()  # it has failed, whatever the others would say
                    break
            if over:
                waiting.remove(criterion)
        if time.time() > deadline:
            raise OutOfTime
        if stage.seconds > LONGEST:
            raise NotApplicable(f"it takes more than {LONGEST:g} s of CPU time")
    return [(criterion, Reading(value, *limits[criterion])) for criterion, value in values.items()]


def advance(stage: OurStage | PeerStage, dt: float, parts: int) -> bool:
    """A time step in so many parts; whether all is still somewhere. NotApplicable where a solver refuses it."""
    try:
        for _ in range(parts):
            stage.step(dt / parts)
    except (ValueError, TooLarge) as reason:
        raise NotApplicable(str(reason)) from None
    except StepError:
        return False
    return is_finite(stage.world)


def not_applicable(name: str, variant: Variant, reason: str) -> Row:
    """A row that says so."""
    return Row(name, variant.solver, {}, variant.default, None, math.nan, math.nan, "", math.nan, variant.label, reason)


def try_cell(name: str, solver: str, defaults_only: bool = False, deadline: float = math.inf) -> list[Row]:
    """A case with a solver: with its defaults, then up or down its ladder of settings."""
    rows: list[Row] = []

    def passes(variant: Variant) -> bool | None:
        rows.append(check(name, variant, deadline))
        return rows[-1].passed

    try:
        for _ in climb(solver, passes, defaults_only):
            pass
    except OutOfTime:
        pass
    return rows


def solvers() -> tuple[str, ...]:
    """All that there are, the default first."""
    return (*SOLVERS, *PEERS)


def cheapest(rows: Sequence[Row]) -> Row | None:
    """Of a case's rows with a solver, the one that passes with least time; None if none does."""
    passed = [row for row in rows if row.passed]
    return min(passed, key=lambda row: row.ms) if passed else None


def worst(readings: Sequence[tuple[Criterion, Reading]]) -> tuple[Criterion, Reading]:
    """The one that is missed by most, in parts of its limit; the first if none is."""
    missed = [pair for pair in readings if not pair[1].passed]
    return max(missed, key=lambda pair: pair[1].misses) if missed else readings[0]


def claim(criterion: Criterion) -> str:
    """What is measured, with its unit and when."""
    unit = f" [{criterion.unit}]" if criterion.unit else ""
    return f"{criterion.says.rstrip(' :,')}{unit}, {criterion.when}"
