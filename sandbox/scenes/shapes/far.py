"""Ten kilometres from the origin, nothing behaves otherwise."""

from __future__ import annotations

import numpy as np

from engine import Box, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene

FAR = 10_000.0  # [m]
BOXES = 8


def add_tower(world: World, x: float) -> None:
    """Boxes that fall onto each other, each a little off the one below."""
    world.create_body(Box(40, 2), position=(x, -1.0), kind="static", friction=ROUGH)
    for k in range(BOXES):
        position = (x + 0.02 * (-1.0) ** k, 0.6 + 1.1 * k)
        world.create_body(Box(1, 1), position=position, friction=ROUGH)


def off_its_twin(world: World) -> float:
    """The farthest that a body is from where it would be, had it all happened at the origin [m]."""
    twin = World(**world.settings.to_dict())
    add_tower(twin, 0.0)
    for _ in range(world.step_count):
        twin.step(world.time / world.step_count)
    return float(np.abs(world.positions - twin.positions - (FAR, 0.0)).max())


@scene(
    "Shapes/Far From Origin",
    shows=Criterion("a box is off where it would be at the origin by", off_its_twin, "m", 10.0, 1e-3),
    view=(FAR, 4.5, 12.0),
)
def far_from_origin(world: World) -> None:
    """Eight boxes settle 10 km from the origin as they would at it: positions are doubles, differences small."""
    add_tower(world, FAR)
