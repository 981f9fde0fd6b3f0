"""What stays where it is: in a corner, on a slope; and what should not be felt: the seams of a floor."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from engine.constants import SLOP
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor
from sandbox.scenes.registry import scene
from sandbox.scenes.robustness.chains import CALM, fastest

# --- wedge ------------------------------------------------------------------------------------------------------------

OPENING = math.radians(15.0)  # of each wall from the vertical
BALLS = ((0.3, -4.0), (0.15, 0.0), (0.6, 4.0))  # radius, and where its wedge is [m]


def lifted(world: World) -> float:
    """How far a ball is off where it touches both walls: r / sin(opening) above the corner [m]."""
    rests = [(x, radius / math.sin(OPENING)) for radius, x in BALLS]
    return float(np.hypot(*(world.positions[1:] - rests).T).max())


@scene(
    "Robustness/Wedge",
    shows=(
        Criterion("a ball is off where it touches both walls by", lifted, "m", 5.0, at_most=SLOP / math.sin(OPENING)),
        Criterion("the fastest ball still moves at", fastest, "m/s", 5.0, at_most=CALM),
    ),
    view=(0.0, 2.0, 10.0),
)
def wedge(world: World) -> None:
    """Balls fall into wedges and stay there, each as deep as its size lets it. As Box2D's."""
    walls = world.create_body(kind="static")
    for _, x in BALLS:
        for side in (-1.0, 1.0):
            end = (x + side * 4.0 * math.sin(OPENING), 4.0 * math.cos(OPENING))
            walls.add_shape(Segment((x, 0.0), end), friction=0.0)
    for radius, x in BALLS:
        world.create_body(Circle(radius), position=(x + 0.3 * radius, 3.5), friction=0.0)


# --- creep ------------------------------------------------------------------------------------------------------------

SLOPE, GRIP = math.radians(25.0), 0.6  # tan(25 degrees) = 0.47
SIDES = (0.3, 1.0, 2.0)  # of boxes [m]


def upon(x: float, up: float) -> tuple[float, float]:
    """A point so far up the slope and above it [m]."""
    c, s = math.cos(SLOPE), math.sin(SLOPE)
    return c * x - s * up, s * x + c * up


DOWN, SLIDES = -4.5, 0.8  # where the one without friction begins [m], and until when it is on the slope [s]


def slid(world: World) -> float:
    """How far that has come down the slope, in parts of g sin(slope) t^2 / 2."""
    c, s = math.cos(SLOPE), math.sin(SLOPE)
    way = DOWN - float(world.positions[-1] @ (c, s))
    return way / (0.5 * GRAVITY * s * SLIDES**2)


def crept(world: World) -> float:
    """How far a box has slid, along the slope, at most [m]."""
    c, s = math.cos(SLOPE), math.sin(SLOPE)
    along = world.positions[1 : 1 + len(SIDES)] @ (c, s)
    return float(np.abs(along - [3.0 * (k - 1) for k in range(len(SIDES))]).max())


@scene(
    "Robustness/Friction Creep",
    shows=(
        Criterion("a box has crept along the slope by", crept, "m", 10.0, at_most=1e-3),
        Criterion(
            "the box without friction has slid, in parts of g sin(slope) t^2 / 2,",
            slid,
            unit="",
            after=SLIDES,
            at_least=lambda world, dt: 0.99 - dt / SLIDES,  # steps of first order are off by g h t / 2
            at_most=lambda world, dt: 1.01 + dt / SLIDES,
        ),
    ),
    view=(0.0, 1.0, 8.0),
)
def friction_creep(world: World) -> None:
    """Boxes that friction holds on a slope do not creep by a millimetre in ten seconds; one without it slides off."""
    world.create_body(Box(12.0, 1.0), position=upon(0.0, -0.5), angle=SLOPE, kind="static", friction=GRIP)
    for k, side in enumerate(SIDES):
        place = upon(3.0 * (k - 1), 0.5 * side)
        world.create_body(Box(side, side), position=place, angle=SLOPE, friction=GRIP)
    world.create_body(Box(0.4, 0.4), position=upon(DOWN, 0.2), angle=SLOPE, friction=0.0)  # lest nothing happens


# --- seams ------------------------------------------------------------------------------------------------------------

SPEED, TILES = 5.0, 40  # [m/s]
BEGIN = -12.0 + 2.2 * np.arange(3)  # where they begin [m]
SLIDERS: tuple[tuple[Shape, float], ...] = ((Box(0.8, 0.8), 0.4), (Box(1.6, 0.4), 0.2), (Capsule(0.7, 0.3), 0.3))


def bumped(world: World) -> float:
    """The fastest that anything moves up or down, or turns, 1 m from its middle [m/s]."""
    return float(max(np.abs(world.velocities[1:, 1]).max(), np.abs(world.angular_velocities[1:]).max()))


def sunk(world: World) -> float:
    """How far what lies flat is under where it lies, at most [m]."""
    return float(max(above - y for (_, above), y in zip(SLIDERS, world.positions[1:, 1], strict=True)))


