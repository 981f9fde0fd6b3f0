"""The command that throws the bomb."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import validate
from sandbox.commands.base import PhysicsCommand, coordinates

if TYPE_CHECKING:
    from sandbox.simulation import Simulation


@dataclass(frozen=True)
class Bomb(PhysicsCommand):
    """Box2D Lite's bomb: one heavy box, thrown, and thrown again."""

    x: float
    y: float
    angle: float
    vx: float
    vy: float
    spin: float
    name = "bomb"

    def __post_init__(self) -> None:
        self._keep(
            **coordinates(x=self.x, y=self.y),
            angle=validate.between("angle", self.angle, -1e3, 1e3),
            vx=validate.between("vx", self.vx, -1e3, 1e3),
            vy=validate.between("vy", self.vy, -1e3, 1e3),
            spin=validate.between("spin", self.spin, -1e3, 1e3),
        )

    @classmethod
    def random(cls, rng: random.Random) -> Bomb:
        """From above, aimed at the origin, as Box2D Lite throws it."""
        x, y = rng.uniform(-15.0, 15.0), 15.0
        return cls(x, y, rng.uniform(-1.5, 1.5), -1.5 * x, -1.5 * y, rng.uniform(-20.0, 20.0))

    def apply(self, simulation: Simulation) -> None:
        bomb = simulation.bomb()
        bomb.position = (self.x, self.y)
        bomb.angle = self.angle
        bomb.velocity = (self.vx, self.vy)
        bomb.angular_velocity = self.spin
