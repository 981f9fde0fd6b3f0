"""A pinball table: two flippers on motors, and bumpers that throw the ball back."""

from __future__ import annotations

import math

from engine import Capsule, Chain, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import turned
from sandbox.scenes.registry import Drive, scene

HALF, TOP = 8.0, 22.0  # half of the table's width, and how high it is [m]
FLIPPER, HUB = 2.7, (3.6, 3.0)  # length of a flipper; where the right one turns [m]
REST, KICK = 0.5, 1.0  # how far a flipper hangs, and how far it turns up [rad]
FLIP = 20.0  # speed of a flipper [rad/s]
BUMPERS = ((-3.5, 14.5), (3.5, 14.5), (0.0, 17.5), (0.0, 11.5), (-6.0, 11.0), (6.0, 11.0))
BOUNCE = 1.0  # restitution of a bumper
BUMPER, BALL = 0.9, 0.4  # radii [m]
PULL = 6.0  # of gravity, down the table [m/s^2]
BALLS = ((-3.3, 19.0), (0.2, 20.5), (3.4, 18.0))


def lost(world: World) -> float:
    """Balls that are not on the table."""
    balls = world.positions[-len(BALLS) :]
    return float(sum(abs(x) > HALF or not -0.5 < y < TOP for x, y in balls))


DROPS, RETURNS = 0.7, 1.0  # none has hit anything until then; the one above the middle has, by then [s]


def dropped(world: World) -> float:
    """How far the ball that has fallen least has fallen, in parts of g t^2 / 2."""
    heights = [y for _, y in BALLS]
    return float((heights - world.positions[-len(BALLS) :, 1]).min()) / (0.5 * PULL * DROPS**2)


def rebound() -> float:
    """How fast the ball above the middle's bumper is thrown up [m/s]: its speed, turned by twice the angle at which it
    hits.
    """
    (x, y), (hub_x, hub_y) = BALLS[1], BUMPERS[2]
    sine = (x - hub_x) / (BUMPER + BALL)
    fall = y - hub_y - (BUMPER + BALL) * math.sqrt(1.0 - sine * sine)
    return math.sqrt(2.0 * PULL * fall) * (1.0 - 2.0 * sine * sine)


@scene(
    "Joints/Pinball",
    shows=(
        Criterion("balls that have left the table:", lost, "", 6.0, at_most=0.0, throughout=True),
        Criterion(
            "the flippers' angles are off where they rest by",
            lambda world: max(abs(turned(world, k)) for k in range(2)),
            unit="rad",
            after=6.0,
            at_most=0.1,
        ),
        Criterion(
            "in flight, each ball has fallen, in parts of g t^2 / 2, by",
            dropped,
            unit="",
            after=DROPS,
            at_least=lambda world, dt: 0.99 - dt / DROPS,  # steps of first order are off by g h t / 2
            at_most=lambda world, dt: 1.01 + dt / DROPS,
        ),
        Criterion(
            "the first ball that a bumper throws up rises at",
            lambda world: float(world.velocities[-len(BALLS) + 1, 1]),
            unit="m/s",
            after=RETURNS,
            at_least=0.9 * rebound(),  # the bumper takes nothing; its friction and the time step take a little
            at_most=1.1 * rebound(),
            throughout=True,
        ),
    ),
    drives=(
        Drive("left flipper", (0,), FLIP, {"flip left": 1.0}, {"flip left": "arrowleft"}, released=-1.0),
        Drive("right flipper", (1,), -FLIP, {"flip right": 1.0}, {"flip right": "arrowright"}, released=-1.0),
    ),
    view=(0.0, 11.0, 24.0),
    gravity=(0.0, -PULL),
)
def pinball(world: World) -> None:
    """Three balls among bumpers: flip them up again, or they are lost."""
    table = world.create_body(kind="static")
    hub_x, hub_y = HUB
    gutter = 0.35
    right = [(HALF, TOP - 4.0), (HALF, hub_y + 3.2), (hub_x + 0.2, hub_y + gutter), (hub_x + 0.2, -0.5)]
    arch = [(HALF * math.cos(0.1 * math.pi * k), TOP - 4.0 + 4.0 * math.sin(0.1 * math.pi * k)) for k in range(1, 10)]
    left = [(-x, y) for x, y in reversed(right)]
    table.add_shape(Chain((*reversed(right), *arch, *reversed(left)), closed=True), friction=0.1, restitution=0.3)
    for x, y in BUMPERS:
        table.add_shape(Circle(BUMPER), offset=(x, y), friction=0.1, restitution=BOUNCE)
    for side in (-1.0, 1.0):
        angle = math.pi + REST if side > 0.0 else -REST
        middle = (side * hub_x + 0.5 * FLIPPER * math.cos(angle), hub_y + 0.5 * FLIPPER * math.sin(angle))
        flipper = world.create_body(Capsule(FLIPPER, 0.25), position=middle, angle=angle, density=2.0, friction=0.4)
        limits = (-KICK, 0.0) if side > 0.0 else (0.0, KICK)
        world.create_joint_revolute(
            table, flipper, anchor=(side * hub_x, hub_y), lower=limits[0], upper=limits[1],
            motor_speed=side * FLIP, max_motor_torque=3000.0, collide_connected=False,
        )  # fmt: skip
    for place in BALLS:
        world.create_body(Circle(BALL), position=place, density=1.0, friction=0.1, restitution=0.3)
