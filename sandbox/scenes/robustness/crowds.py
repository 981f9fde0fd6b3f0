"""Too many: in too little room, in one place, around one point, on one body."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Circle, World
from engine.constants import SLOP
from sandbox.lab.sag import BOX_INERTIA, predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor, and_a_fifth, but_a_fifth, nearest
from sandbox.scenes.registry import scene
from sandbox.scenes.robustness.chains import fastest


def add_room(world: World, half: float, height: float) -> Body:
    """Four thick walls around x from -half to half, y from 0 to height."""
    room = world.create_body(kind="static")
    for x, y, width, tall in (
        (0.0, -0.5, 2.0 * half + 2.0, 1.0), (0.0, height + 0.5, 2.0 * half + 2.0, 1.0),
        (-half - 0.5, 0.5 * height, 1.0, height), (half + 0.5, 0.5 * height, 1.0, height),
    ):  # fmt: skip
        room.add_shape(Box(width, tall), offset=(x, y), friction=ROUGH)
    return room


def outside(world: World, half: float, height: float) -> float:
    """The farthest that a body's middle is out of the room [m]; < 0: all are inside."""
    x, y = world.positions[1:].T
    return float(max((np.abs(x) - half).max(), (-y).max(), (y - height).max()))


def overlap(world: World) -> float:
    """The deepest of all contacts [m]."""
    return world.diagnostics().max_penetration


# --- confined ---------------------------------------------------------------------------------------------------------

ROOM, ACROSS, UP, BALL = 10.0, 12, 13, 0.37  # side of the room; balls; radius of one [m]
PITCH = 0.68  # from one to the next, in the beginning: they overlap by 0.06 m
SETTLES = 8.0  # [s]
CREEP = 0.14  # of what has fallen a millimetre [m/s]


@scene(
    "Robustness/Confined",
    shows=(
        Criterion("a ball is out of the room by", lambda w: outside(w, 0.5 * ROOM, ROOM), "m", SETTLES, 0.0),
        Criterion("the deepest overlap left is", overlap, "m", SETTLES, at_most=0.05 * BALL),
        Criterion(
            "the middles of two balls are apart by at least",
            lambda world: nearest(world, 1),
            unit="m",
            after=SETTLES,
            at_least=1.95 * BALL,  # two radii less what may be left of the overlap: they began at 0.68 m
        ),
        Criterion("the fastest ball still moves at", fastest, "m/s", SETTLES, at_most=CREEP),
    ),
    view=(0.0, 5.0, 12.0),
)
def confined(world: World) -> None:
    """Balls that overlap push each other apart in a closed room that they all but fill. As Box2D's."""
    add_room(world, 0.5 * ROOM, ROOM)
    across, up = np.meshgrid(PITCH * (np.arange(ACROSS) - 0.5 * (ACROSS - 1)), 0.5 + PITCH * np.arange(UP))
    places = np.column_stack([across.ravel(), up.ravel()])
    world.create_bodies(Circle(BALL), positions=places, friction=ROUGH, rolling_resistance=0.05)


# --- all in one place -------------------------------------------------------------------------------------------------

TWINS, SIDE = 60, 0.5  # boxes, and the side of one [m]
PARTS = 12.0  # [s]


APART = Criterion("the deepest overlap left is", overlap, "m", PARTS, at_most=0.05 * SIDE)
SPREAD = Criterion(
    "the middles of two boxes are apart by at least",
    lambda world: nearest(world, 1),
    unit="m",
    after=PARTS,
    at_least=0.95 * SIDE,  # however they lie: each has a disc of its side across in it
)
GENTLY = Criterion(
    "a box lies off the middle by",
    lambda world: float(np.abs(world.positions[1:, 0]).max()),
    unit="m",
    after=PARTS,
    at_most=TWINS * SIDE,  # a row of all of them, to one side
)


@scene(
    "Robustness/All in One Place",
    shows=APART,
    view=(0.0, 6.0, 14.0),
)
def all_in_one_place(world: World) -> None:
    """Sixty boxes begin in one and the same place: they get apart, some of them fast. As Rapier's."""
    add_floor(world, 400)
    world.create_bodies(Box(SIDE, SIDE), positions=np.tile((0.0, 1.0), (TWINS, 1)), friction=ROUGH)


# --- rush -------------------------------------------------------------------------------------------------------------

RUSHING, PULL, DUST = 90, 60.0, 0.25  # bodies; attraction of the middle [m^3/s^2]; radius of one [m]
RUSHES = 10.0  # [s]
NEAREST = 1.0 + DUST  # to the middle [m]
INNERMOST, FARTHEST = 3.0, 9.0  # rings of discs, in the beginning [m]


