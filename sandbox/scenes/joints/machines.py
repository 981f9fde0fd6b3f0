"""Machines: a scissor lift, a door that closes by itself, a windmill, and dominoes with levers between them."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import Point, gaps, turned
from sandbox.scenes.parts import ROUGH, add_floor
from sandbox.scenes.registry import Drive, scene

# --- scissor lift -----------------------------------------------------------------------------------------------------

STOREYS, BAR, FLAT = 3, 6.0, 0.25  # storeys; length of a bar [m]; its angle when the lift is down [rad]
CREEP = 0.5  # of the ram that drives it [m/s]
WIDTH = BAR * math.cos(FLAT)  # between the feet [m]
RISE = BAR * math.sin(FLAT)  # of a storey [m]
UP = 1.0  # angle of a bar when the lift is up [rad]


def tilt(world: World) -> float:
    """Of the lift's platform [rad]."""
    return abs(float(world.angles[1]))


@scene(
    "Joints/Scissor Lift",
    shows=(
        gaps(16.0, at_most=0.01),
        Criterion("the platform is off the level by", tilt, "rad", 16.0, at_most=0.01, throughout=True),
        Criterion(
            "the platform has risen to",
            lambda world: float(world.positions[1, 1]) - 0.2,
            unit="m",
            after=16.0,
            at_least=0.95 * STOREYS * BAR * math.sin(UP),
            at_most=1.05 * STOREYS * BAR * math.sin(UP),
        ),
    ),
    drives=(
        Drive(
            "lift",
            joints=(0,),
            gain=CREEP,
            buttons={"down": -1.0, "stop": 0.0, "up": 1.0},
            keys={"down": "arrowdown", "up": "arrowup"},
        ),
    ),
    view=(0.0, 8.5, 21.0),
)
def scissor_lift(world: World) -> None:
    """Eight bars, crossed: a ram pushes their middle up, and the platform with its load rises, always level."""
    floor = add_floor(world, 40)
    platform = world.create_body(
        Box(WIDTH + 2.0, 0.4), position=(0.0, STOREYS * RISE + 0.2), density=1.0, friction=ROUGH
    )
    bars = [
        [
            world.create_body(
                Box(BAR, 0.2), position=(0.0, (k + 0.5) * RISE), angle=side * FLAT, density=6.0, category=2, mask=0
            )
            for side in (1.0, -1.0)
        ]
        for k in range(STOREYS)
    ]
    left, right = -0.5 * WIDTH, 0.5 * WIDTH
    low, high = 1.5 * RISE, 1.5 * BAR * math.sin(UP)  # of the middle, where bars cross
    world.create_joint_distance(  # the ram
        floor, bars[1][0], anchor1=(0.0, 0.0), anchor2=(0.0, low), lower=low, upper=high, motor_speed=CREEP,
        max_motor_force=1e4,
    )  # fmt: skip
    for k, (rising, falling) in enumerate(bars):
        world.create_joint_revolute(rising, falling, anchor=(0.0, (k + 0.5) * RISE))
        if k:
            world.create_joint_revolute(bars[k - 1][1], rising, anchor=(left, k * RISE))
            world.create_joint_revolute(bars[k - 1][0], falling, anchor=(right, k * RISE))
    top = STOREYS * RISE
    world.create_joint_revolute(floor, bars[0][0], anchor=(left, 0.0))
    world.create_joint_wheel(floor, bars[0][1], anchor=(right, 0.0), axis=(1.0, 0.0), hertz=None)
    world.create_joint_revolute(platform, bars[-1][1], anchor=(left, top))
    world.create_joint_wheel(platform, bars[-1][0], anchor=(right, top), axis=(1.0, 0.0), hertz=None)
    for k in range(6):
        place = (-2.0 + 0.8 * k, top + 0.8)
        world.create_body(Box(0.7, 0.7), position=place, density=1.0, friction=ROUGH)


# --- door -------------------------------------------------------------------------------------------------------------

DOOR, HINGE = 3.0, (-1.5, 0.0)  # width of the door, and where it hangs [m]
OPENS = 1.2  # to either side [rad]
BALLS = ((0.6, -3.0, 4.0), (0.8, 7.0, -4.0), (0.4, -7.0, 2.5), (0.9, 8.0, -2.0), (0.2, -8.0, 1.5))
"""Where they begin, x and y [m], and their speed along y [m/s]."""


@scene(
    "Joints/Door",
    shows=(
        Criterion("the door was opened by", lambda w: abs(turned(w)), "rad", 10.0, at_least=0.5, throughout=True),
        Criterion(
            "the door was opened further than to its limit by",
            lambda w: abs(turned(w)) - OPENS,
            unit="rad",
            after=10.0,
            at_most=0.1,
            throughout=True,
        ),
        Criterion("after the last ball, the door is open by", lambda w: abs(turned(w)), "rad", 14.0, at_most=0.05),
    ),
    view=(0.0, 0.0, 17.0),
    gravity=(0.0, 0.0),
)
def door(world: World) -> None:
    """Balls roll through a doorway, seen from above: a spring closes the door behind each, limits stop it."""
    walls = world.create_body(kind="static")
    for side in (-1.0, 1.0):
        walls.add_shape(Box(6.0, 0.3), offset=(side * 4.6, 0.0))
    leaf = world.create_body(Box(DOOR - 0.1, 0.25), position=(HINGE[0] + 0.5 * DOOR, 0.0), density=2.0)
    world.create_joint_revolute(
        walls, leaf, anchor=HINGE, lower=-OPENS, upper=OPENS, hertz=0.5, damping_ratio=0.8, collide_connected=False
    )
    for x, y, speed in BALLS:
        world.create_body(Circle(0.45), position=(x, y), velocity=(0.0, speed), density=8.0)


