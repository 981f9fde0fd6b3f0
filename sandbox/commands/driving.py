"""The command that drives a motor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import validate
from sandbox.commands.base import PhysicsCommand

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

JOINTS = 2**31
FASTEST = 1e3  # that a motor may be asked to be [rad/s], [m/s]


@dataclass(frozen=True)
class DriveMotor(PhysicsCommand):
    """The motor of a joint, by its number of creation, is to reach a speed [rad/s], or [m/s] where it slides.

    Of a joint that is not there, or has no motor, nothing.
    """

    joint: int
    speed: float
    name = "drive"

    def __post_init__(self) -> None:
        self._keep(
            joint=validate.whole("joint", self.joint, 0, JOINTS),
            speed=validate.between("speed", self.speed, -FASTEST, FASTEST),
        )

    def apply(self, simulation: Simulation) -> None:
        simulation.drive(self.joint, self.speed)
