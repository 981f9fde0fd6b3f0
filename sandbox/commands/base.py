"""What all commands have in common."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from engine import validate

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

REACH = 1e5  # farthest coordinate that a command may name [m]


class Command(Protocol):
    """What the session takes."""

    name: ClassVar[str]


class PhysicsCommand:
    """A command that changes the world."""

    name: ClassVar[str]

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {"command": self.name, **asdict(self)}  # type: ignore[call-overload]

    def apply(self, simulation: Simulation) -> None:
        """Does it."""
        raise TypeError(f"{type(self).__name__} cannot be applied")

    def _keep(self, **checked: Any) -> None:
        for name, value in checked.items():
            object.__setattr__(self, name, value)


def coordinates(**values: Any) -> dict[str, float]:
    """Checked coordinates [m]."""
    return {name: validate.between(name, value, -REACH, REACH) for name, value in values.items()}
