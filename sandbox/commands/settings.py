"""Commands that change the world's settings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import SOLVERS, validate
from engine.constants import MAX_ITERATIONS
from sandbox.commands.base import PhysicsCommand

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

LARGEST_GRAVITY = 1000.0  # [m/s^2]
MOST_ITERATIONS = min(1000, MAX_ITERATIONS)
SWITCHES = ("accumulate_impulses", "warm_starting", "position_correction")


@dataclass(frozen=True)
class SetGravity(PhysicsCommand):
    """Gravity [m/s^2]."""

    x: float
    y: float
    name = "set_gravity"

    def __post_init__(self) -> None:
        for name in ("x", "y"):
            value = validate.between(name, getattr(self, name), -LARGEST_GRAVITY, LARGEST_GRAVITY)
            self._keep(**{name: value})

    def apply(self, simulation: Simulation) -> None:
        simulation.world.gravity = (self.x, self.y)


@dataclass(frozen=True)
class SetIterations(PhysicsCommand):
    """Passes over all constraints in a step."""

    iterations: int
    name = "set_iterations"

    def __post_init__(self) -> None:
        self._keep(iterations=validate.whole("iterations", self.iterations, 1, MOST_ITERATIONS))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.iterations = self.iterations


@dataclass(frozen=True)
class SetSwitch(PhysicsCommand):
    """One of the talk's three switches."""

    switch: str
    on: bool
    name = "set_switch"

    def __post_init__(self) -> None:
        self._keep(switch=validate.choice("switch", self.switch, SWITCHES), on=validate.switch("on", self.on))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.set(**{self.switch: self.on})


@dataclass(frozen=True)
class SetSolver(PhysicsCommand):
    """The solver, by name."""

    solver: str
    name = "set_solver"

    def __post_init__(self) -> None:
        self._keep(solver=validate.choice("solver", self.solver, SOLVERS))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.solver = self.solver
