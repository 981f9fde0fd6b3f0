"""A heavy box runs into thousands of small ones: contacts come and go, and none lasts."""

from __future__ import annotations

from engine import Box, World
from sandbox.scenes.benchmark.parts import grid_places
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene

COLUMNS, ROWS, SIDE = 120, 80, 0.4  # of the small ones; side [m]
HEAVY, DENSITY, SPEED = 8.0, 8.0, 40.0  # side [m], density [kg/m^2], speed [m/s] of the other
MOMENTUM = DENSITY * HEAVY * HEAVY * SPEED  # [kg m/s]


@scene(
    "Benchmark/Smash",
    shows=(
        Criterion(
            "in parts of what it was, momentum has changed by",
            lambda world: abs(world.diagnostics().momentum.x / MOMENTUM - 1.0),
            unit="",
            after=1.25,
            at_most=1e-4,  # ten thousand bodies' rounding
        ),
        Criterion(
            "of its speed, the heavy box has left",
            lambda world: float(world.velocities[0, 0]) / SPEED,
            unit="",
            after=1.25,
            at_least=0.3,  # as much if all moved on as one: 512 kg and 1,536 kg
            at_most=0.98,
        ),
    ),
    view=(30.0, 0.0, 85.0),
    gravity=(0.0, 0.0),
)
def smash(world: World) -> None:
    """A box of 8 m flies into 9,600 small ones, without gravity.

    As Box2D's smash. There the small ones sleep until they are hit, and collision is continuous; here all are awake.
    """
    world.create_body(Box(HEAVY, HEAVY), position=(-20.0, 0.0), velocity=(SPEED, 0.0), density=DENSITY, friction=ROUGH)
    places = grid_places(COLUMNS, ROWS, 30.0, -0.5 * ROWS * SIDE, SIDE, SIDE)
    world.create_bodies(Box(SIDE, SIDE), positions=places, friction=ROUGH)
