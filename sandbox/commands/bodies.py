"""Commands that bring bodies into the world."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import TYPE_CHECKING

from engine import SHAPE_KINDS, validate
from engine.shapes import SHAPES
from sandbox.commands.base import PhysicsCommand, coordinates

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

SIZES = (0.05, 20.0)  # [m]
LARGEST_MASS = 1e6  # [kg]
LARGEST_FRICTION = 10.0
LARGEST_SPAWN = 200  # bodies at once


@dataclass(frozen=True)
class Spawn(PhysicsCommand):
    """New bodies around a point [m]: box of width and height, or circle of diameter width [m]; mass each [kg]."""

    shape: str
    x: float
    y: float
    width: float = 1.0
    height: float = 1.0
    mass: float = 10.0
    friction: float = 0.2
    count: int = 1
    name = "spawn"

    def __post_init__(self) -> None:
        self._keep(
            shape=validate.choice("shape", self.shape, SHAPE_KINDS),
            width=validate.between("width", self.width, *SIZES),
            height=validate.between("height", self.height, *SIZES),
            mass=validate.between("mass", self.mass, 1e-3, LARGEST_MASS),
            friction=validate.between("friction", self.friction, 0.0, LARGEST_FRICTION),
            count=validate.whole("count", self.count, 1, LARGEST_SPAWN),
            **coordinates(x=self.x, y=self.y),
        )

    def apply(self, simulation: Simulation) -> None:
        simulation.make_room(self.count)
        shape = SHAPES[SHAPE_KINDS.index(self.shape)].filling(self.width, self.height)
        columns = math.ceil(math.sqrt(self.count))
        step_x, step_y = (1.1 * extent for extent in shape.extent)
        for i in range(self.count):
            x = self.x + step_x * (i % columns - 0.5 * (columns - 1))
            y = self.y + step_y * (i // columns)
            simulation.world.create_body(shape, position=(x, y), mass=self.mass, friction=self.friction)


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
