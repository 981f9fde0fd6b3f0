"""What accuracy costs: each experiment's error, and the CPU time that it took, over the settings of all solvers."""

from __future__ import annotations

from sandbox.lab.accuracy.pareto import TARGETS, cheapest, front
from sandbox.lab.accuracy.rows import KEYS, Row, measure_of
from sandbox.lab.accuracy.running import Outcome
from sandbox.lab.accuracy.runs import NotApplicable, Watched, cost, passes, unable, watch
from sandbox.lab.accuracy.series import Point, Series, Setting, all_series, over, series_of
from sandbox.lab.accuracy.sweep import SECONDS, plan, sweep
from sandbox.lab.accuracy.tasks import REPEATS, Task

__all__ = [
    "KEYS",
    "REPEATS",
    "SECONDS",
    "TARGETS",
    "NotApplicable",
    "Outcome",
    "Point",
    "Row",
    "Series",
    "Setting",
    "Task",
    "Watched",
    "all_series",
    "cheapest",
    "cost",
    "front",
    "measure_of",
    "over",
    "passes",
    "plan",
    "series_of",
    "sweep",
    "unable",
    "watch",
]