@scene(
    "Robustness/Rush",
    shows=(
        Criterion(
            "the fastest moves at",
            fastest,
            unit="m/s",
            after=RUSHES,
            at_most=1.1 * math.sqrt(2.0 * PULL * (1.0 / NEAREST - 1.0 / FARTHEST)),  # it has fallen so far, and a tenth
            throughout=True,
        ),
        Criterion(
            "the fastest has come to",
            fastest,
            unit="m/s",
            after=RUSHES,
            at_least=0.9 * math.sqrt(2.0 * PULL * (1.0 / (NEAREST + 2.0 * DUST) - 1.0 / INNERMOST)),
            throughout=True,  # the nearest have fallen onto the middle, or onto one disc that lies there
        ),
        Criterion(
            "in the end, the farthest is from the middle by",
            lambda world: float(np.hypot(*world.positions[1:].T).max()),
            unit="m",
            after=RUSHES,
            at_most=math.sqrt(1.0 + 2.0 * RUSHING * DUST**2),  # all lie around it, as loose as half air
        ),
        Criterion("in the end, the fastest moves at", fastest, "m/s", RUSHES, at_most=0.5),
        Criterion("the deepest overlap is", overlap, "m", RUSHES, at_most=0.1 * DUST),
    ),
    gravity=(0.0, 0.0),
    view=(0.0, 0.0, 19.0),
)
def rush(world: World) -> None:
    """Ninety discs fall from all sides onto what attracts them, and come to rest around it. As Solver2D's."""
    world.create_body(Circle(1.0), kind="static", attraction=PULL, friction=ROUGH)
    rings = np.repeat(np.linspace(INNERMOST, FARTHEST, 5), RUSHING // 5)
    turns = math.pi * (3.0 - math.sqrt(5.0)) * np.arange(RUSHING)  # the golden angle
    places = np.column_stack([rings * np.cos(turns), rings * np.sin(turns)])
    world.create_bodies(Circle(DUST), positions=places, friction=ROUGH, rolling_resistance=0.05)


# --- on one body ------------------------------------------------------------------------------------------------------

GUESTS, SEAT, DROPPED = 70, 1.1, 0.02  # boxes on a plank, from one to the next, and from how high they come [m]
PLANK = (GUESTS * SEAT + 2.0, 1.0)
SEATED = np.array([(0.0, 0.5)] + [(SEAT * (k - 0.5 * (GUESTS - 1)), 1.5) for k in range(GUESTS)])


def banquet() -> Structure:
    """The plank on its ends, as the engine sees it, and boxes on it."""
    points = [Point(GROUND, 0, side * 0.5 * PLANK[0], 0.0) for side in (-1.0, 1.0)]
    for k, (x, _) in enumerate(SEATED[1:]):
        points += [Point(0, k + 1, x - 0.5, 1.0), Point(0, k + 1, x + 0.5, 1.0)]
    masses = np.append(PLANK[0] * PLANK[1], np.ones(GUESTS))
    inertias = np.append(masses[0] * (PLANK[0] ** 2 + PLANK[1] ** 2) / 12.0, np.full(GUESTS, BOX_INERTIA))
    return Structure(SEATED, masses, inertias, points)


@scene(
    "Robustness/Overflow of Colours",
    shows=(
        Criterion(
            "a body has sunk by",
            lambda world: float((SEATED[:, 1] - world.positions[1:, 1]).max()),
            unit="m",
            after=5.0,
            at_most=and_a_fifth(lambda world, dt: predicted_sink(world, dt, banquet(), 1)),
            at_least=but_a_fifth(lambda world, dt: predicted_sink(world, dt, banquet(), 1)),
        ),
        Criterion(
            "a body is over its place by",
            lambda world: float((world.positions[1:, 1] - SEATED[:, 1]).max()),
            unit="m",
            after=5.0,
            at_most=SLOP,  # they came down from twice that
        ),
    ),
    view=(0.0, 10.0, 62.0),
)
def overflow_of_colours(world: World) -> None:
    """Seventy boxes on one plank: more contacts of a body than there are colours to solve them side by side."""
    add_floor(world, 200)
    world.create_body(Box(*PLANK), position=tuple(SEATED[0]), friction=ROUGH)
    world.create_bodies(Box(1, 1), positions=SEATED[1:] + np.array([0.0, DROPPED]), friction=ROUGH)


# --- turned over ------------------------------------------------------------------------------------------------------

CUBES, CUBE, HALL = 64, 0.6, 8.0  # boxes; side of one; side of the room [m]
TURNED = 10.0  # [s]


@scene(
    "Robustness/Turned Over",
    shows=(
        Criterion("a box is out of the room by", lambda w: outside(w, 0.5 * HALL, HALL), "m", TURNED, 0.0),
        Criterion(
            "the fastest box moves at",
            fastest,
            unit="m/s",
            after=TURNED,
            at_most=lambda world, dt: math.sqrt(2.0 * GRAVITY * HALL) + GRAVITY * dt,  # it has fallen through the room
            throughout=True,
        ),
        Criterion("the deepest overlap is", overlap, "m", TURNED, at_most=0.05 * CUBE),
    ),
    view=(0.0, 4.0, 10.0),
)
def turned_over(world: World) -> None:
    """Boxes in a closed room, which `tumble stability` turns over again and again: gravity is up, then down."""
    add_room(world, 0.5 * HALL, HALL)
    across, up = np.meshgrid(0.7 * (np.arange(8) - 3.5), 0.4 + 0.7 * np.arange(8))
    places = np.column_stack([across.ravel(), up.ravel()])
    world.create_bodies(Box(CUBE, CUBE), positions=places, angles=0.1 * np.arange(CUBES), friction=ROUGH)
