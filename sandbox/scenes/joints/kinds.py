"""Each kind of joint by itself, at work on as little as it needs."""

from __future__ import annotations

import math

from engine import Box, Circle, DistanceJoint, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

# --- distance ---------------------------------------------------------------------------------------------------------

LENGTH, BEAM = 4.0, 6.0  # of rod, rope and spring; height that they hang from [m]
HERTZ = 1.0  # of the spring
STRETCH = GRAVITY / (2.0 * math.pi * HERTZ) ** 2  # of the spring under a body's weight [m]


def longer_by(index: int, length: float, world: World) -> float:
    """How much longer a distance joint is than it should be [m]."""
    joint = world.joints[index]
    assert isinstance(joint, DistanceJoint)
    return joint.current_length - length


@scene(
    "Joints/Rod, Rope and Spring",
    shows=(
        Criterion(
            "the rod is off its length by",
            lambda w: abs(longer_by(0, LENGTH, w)),
            "m",
            6.0,
            at_most=0.002,
            throughout=True,
        ),
        Criterion(
            "the rope is longer than it is by",
            lambda w: longer_by(1, LENGTH, w),
            "m",
            6.0,
            at_most=0.02,
            throughout=True,
        ),
        Criterion(
            "the spring is off the length that its load gives it by",
            lambda w: abs(longer_by(2, 0.5 * LENGTH + STRETCH, w)),
            "m",
            10.0,
            at_most=0.002,
        ),
    ),
    view=(0.5, 2.5, 10.0),
)
def rod_rope_spring(world: World) -> None:
    """A rod swings, a rope goes slack and tightens, a spring bounces: a distance joint can be each of them."""
    beam = world.create_body(Box(12.0, 0.4), position=(0.5, BEAM + 0.2), kind="static")
    rod = world.create_body(Circle(0.4), position=(-4.0 + LENGTH * math.sin(-0.3), BEAM - LENGTH * math.cos(0.3)))
    world.create_joint_distance(beam, rod, anchor1=(-4.0, BEAM), anchor2=rod.position)
    rope = world.create_body(Box(0.7, 0.7), position=(2.5, BEAM - 1.0))
    world.create_joint_distance(beam, rope, anchor1=(0.5, BEAM), anchor2=(2.5, BEAM - 0.65), upper=LENGTH)
    spring = world.create_body(Circle(0.4), position=(4.5, BEAM - 0.5 * LENGTH))
    world.create_joint_distance(
        beam, spring, anchor1=(4.5, BEAM), anchor2=spring.position, hertz=HERTZ, damping_ratio=0.1
    )


# --- prismatic --------------------------------------------------------------------------------------------------------

SLIDES = (-5.0, 0.0, 5.0)  # x of the three rails [m]
TRAVEL, SPEED = 2.0, 1.0  # limits, either way [m]; of the motor [m/s]


def place(world: World, index: int) -> float:
    """Of a sliding body over its middle [m]."""
    return float(world.positions[index, 1]) - 4.0


@scene(
    "Joints/Sliders",
    shows=(
        Criterion(
            "the box on a spring is off where its weight brings it by",
            lambda w: abs(place(w, 1) + STRETCH),
            "m",
            10.0,
            at_most=0.002,
        ),
        Criterion(
            "the box that fell to its limit is off it by", lambda w: abs(place(w, 2) + TRAVEL), "m", 6.0, at_most=0.002
        ),
        Criterion(
            "the motor's box is off the limit that it was driven to by",
            lambda w: abs(place(w, 3) - TRAVEL),
            "m",
            6.0,
            at_most=0.01,
        ),
        Criterion(
            "a box has left its rail by",
            lambda w: max(abs(float(w.positions[k + 1, 0]) - x) for k, x in enumerate(SLIDES)),
            "m",
            6.0,
            at_most=0.002,
            throughout=True,
        ),
    ),
    view=(0.0, 4.0, 10.0),
)
def sliders(world: World) -> None:
    """Three boxes on rails: one hangs on a spring, one falls to its limit, one is lifted by a motor."""
    rails = world.create_body(kind="static", position=(0.0, 4.0))
    for x in SLIDES:
        rails.add_shape(Box(0.2, 2.0 * TRAVEL + 2.5), offset=(x, 0.0))
    acting: tuple[dict[str, float], ...] = (
        {"hertz": HERTZ, "damping_ratio": 0.1},
        {"lower": -TRAVEL, "upper": TRAVEL},
        {"lower": -TRAVEL, "upper": TRAVEL, "motor_speed": SPEED, "max_motor_force": 30.0},
    )
    for x, ways in zip(SLIDES, acting, strict=True):
        box = world.create_body(Box(2.0, 0.8), position=(x, 4.0))
        world.create_joint_prismatic(
            rails, box, anchor=(x, 4.0), axis=(0.0, 1.0), collide_connected=False, **ways
        )  # fmt: skip


