"""Commands of a hand that drags bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import validate
from sandbox.commands.base import PhysicsCommand, coordinates

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

HANDS = 2**31


@dataclass(frozen=True)
class Grab(PhysicsCommand):
    """A hand takes hold of the dynamic body under a point [m], if there is one."""

    hand: int
    x: float
    y: float
    name = "grab"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS), **coordinates(x=self.x, y=self.y))

    def apply(self, simulation: Simulation) -> None:
        simulation.grab(self.hand, (self.x, self.y))


@dataclass(frozen=True)
class MoveHand(PhysicsCommand):
    """A hand moves to a point [m], and what it holds is pulled after it."""

    hand: int
    x: float
    y: float
    name = "move_hand"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS), **coordinates(x=self.x, y=self.y))

    def apply(self, simulation: Simulation) -> None:
        simulation.move_hand(self.hand, (self.x, self.y))


@dataclass(frozen=True)
class Release(PhysicsCommand):
    """A hand lets go."""

    hand: int
    name = "release"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS))

    def apply(self, simulation: Simulation) -> None:
        simulation.release(self.hand)
