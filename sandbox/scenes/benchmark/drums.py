"""What turns: a drum on a motor, a drum that turns by itself, and a beater in a ring."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Capsule, Chain, Circle, Polygon, Shape, World
from sandbox.scenes.benchmark.parts import farthest, grid_places, one_steps_fall
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import scene

DRUM_SPEED = math.radians(25.0)  # of tumbler and washer [rad/s]
AXIS = (0.0, 10.0)  # of both [m]


def astray(world: World, index: int, speed: float) -> float:
    """How far a body's angle is from where that speed takes it [rad]."""
    return abs(float(world.angles[index]) - speed * world.time)


# --- tumbler ----------------------------------------------------------------------------------------------------------

TUMBLED = 45  # boxes a side


@scene(
    "Benchmark/Tumbler",
    shows=(
        Criterion(
            "the drum is off the angle that its motor asks for by",
            lambda world: astray(world, 1, DRUM_SPEED),
            unit="rad",
            after=1.0,
            at_most=0.001,
        ),
        Criterion(
            "a box is from the axis",
            lambda world: farthest(world, 2, *AXIS),
            unit="m",
            after=1.0,
            at_most=math.hypot(9.5, 9.5),  # an inner corner of the drum
        ),
    ),
    view=(0.0, 10.0, 32.0),
)
def tumbler(world: World) -> None:
    """A motor turns a square drum with 2,025 small boxes in it.

    As Box2D's tumbler: walls 20 m long and 1 m thick, of 50 kg/m2, 25 degrees a second, at most 1e8 N m.
    """
    ground = world.create_body(kind="static")
    drum = world.create_body(position=AXIS)
    for side in (-10.0, 10.0):
        drum.add_shape(Box(1, 20), offset=(side, 0.0), density=50.0, friction=ROUGH)
        drum.add_shape(Box(20, 1), offset=(0.0, side), density=50.0, friction=ROUGH)
    world.create_joint_revolute(
        ground, drum, anchor=AXIS, collide_connected=False, motor_speed=DRUM_SPEED, max_motor_torque=1e8
    )
    start = -0.2 * TUMBLED
    places = grid_places(TUMBLED, TUMBLED, start, start + AXIS[1], 0.4, 0.4)
    world.create_bodies(Box(0.25, 0.25), positions=places, friction=ROUGH)


# --- washer -----------------------------------------------------------------------------------------------------------

WASHED = 90  # boxes a side
VANE, INNER, OUTER = 14.0, 16.0, 18.0  # radii of vanes and of the drum's wall [m]
STAVES = 36
PITCH = 2.0 * math.pi / STAVES
LAP = 0.1 * PITCH  # of neighbouring staves, either way


def wedge(low: float, high: float, first: float, last: float) -> Polygon:
    """Between two radii [m] and two angles [rad]."""
    corners = ((low, first), (high, first), (high, last), (low, last))
    return Polygon(tuple((r * math.cos(angle), r * math.sin(angle)) for r, angle in corners))


@scene(
    "Benchmark/Washer",
    shows=Criterion(
        "a box is from the axis",
        lambda world: farthest(world, 1, *AXIS),
        unit="m",
        after=1.2,
        at_most=lambda world, dt: INNER + one_steps_fall(1.2)(world, dt),  # the wall is 2 m thick
    ),
    view=(0.0, 10.0, 40.0),
)
def washer(world: World) -> None:
    """A round drum with four vanes turns by itself, and 8,100 small boxes in it.

    As Box2D's washer: kinematic, of 36 staves, 25 degrees a second, creeping aside by 2 mm/s. The boxes' events of hard
    hits are left out, and the static body that has no shape.
    """
    drum = world.create_body(kind="kinematic", position=AXIS, velocity=(0.001, -0.002), angular_velocity=DRUM_SPEED)
    for k in range(STAVES):
        drum.add_shape(wedge(INNER, OUTER, PITCH * k - LAP, PITCH * (k + 1) + LAP), friction=ROUGH)
        if k % 9 == 0:
            drum.add_shape(wedge(VANE, INNER, PITCH * k, PITCH * (k + 1)), friction=ROUGH)
    start = -0.11 * WASHED
    places = grid_places(WASHED, WASHED, start, start + AXIS[1], 0.21, 0.21)
    world.create_bodies(Box(0.2, 0.2), positions=places, friction=ROUGH)


# --- spinner ----------------------------------------------------------------------------------------------------------

RING, RING_AT = 40.0, (0.0, 32.0)  # radius and centre [m]
RING_POINTS = 360
BEATER_AT, BEATER_SPEED = (0.0, 12.0), 5.0  # [m], [rad/s]
STIRRED = 6076
STIRRED_AT, STEP, A_ROW = (-23.0, 2.0), 0.5, 92  # the first of them, from one to the next [m], in a row


@scene(
    "Benchmark/Spinner",
    shows=(
        Criterion(
            "the beater is off the angle that its motor asks for by",
            lambda world: astray(world, 1, BEATER_SPEED),
            unit="rad",
            after=0.5,
            at_most=0.05,  # of 2.5: it begins among the bodies
        ),
        Criterion(
            "of all bodies, the part that is outside of the ring is",
            lambda world: float(np.mean(np.hypot(*(world.positions[2:] - RING_AT).T) > RING)),
            unit="",
            after=0.5,
            at_most=0.05,
        ),
    ),
    view=(0.0, 32.0, 85.0),
)
def spinner(world: World) -> None:
    """A beater on a motor, and 6,076 capsules, discs and squares in a ring.

    As Box2D's spinner: the ring a closed chain of 360 points and friction 0.1, the beater 40 m long at 5 rad/s, as
    strong as need be; the bodies of 0.25 kg/m2, friction and restitution 0.1, overlapping each other and the beater
    when it begins. Here capsules, discs and squares are created kind by kind, there in turn. Collision is continuous
    there: here the beater's ends, which go 1.7 m in a step, knock some bodies through the ring.
    """
    ground = world.create_body(kind="static")
    angles = [2.0 * math.pi * k / RING_POINTS for k in range(RING_POINTS)]
    around = ((RING_AT[0] + RING * math.cos(angle), RING_AT[1] + RING * math.sin(angle)) for angle in angles)
    ground.add_shape(Chain(tuple(around), closed=True), friction=0.1)
    blade = Polygon(((-0.4, -20.0), (0.4, -20.0), (0.4, 20.0), (-0.4, 20.0)), radius=0.2)
    beater = world.create_body(blade, position=BEATER_AT, friction=0.0)
    world.create_joint_revolute(
        ground, beater, anchor=BEATER_AT, collide_connected=False, motor_speed=BEATER_SPEED, max_motor_torque=1e30
    )
    places = grid_places(A_ROW, STIRRED // A_ROW + 1, *STIRRED_AT, STEP, STEP)
    places = places.reshape(A_ROW, -1, 2).swapaxes(0, 1).reshape(-1, 2)[:STIRRED]  # row by row
    shapes: tuple[Shape, ...] = (Capsule(0.5, 0.25), Circle(0.35), Box(0.7, 0.7))
    for k, shape in enumerate(shapes):
        world.create_bodies(shape, positions=places[k::3], density=0.25, friction=0.1, restitution=0.1)