SMOOTH = (
    Criterion("what slides over seams moves up or down at", bumped, "m/s", 3.0, at_most=0.01, throughout=True),
    Criterion(
        "what slides over seams has lost",
        lambda world: float(np.abs(world.velocities[1:, 0] - SPEED).max()),
        unit="m/s",
        after=3.0,
        at_most=0.01 * SPEED,
    ),
    Criterion(
        "what slides over seams has come, in parts of v t, to",
        lambda world: float((world.positions[1:, 0] - BEGIN).min()) / (3.0 * SPEED),
        unit="",
        after=3.0,
        at_least=0.99,  # it may lose a hundredth of its speed
    ),
)


@scene(
    "Robustness/Seams",
    shows=Criterion("what slides over seams sinks into them by", sunk, "m", 1.0, at_most=SLOP, throughout=True),
    view=(0.0, 3.0, 24.0),
)
def seams(world: World) -> None:
    """Boxes and a capsule slide over a floor of tiles, of which nothing tells that they are one floor."""
    floor = world.create_body(kind="static")
    for k in range(TILES):
        floor.add_shape(Box(1.0, 1.0), offset=(k - 14.5, -0.5), friction=0.0)
    for x, (shape, above) in zip(BEGIN.tolist(), SLIDERS, strict=True):
        world.create_body(shape, position=(x, above), velocity=(SPEED, 0.0), friction=0.0)


# --- spinning ---------------------------------------------------------------------------------------------------------

SPIN, CELL = 100.0, 3.0  # [rad/s]; half of the cell's side [m]


HUBS = np.array([(-1.5, -0.5), (1.5, 0.5), (0.0, 1.8)])  # where the middles begin [m]
FLIGHT = 0.4  # nothing touches anything until then [s]: the lowest falls 0.8 of 1.7 m


def turned(world: World) -> float:
    """How far the one that has turned least has turned, in parts of w t."""
    return float(np.abs(world.body_records()["angle"][1:]).min()) / (SPIN * FLIGHT)


def dropped(world: World) -> float:
    """How far the one that has fallen least has fallen, in parts of g t^2 / 2."""
    return float((HUBS[:, 1] - world.positions[1:, 1]).min()) / (0.5 * GRAVITY * FLIGHT**2)


def escaped(world: World) -> float:
    """How far anything is out of the cell [m]; < 0: all is inside."""
    return float(np.abs(world.positions[1:]).max()) - CELL


@scene(
    "Robustness/Fast Spin",
    shows=(
        Criterion("is how far anything is out of the cell", escaped, "m", 6.0, at_most=0.0, throughout=True),
        Criterion(
            "the fastest turns, of the speed it began with, at",
            lambda world: float(np.abs(world.angular_velocities).max()) / SPIN,
            unit="",
            after=6.0,
            at_most=1.01,
            throughout=True,
        ),
        Criterion(  # in flight nothing turns it slower or faster, and nothing holds it
            "the slowest turns, of the speed it began with, at",
            lambda world: float(np.abs(world.angular_velocities[1:]).min()) / SPIN,
            unit="",
            after=FLIGHT,
            at_least=0.99,
        ),
        Criterion("in flight, each has turned, in parts of w t, by", turned, "", FLIGHT, at_least=0.99, at_most=1.01),
        Criterion(
            "in flight, each has fallen, in parts of g t^2 / 2, by",
            dropped,
            unit="",
            after=FLIGHT,
            at_least=lambda world, dt: 0.99 - dt / FLIGHT,  # steps of first order are off by g h t / 2
            at_most=lambda world, dt: 1.01 + dt / FLIGHT,
        ),
    ),
    view=(0.0, 0.0, 8.0),
)
def fast_spin(world: World) -> None:
    """A rod, a cross and a triangle turn sixteen times a second in a cell whose walls have no thickness."""
    corners = ((-CELL, -CELL), (CELL, -CELL), (CELL, CELL), (-CELL, CELL))
    world.create_body(Chain(corners, closed=True), kind="static", friction=ROUGH)
    world.create_body(Box(1.6, 0.1), position=tuple(HUBS[0]), angular_velocity=SPIN, friction=ROUGH)
    cross = world.create_body(Box(1.2, 0.15), position=tuple(HUBS[1]), angular_velocity=-SPIN, friction=ROUGH)
    cross.add_shape(Box(0.15, 1.2), friction=ROUGH)
    triangle = Polygon(((-0.5, -0.3), (0.5, -0.3), (0.0, 0.6)))
    world.create_body(triangle, position=tuple(HUBS[2]), angular_velocity=SPIN, friction=ROUGH)


# --- at rest ----------------------------------------------------------------------------------------------------------


@scene(
    "Robustness/Single Box",
    shows=(
        Criterion("the box still moves at", fastest, "m/s", 5.0, at_most=1e-3),
        Criterion("the box has drifted by", lambda world: abs(float(world.positions[1, 0])), "m", 5.0, at_most=1e-3),
        Criterion(
            "the box is above or under where it lies by",
            lambda world: abs(float(world.positions[1, 1]) - 0.5),
            unit="m",
            after=5.0,
            at_most=SLOP,
        ),
    ),
    view=(0.0, 1.5, 6.0),
)
def single_box(world: World) -> None:
    """A box is set down from a centimetre, and lies still: the least that one can ask for."""
    add_floor(world, 20)
    world.create_body(Box(1, 1), position=(0.0, 0.51), friction=ROUGH)
