"""A car on a hilly road, with a ramp to jump from: two wheels on springs, driven by their motors."""

from __future__ import annotations

import math

from engine import Body, Box, Chain, Circle, Polygon, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import Point
from sandbox.scenes.registry import Drive, scene

LEFT, RAMP, LANDING, RIGHT = -25.0, 10.0, 14.0, 29.0  # of the road: its ends, and where it is interrupted [m]
DEEP, LEVEL = -5.0, 2.5 * math.pi  # floor of the gap; how long the road goes down behind it [m]
START = -22.0  # of the car [m]
WHEEL, BASE = 0.5, 2.0  # radius of a wheel, and from one to the other [m]
HERTZ, DAMPING = 4.0, 0.7  # of the suspension
SPEED, TORQUE = 24.0, 60.0  # of each motor [rad/s], [N m]
GRIP = 1.2  # friction of the tyres
BODY = Polygon(((-1.6, -0.15), (1.6, -0.15), (1.6, 0.1), (0.4, 0.6), (-1.1, 0.6), (-1.6, 0.3)))


def road(x: float) -> float:
    """Its height: hills, and the ramp [m]."""
    if x >= LANDING:
        return 0.6 * math.cos(0.4 * min(x - LANDING, LEVEL)) - 1.2
    hills = 0.8 * math.sin(0.35 * (x - LEFT)) ** 2 * min(1.0, (x - LEFT) / 15.0)
    up = max(0.0, x - (RAMP - 5.0)) / 5.0
    return hills * max(0.0, 1.0 - 2.0 * up) + 1.3 * up * up


def stretch(first: float, last: float) -> list[Point]:
    """Points of the road, half a metre apart."""
    count = round(2.0 * (last - first))
    return [(x, road(x)) for x in (first + (last - first) * k / count for k in range(count + 1))]


def add_car(world: World, x: float) -> Body:
    """A chassis and two wheels."""
    ground = road(x)
    chassis = world.create_body(BODY, position=(x, ground + 1.1), density=12.0)
    for side in (-1.0, 1.0):
        hub = (x + 0.5 * side * BASE, ground + WHEEL + 0.05)
        wheel = world.create_body(Circle(WHEEL), position=hub, density=25.0, friction=GRIP)
        world.create_joint_wheel(
            chassis, wheel, anchor=hub, axis=(0.0, 1.0), hertz=HERTZ, damping_ratio=DAMPING, lower=-0.25, upper=0.25,
            motor_speed=-SPEED, max_motor_torque=TORQUE, collide_connected=False,
        )  # fmt: skip
    return chassis


@scene(
    "Joints/Car",
    shows=(
        Criterion("the car has got to", lambda world: float(world.positions[1, 0]), "m", 9.0, at_least=LANDING + 2.0),
        Criterion("it leans by", lambda world: abs(float(world.angles[1])), "rad", 9.0, at_most=0.6),
    ),
    drives=(
        Drive(
            "throttle",
            joints=(0, 1),
            gain=-SPEED,
            buttons={"back": -1.0, "brake": 0.0, "forward": 1.0},
            keys={"back": "arrowleft", "brake": "arrowdown", "forward": "arrowright"},
        ),
    ),
    view=(2.0, 3.0, 42.0),
)
def car(world: World) -> None:
    """A car drives over hills and jumps across a gap, if it is fast enough; then it runs into boxes."""
    ground = world.create_body(kind="static")
    left, right = stretch(LEFT, RAMP), stretch(LANDING, RIGHT)
    outline = [
        (LEFT, 5.0), *left, (RAMP, DEEP), (LANDING, DEEP), *right, (RIGHT, 5.0),
    ]  # fmt: skip
    ground.add_shape(Chain(tuple(outline)), friction=0.8)
    add_car(world, START)
    for k in range(12):
        place = (RIGHT - 4.2 + 0.82 * (k % 4), road(RIGHT - 5.0) + 0.4 + 0.8 * (k // 4))
        world.create_body(Box(0.8, 0.8), position=place, density=2.0, friction=0.5)
