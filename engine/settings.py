"""What a user may set: immutable, checked when made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from engine import validate
from engine.broad_phase import BROAD_PHASES
from engine.constants import ITERATIONS, MAX_ITERATIONS
from engine.solvers import SOLVERS
from engine.tables import REALS


@dataclass(frozen=True)
class Settings:
    """All settings of a world. ValueError names the one that is wrong."""

    gravity: tuple[float, float] = (0.0, -10.0)  # [m/s^2]
    solver: str = "sequential_impulses"
    iterations: int = ITERATIONS  # passes over all constraints in a step
    precision: str = "single"  # of the solver's own numbers: "single" | "double"
    broad_phase: str = "all_pairs"
    accumulate_impulses: bool = True  # clamp the sum of a contact's impulses, not each of them
    warm_starting: bool = True  # begin a step with the impulses of the step before
    position_correction: bool = True  # push overlapping bodies apart

    def __post_init__(self) -> None:
        checked: dict[str, Any] = {
            "gravity": validate.vector("gravity", self.gravity),
            "solver": validate.choice("solver", self.solver, SOLVERS),
            "iterations": validate.whole("iterations", self.iterations, 1, MAX_ITERATIONS),
            "precision": validate.choice("precision", self.precision, REALS),
            "broad_phase": validate.choice("broad_phase", self.broad_phase, BROAD_PHASES),
            "accumulate_impulses": validate.switch("accumulate_impulses", self.accumulate_impulses),
            "warm_starting": validate.switch("warm_starting", self.warm_starting),
            "position_correction": validate.switch("position_correction", self.position_correction),
        }
        validate.in_range(self.precision, gravity=checked["gravity"])
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {**asdict(self), "gravity": list(self.gravity)}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Settings:
        """What `to_dict` gave; an unknown name is refused."""
        known = [field.name for field in fields(cls)]
        for name in values:
            validate.choice("setting", name, known)
        return cls(**values)
