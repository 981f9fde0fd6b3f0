"""Machines with little in them that carries much: a cart on light wheels, and a telescope with a weight on it."""

from __future__ import annotations

import numpy as np

from engine import Body, Box, Circle, PrismaticJoint, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import gaps
from sandbox.scenes.parts import ROUGH, add_floor, and_a_fifth
from sandbox.scenes.registry import scene
from sandbox.scenes.robustness.chains import CALM, fastest, hung

# --- cart -------------------------------------------------------------------------------------------------------------

WHEEL, AXLES = 0.4, (-1.2, 1.2)  # radius of a wheel; where they are along the cart [m]
SPEED, FROM = 4.0, -10.0  # of the cart [m/s]; where it begins [m]
BUMPS = (-4.0, 0.0, 4.0)
BUMP = 0.05  # height of a bump [m]
LOAD = 100.0  # of what lies on the cart [kg/m^2]: 225 kg on wheels of 5 kg
ROLLS = 5.0  # [s]


@scene(
    "Robustness/Cart",
    shows=(
        gaps(ROLLS, at_most=0.02),  # a twentieth of a wheel
        Criterion(
            "the load has moved on its cart by",
            lambda world: abs(float(world.positions[4, 0] - world.positions[1, 0])),
            unit="m",
            after=ROLLS,
            at_most=0.1,
        ),
        Criterion("the cart has got to", lambda world: float(world.positions[1, 0]), "m", ROLLS, at_least=BUMPS[-1]),
    ),
    view=(0.0, 3.0, 18.0),
)
def cart(world: World) -> None:
    """A cart of light wheels rolls over bumps, with a load of 45 times a wheel's mass. As Box2D's."""
    floor = add_floor(world, 60)
    for x in BUMPS:
        radius = (1.0 + BUMP**2) / (2.0 * BUMP)  # of a bump 2 m long
        floor.add_shape(Circle(radius), offset=(x, 1.0 + BUMP - radius), friction=ROUGH)
    top = 2.0 * WHEEL
    body = world.create_body(
        Box(3.4, 0.3), position=(FROM, top + 0.15), velocity=(SPEED, 0.0), density=10.0, friction=ROUGH
    )
    for x in AXLES:
        wheel = world.create_body(
            Circle(WHEEL), position=(FROM + x, WHEEL), velocity=(SPEED, 0.0), angular_velocity=-SPEED / WHEEL,
            density=10.0, friction=ROUGH,
        )  # fmt: skip
        world.create_joint_revolute(body, wheel, anchor=(FROM + x, WHEEL), collide_connected=False)
    world.create_body(
        Box(1.5, 1.5), position=(FROM, top + 0.3 + 0.75), velocity=(SPEED, 0.0), density=LOAD, friction=ROUGH
    )


# --- telescope --------------------------------------------------------------------------------------------------------

TUBES, TRAVEL, TUBE = 6, 1.0, (0.4, 0.8)  # tubes; how far each slides; size of one [m]
HEAVY = 50.0  # of what hangs on the last one, in tubes
HUNG = 8.0  # [s]


def overdrawn(world: World) -> float:
    """How far a tube is beyond its limit, at most [m]."""
    return max(joint.translation - TRAVEL for joint in world.joints if isinstance(joint, PrismaticJoint))


def aside(world: World) -> float:
    """How far a tube is beside the axis, at most [m]."""
    return float(np.abs(world.positions[:, 0]).max())


@scene(
    "Robustness/Telescope",
    shows=(
        Criterion(
            "a tube is drawn out beyond its limit by",
            overdrawn,
            unit="m",
            after=HUNG,
            at_most=and_a_fifth(hung(HEAVY, TUBES)),
        ),
        Criterion(
            "the tube that is drawn out least lacks, of its travel,",
            lambda world: max(
                TRAVEL - joint.translation for joint in world.joints if isinstance(joint, PrismaticJoint)
            ),
            unit="m",
            after=HUNG,
            at_most=0.01 * TRAVEL,  # the weight of fifty hangs on each
        ),
        Criterion("a tube is beside the axis by", aside, "m", HUNG, at_most=0.01, throughout=True),
        Criterion("the fastest tube still moves at", fastest, "m/s", HUNG, at_most=CALM),
    ),
    view=(0.0, -3.0, 12.0),
)
def telescope(world: World) -> None:
    """Six tubes slide out of each other, and a weight of fifty of them hangs on the last."""
    before: Body = world.create_body(Box(1.0, 0.2), kind="static", mask=0)
    for k in range(TUBES):
        mass = HEAVY if k == TUBES - 1 else 1.0
        tube = world.create_body(Box(*TUBE), position=(0.0, -0.2 * (k + 1)), mass=mass, mask=0)
        world.create_joint_prismatic(
            before, tube, anchor=tube.position, axis=(0.0, -1.0), lower=0.0, upper=TRAVEL, collide_connected=False
        )
        before = tube
