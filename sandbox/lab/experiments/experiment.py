"""What an experiment is: a small scene whose answer is known, what is watched in it, and how far off the answer it is.

`@experiment(...)` above the function that fills the world is all it takes to add one. Each fills its world with copies
side by side, so that what is timed is the solver and not the Python around it. It watches a few numbers after every
step, of the first copy; its measures turn that history into errors. Where the error that the integrator or the soft
constraints must make is known in closed form, it is predicted too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import Body, Box, World
from sandbox.lab.sag import MARGIN

G = 10.0  # [m/s^2]
COPIES = 60
APART = 6.0  # of copies [m]

ROUNDING = {"single": 1e-4, "double": 1e-6}  # what it may come to in an experiment, in parts of a measure's scale

History = np.ndarray  # (steps, k) of what was watched; row 0 after the first step
Watch = Callable[[World], np.ndarray]  # (k,) now
Build = Callable[[World], Watch]
Predict = Callable[[World, float], float | None]  # of a world with its settings and the time step [s]
Error = Callable[[History, float], float]  # of the history of a run whose time step was dt [s]


def unpredicted(world: World, dt: float) -> None:
    """No closed form is known."""


def exact(world: World, dt: float) -> float:
    """The method makes no error at all here: what is found is rounding."""
    return 0.0


def known_of(*solvers: str) -> Callable[[Predict], Predict]:
    """What holds for these solvers; of others nothing is known."""

    def restrict(predict: Predict) -> Predict:
        return lambda world, dt: predict(world, dt) if world.settings.solver in solvers else None

    return restrict


of_soft_step = known_of("soft_step")
"""What holds for constraints that are springs, as soft_step's are."""
as_talk_and_soft_step = known_of("soft_step", "sequential_impulses")
"""What holds for the springs of soft_step, and for what sequential_impulses push out bit by bit."""
of_impulses = known_of("soft_step", "sequential_impulses", "ngs", "xpbd", "direct")
"""What holds where bodies push each other by impulses that both feel. Not so in avbd, which moves body after body: its
momentum is kept, and its friction all there, as far as the iterations have converged (docs/solvers.md).
"""
of_clean_impulses = known_of("soft_step", "ngs", "xpbd", "direct")
"""The same without sequential_impulses, in which overlap that goes leaves its speed behind."""


@dataclass(frozen=True)
class Measure:
    """An error, in its unit. It is judged in parts of `scale`, which is `against`: 1e-3 of "the height it rises"."""

    what: str
    unit: str  # as SI has it; "relative" where the error is a part of the answer
    says: str
    error: Error
    predicted: Predict = unpredicted
    scale: float = 1.0  # in its unit
    against: str = "the exact value"

    @property
    def name(self) -> str:
        """With its unit, as reports and JSON have it."""
        return f"{self.what} [{self.unit}]"

    def limit(self, world: World, dt: float) -> float | None:
        """What a sound solver's error is at most, in its unit: a fifth more than predicted, and rounding."""
        predicted = self.predicted(world, dt)
        return None if predicted is None else MARGIN * predicted + ROUNDING[world.precision] * self.scale


@dataclass(frozen=True)
class Experiment:
    """A scene with a known answer. `build` fills the world and says what to watch."""

    name: str
    says: str
    seconds: float
    build: Build
    measures: tuple[Measure, ...]
    needs: tuple[str, ...] = ()  # effects without which it makes no sense
    prepare: Callable[[], object] | None = None  # makes what it is compared with, where that takes long


EXPERIMENTS: dict[str, Experiment] = {}


def experiment(
    name: str, says: str, *, seconds: float, measures: Measure | tuple[Measure, ...], needs: tuple[str, ...] = ()
) -> Callable[[Build], Build]:
    """Makes the function below an experiment, listed in EXPERIMENTS."""
    if name in EXPERIMENTS:
        raise ValueError(f"name = {name!r}: must be an experiment's name that is not taken yet")
    several = measures if isinstance(measures, tuple) else (measures,)

    def register(build: Build) -> Build:
        EXPERIMENTS[name] = Experiment(name, says, seconds, build, several, needs)
        return build

    return register


# --- parts of scenes --------------------------------------------------------------------------------------------------


def substep(world: World, dt: float) -> float:
    """Time of one integration [s]."""
    return dt / world.settings.substeps


def places(count: int = COPIES, apart: float = APART) -> list[tuple[float, float]]:
    """Where copies stand; the first at the origin [m]."""
    return [(apart * k, 0.0) for k in range(count)]


def levels(count: int = COPIES, apart: float = 2.0) -> list[float]:
    """Heights of copies on slopes, which lie above one another; the first at 0 [m]."""
    return [apart * k for k in range(count)]


def late(history: History, dt: float, seconds: float = 0.5) -> History:
    """Its end, during which what rests is compared."""
    return history[-max(1, round(seconds / dt)) :]


def times(history: History, dt: float) -> np.ndarray:
    """(steps,) when each row was watched [s]."""
    return np.arange(1, len(history) + 1) * dt


def add_floor(world: World, friction: float = 0.6, **properties: Any) -> Body:
    """Under all copies, its top at y = 0."""
    width = 2.0 * APART * (COPIES + 10)
    return world.create_body(Box(width, 2), position=(0.0, -1.0), kind="static", friction=friction, **properties)
