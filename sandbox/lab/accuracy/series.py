"""What is swept: time step, substeps, iterations, stiffness and precision, as far as a solver has them.

A line of a diagram is a `Series`: settings of which one thing changes. They follow from what engine.SOLVERS says of a
solver and from the settings that matter to it, so a further solver brings its lines by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from engine import SOLVERS, World
from engine.settings import describe
from engine.solvers.solver import Solver
from sandbox.lab.peers import KNOBS
from sandbox.simulation import TIME_STEP

SUBSTEPS = (1, 2, 4, 8, 16, 32)
ITERATIONS = (1, 2, 5, 10, 20, 50)  # of a solver without substeps
ITERATIONS_A_SUBSTEP = (1, 2, 4, 8)
STEPS = (1, 2, 4, 8)
COARSE = {1, 4, 10, 16}  # values that are run before those between them
FINE = 2  # the level of what varies a theme: precision, fixed stiffness
CAPPED = 4  # substeps up to which a fixed stiffness is cut off where it follows: there it makes no difference
KNOB_NAMES = ("substeps", "iterations", "stiffness fixed", "double precision")  # as they stand in names of lines
GRAVITY = (0.0, -10.0)  # [m/s^2]


@dataclass(frozen=True)
class Setting:
    """One point of a line: a world's settings, and how many steps make 1/60 s."""

    label: str
    world: dict[str, Any]
    steps: int = 1
    level: int = 0  # coarse settings are run first: 0 before 1 before 2

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return TIME_STEP / self.steps


@dataclass(frozen=True)
class Series:
    """Settings of which only one thing changes: a line of the diagram."""

    name: str
    solver: str
    settings: tuple[Setting, ...]
    precision: str = "single"

    @property
    def engine_solver(self) -> str:
        """The solver of the world that is filled: of a peer's copy it does not matter."""
        return self.solver if self.solver in SOLVERS else "soft_step"

    def world(self, setting: Setting) -> World:
        """An empty world with that setting, in which nothing sleeps: that would end an experiment."""
        return World(
            gravity=GRAVITY, solver=self.engine_solver, precision=self.precision, sleeping=False, **setting.world
        )  # fmt: skip


@dataclass(frozen=True)
class Point:
    """A setting of a series."""

    series: Series
    setting: Setting

    @property
    def work(self) -> float:
        """Passes in 1/60 s: by which points are sorted before their cost is known."""
        world = self.setting.world
        return self.setting.steps * float(world.get("substeps", 1)) * float(world.get("iterations", 1))


def over(name: str, values: Sequence[int], level: int | None = None, **fixed: Any) -> tuple[Setting, ...]:
    """Settings of which one takes several values. level: of all; else coarse values come first."""
    return tuple(
        Setting(str(value), {name: value, **fixed}, level=_level(value) if level is None else level)
        for value in values
    )  # fmt: skip


def over_steps(level: int | None = None, least: int = 1) -> tuple[Setting, ...]:
    """Ever shorter time steps, with the solver's own substeps and iterations."""
    return tuple(
        Setting(str(steps), {}, steps, _level(steps) if level is None else level) for steps in STEPS if steps >= least
    )


def _level(value: int) -> int:
    return 0 if value in COARSE else 1


def matters(setting: str, solver: Solver) -> bool:
    """Whether a setting means something to a solver."""
    if setting in ("substeps", "iterations"):
        return bool(getattr(solver, f"has_{setting}"))
    info = next(info for info in describe() if info.name == setting)
    return not info.solvers or solver.name in info.solvers


def series_of(solver: Solver) -> list[Series]:
    """All lines of one solver. The first holds the settings that one would turn first; no other repeats one of them."""
    name = solver.name
    lines = []
    if solver.has_substeps:
        lines.append(Series(f"{name}, substeps", name, over("substeps", sorted({*SUBSTEPS, solver.substeps}))))
        if matters("iterations", solver):
            more = tuple(count for count in ITERATIONS_A_SUBSTEP if count != solver.iterations)
            where = f"iterations in {solver.substeps} substeps"
            lines.append(Series(f"{name}, {where}", name, over("iterations", more)))
    elif matters("iterations", solver):
        lines.append(Series(f"{name}, iterations", name, over("iterations", sorted({*ITERATIONS, solver.iterations}))))
    steps = over_steps(least=2 if lines else 1)
    lines.append(Series(f"{name}, steps in 1/60 s", name, steps))
    if solver.has_substeps and matters("stiffness", solver):
        fixed = over("substeps", [count for count in SUBSTEPS if count > CAPPED], FINE, stiffness="fixed")
        lines.append(Series(f"{name}, substeps, stiffness fixed", name, fixed))
    double = tuple(replace(setting, level=FINE) for setting in lines[0].settings) if solver.has_substeps else None
    varied = "substeps" if solver.has_substeps else "steps in 1/60 s"
    lines.append(Series(f"{name}, {varied}, double precision", name, double or over_steps(FINE), "double"))
    return lines


def peer_series(name: str) -> list[Series]:
    """All lines of a peer, with its own stiffness: what it takes of ours stands beside its adapter."""
    knob = KNOBS[name]
    values = SUBSTEPS if knob == "substeps" else ITERATIONS
    return [
        Series(f"{name}, {knob}", name, over(knob, values)),
        Series(f"{name}, steps in 1/60 s", name, over_steps(least=2)),
    ]


def all_series(solvers: Iterable[str], peers: Iterable[str] = ()) -> tuple[Series, ...]:
    """The lines of several solvers and peers, by name."""
    ours = [line for name in solvers for line in series_of(SOLVERS[name])]
    return (*ours, *(line for name in peers for line in peer_series(name)))


def missing(name: str) -> list[str]:
    """What a solver or a peer has not, of what is swept."""
    lines = [line.name for line in (series_of(SOLVERS[name]) if name in SOLVERS else peer_series(name))]
    return [knob for knob in KNOB_NAMES if not any(knob in line for line in lines)]