# --- motor ------------------------------------------------------------------------------------------------------------

POSE, TURNED = (3.0, 2.0), 0.5 * math.pi  # [m], [rad]


@scene(
    "Joints/Motor Joint",
    shows=(
        Criterion(
            "the free plate is from where its weight leaves it",
            lambda w: math.dist(w.positions[1], (POSE[0], POSE[1] - STRETCH)),
            "m",
            10.0,
            at_most=0.02,
        ),
        Criterion(
            "the free plate's angle is off its pose by",
            lambda w: abs(float(w.angles[1]) - TURNED),
            "rad",
            6.0,
            at_most=0.02,
        ),
        Criterion(
            "the plate that is too heavy has sunk by", lambda w: 2.0 - float(w.positions[2, 1]), "m", 6.0, at_least=0.5
        ),
    ),
    view=(0.0, 2.0, 9.0),
)
def motor_joint(world: World) -> None:
    """A motor joint lifts a plate to a pose and holds it there, another is too weak for what lies on its plate."""
    floor = add_floor(world, 20)
    free = world.create_body(Box(2.0, 0.4), position=(1.0, 0.2), density=2.0)
    world.create_joint_motor(
        floor, free, offset=(POSE[0], POSE[1] + 1.0), angle=TURNED, max_force=60.0, max_torque=20.0, linear_hertz=HERTZ,
        angular_hertz=HERTZ,
    )  # fmt: skip
    weak = world.create_body(Box(2.0, 0.4), position=(-3.0, 2.0), density=2.0)
    world.create_joint_motor(floor, weak, max_force=25.0, max_torque=20.0, linear_hertz=5.0, angular_hertz=5.0)
    for k in range(3):
        world.create_body(Box(0.6, 0.6), position=(-3.0, 2.6 + 0.7 * k), density=1.0)


# --- mouse ------------------------------------------------------------------------------------------------------------

TARGET = (2.0, 4.0)  # [m]


@scene(
    "Joints/Mouse Joint",
    shows=Criterion(
        "the held corner is from where it is drawn to",
        lambda world: math.dist(*world.joints[0].anchors),
        unit="m",
        after=10.0,
        at_most=0.1,  # its weight draws, too
    ),
    view=(0.0, 3.0, 8.0),
)
def mouse_joint(world: World) -> None:
    """A mouse joint draws a box by its corner out of a heap, as a pointer does, and lets it hang there."""
    floor = add_floor(world, 20)
    box = world.create_body(Box(1.0, 1.0), position=(-2.0, 0.5), friction=0.6)
    for k in range(3):
        world.create_body(Box(0.8, 0.8), position=(-2.0, 1.4 + 0.8 * k), density=0.5, friction=0.6)
    world.create_joint_mouse(
        floor, box, target=TARGET, anchor=(-1.5, 1.0), hertz=2.0, damping_ratio=0.7, max_force=200.0
    )


# --- filter -----------------------------------------------------------------------------------------------------------

SHELF = 3.0  # height of its upper side [m]


@scene(
    "Joints/Filter Joint",
    shows=(
        Criterion(
            "the box that passes is above the floor by",
            lambda w: float(w.positions[2, 1]) - 0.5,
            "m",
            3.0,
            at_most=0.02,
        ),
        Criterion(
            "the box that does not is off the shelf by",
            lambda w: abs(float(w.positions[3, 1]) - SHELF - 0.5),
            "m",
            3.0,
            at_most=0.02,
        ),
    ),
    view=(0.0, 3.0, 8.0),
)
def filter_joint(world: World) -> None:
    """Two boxes fall on a shelf: a filter joint lets one of them through."""
    add_floor(world, 20)
    shelf = world.create_body(Box(6.0, 0.3), position=(0.0, SHELF - 0.15), kind="static")
    passes = world.create_body(Box(1.0, 1.0), position=(-1.5, 5.0))
    world.create_body(Box(1.0, 1.0), position=(1.5, 5.0))
    world.create_joint_filter(shelf, passes)
