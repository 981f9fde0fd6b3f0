"""Bodies of several shapes: thrown, they turn about a centre of mass that none of their shapes may hold."""

from __future__ import annotations

import math

from engine import Body, Box, Capsule, Circle, Polygon, World
from sandbox.lab.references import flight, flight_lag
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor
from sandbox.scenes.registry import scene

FLIGHT = 1.2  # how long they are watched: none has landed [s]
STARTS = ((-7.5, 2.5), (-4.4, 3.0), (-1.0, 3.5), (2.8, 4.0))  # of the centres of mass, out of each other's reach [m]
THROWN = (2.0, 9.5)  # velocity [m/s]
SPIN = -5.0  # [rad/s]


def hammer(world: World) -> Body:
    """A light handle and a head of ten times its density."""
    body = world.create_body(Box(0.2, 1.6), density=1.0, friction=ROUGH)
    body.add_shape(Box(0.9, 0.4), density=10.0, offset=(0.0, 0.9), friction=ROUGH)
    return body


def wrench(world: World) -> Body:
    """A capsule with a forked head: two triangles and a ring segment made of boxes."""
    body = world.create_body(Capsule(1.2, 0.15), friction=ROUGH)
    for side in (-1.0, 1.0):
        jaw = ((0.0, 0.0), (0.6, side * 0.15), (0.1, side * 0.45))
        body.add_shape(Polygon(jaw), density=4.0, offset=(0.6, side * 0.05), friction=ROUGH)
    return body


def dumbbell(world: World) -> Body:
    """A thin bar, and two discs of different weight."""
    body = world.create_body(Box(1.6, 0.12), friction=ROUGH)
    body.add_shape(Circle(0.45), density=1.0, offset=(-0.8, 0.0), friction=ROUGH)
    body.add_shape(Circle(0.45), density=6.0, offset=(0.8, 0.0), friction=ROUGH)
    return body


def angle_iron(world: World) -> Body:
    """Two plates at a right angle: their centre of mass lies in neither."""
    body = world.create_body(Box(1.6, 0.2), offset=(0.8, 0.1), friction=ROUGH)
    body.add_shape(Box(0.2, 1.4), offset=(0.1, 0.9), friction=ROUGH)
    return body


MADE = (hammer, wrench, dumbbell, angle_iron)


def off_the_parabola(world: World) -> float:
    """The farthest that a centre of mass is from where a thrown point would be [m]."""
    time = world.time
    return max(
        math.dist(body.center, (x + THROWN[0] * time, flight(y, THROWN[1], GRAVITY, time)))
        for body, (x, y) in zip(world.bodies[1:], STARTS, strict=True)
    )


@scene(
    "Shapes/Compounds",
    shows=Criterion(
        "a centre of mass is off its parabola by",
        off_the_parabola,
        unit="m",
        after=FLIGHT,
        at_most=lambda world, dt: 1.001 * flight_lag(GRAVITY, dt / world.settings.substeps, FLIGHT),
    ),
    view=(0.0, 5.0, 15.0),
)
def compounds(world: World) -> None:
    """A hammer, a wrench, a dumbbell and an angle iron are thrown: their centres of mass fly along parabolas."""
    add_floor(world, 60)
    for make, (x, y) in zip(MADE, STARTS, strict=True):
        body = make(world)
        body.position = (x - body.center.x, y - body.center.y)
        body.velocity = THROWN
        body.angular_velocity = SPIN