# --- windmill ---------------------------------------------------------------------------------------------------------

HUB, SAIL, SAILS = (0.0, 7.0), 4.5, 4  # [m], [m]
TURNS = -1.2  # speed of its motor [rad/s]
GRAINS = 60


@scene(
    "Joints/Windmill",
    shows=(
        gaps(8.0, at_most=0.01),
        Criterion(
            "of the angle that its motor asks for, it has turned",
            lambda world: float(world.angles[1]) / (TURNS * world.time),
            unit="",
            after=8.0,
            at_least=0.9,
            at_most=1.01,
        ),
    ),
    view=(0.0, 6.5, 17.0),
)
def windmill(world: World) -> None:
    """A motor turns four sails, which toss about what rains on them."""
    ground = add_floor(world, 40)
    ground.add_shape(Box(0.8, 6.5), offset=(0.0, 4.25), category=2, mask=0)
    for side in (-1.0, 1.0):
        ground.add_shape(Box(0.4, 3.0), offset=(side * 8.0, 2.5))
    mill = world.create_body(Circle(0.5), position=HUB, density=2.0)
    for k in range(SAILS):
        turn = 2.0 * math.pi * k / SAILS
        middle = 0.5 * SAIL + 0.4
        arm = (middle * math.cos(turn), middle * math.sin(turn))
        mill.add_shape(Box(SAIL, 0.2), offset=arm, angle=turn, density=2.0, friction=ROUGH)
        tip = (SAIL * math.cos(turn) - 0.4 * math.sin(turn), SAIL * math.sin(turn) + 0.4 * math.cos(turn))
        mill.add_shape(Box(0.2, 0.8), offset=tip, angle=turn, density=2.0, friction=ROUGH)
    world.create_joint_revolute(ground, mill, anchor=HUB, motor_speed=TURNS, max_motor_torque=4000.0)
    row = np.arange(GRAINS)
    places = np.column_stack([0.55 * (row % 12 - 5.5) + 0.1 * (row // 12), 12.2 + 0.55 * (row // 12)])
    world.create_bodies(Circle(0.22), positions=places, density=2.0, friction=ROUGH)


# --- domino run -------------------------------------------------------------------------------------------------------

SHELVES, A_SHELF, PITCH = 5, 40, 0.4  # dominoes on a shelf, and from one to the next [m]
HEIGHT, THIN = 1.0, 0.12  # of a domino [m]
STOREY = 2.4  # from shelf to shelf [m]
SHELF = PITCH * (A_SHELF - 1)  # from the first domino on a shelf to the last [m]
OVER, UNDER = 0.85, 1.75  # that a lever reaches above its axis, and below [m]


def standing(world: World) -> float:
    """Dominoes that still stand."""
    return float(np.count_nonzero(np.abs(world.angles[1 : 1 + SHELVES * A_SHELF]) < math.radians(20.0)))


@scene(
    "Joints/Domino Run",
    shows=(
        Criterion(
            "dominoes that still stand after a fifth of the way:", standing, "", 8.0, at_least=100.0, at_most=180.0
        ),
        Criterion("dominoes that still stand at the end:", standing, "", 40.0, at_most=0.0),
    ),
    view=(0.5 * SHELF, 5.3, 14.0),
)
def domino_run(world: World) -> None:
    """Two hundred dominoes on five shelves: at the end of each a lever hands the wave on to the shelf below."""
    shelves = add_floor(world, 40, x=0.5 * SHELF)
    for row in range(1, SHELVES):
        shelves.add_shape(Box(SHELF + 0.5, 0.15), offset=(0.0, 1.0 + STOREY * row - 0.075), friction=ROUGH)
    for row in range(SHELVES - 1, -1, -1):  # the highest first
        way = 1.0 if (SHELVES - 1 - row) % 2 == 0 else -1.0
        for k in range(A_SHELF):
            x = 0.5 * SHELF + way * (PITCH * k - 0.5 * SHELF)
            first = row == SHELVES - 1 and k == 0
            world.create_body(
                Box(THIN, HEIGHT), position=(x, STOREY * row + 0.5 * HEIGHT), density=4.0, friction=ROUGH,
                angular_velocity=-3.0 if first else 0.0,
            )  # fmt: skip
    for row in range(SHELVES - 1, 0, -1):
        way = 1.0 if (SHELVES - 1 - row) % 2 == 0 else -1.0
        add_lever(world, shelves, (0.5 * SHELF + way * (0.5 * SHELF + 0.5), STOREY * row - 0.1))


def add_lever(world: World, shelves: Body, at: Point) -> None:
    """An upright board on an axis: what pushes its upper end to one side gets its lower to the other."""
    place = (at[0], at[1] + 0.5 * (OVER - UNDER))
    lever = world.create_body(Box(0.12, OVER + UNDER), position=place, density=0.5, friction=0.1)
    world.create_joint_revolute(shelves, lever, anchor=at, collide_connected=False)
