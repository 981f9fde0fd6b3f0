"""The nine demos of Box2D Lite, number by number, and the talk's first exercise: circles.

Sizes, positions and masses are those of Box2D Lite's samples (github.com/erincatto/box2d-lite, samples/main.cpp).
Its decimals are float32 literals, so ours are too: only then do the trajectories agree to 1e-8 m.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from engine import Body, Box, Circle, World
from engine.constants import float32_value as f32
from sandbox.lab.references import hanging_bridge
from sandbox.lab.sag import joint_gap, predicted_column, predicted_pyramid
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, and_a_fifth, distance_from
from sandbox.scenes.registry import scene

FRICTION = f32(0.2)
PYRAMID_SPACING = 1.125  # of the boxes in a row [m]


def add_ground(world: World) -> Body:
    """The floor of all demos: its top is at y = 0."""
    return world.create_body(Box(100, 20), position=(0, -10), kind="static", friction=FRICTION)


def soft_joint(mass: float, frequency: float, damping_ratio: float = f32(0.7)) -> dict[str, Any]:
    """Softness and bias factor that make a joint a damped spring for that mass [kg] and frequency [Hz].

    The implicit Euler spring of E. Catto, "Soft Constraints" (GDC 2011), at the demos' time step of 1/60 s.
    """
    dt = f32(1.0 / 60.0)
    omega = 2.0 * f32(math.pi) * frequency
    damper = 2.0 * mass * damping_ratio * omega
    spring = mass * omega * omega
    return {"softness": 1.0 / (damper + dt * spring), "bias_factor": dt * spring / (damper + dt * spring)}


def stiffness_of(joint: dict[str, Any]) -> float:
    """Of such a spring, as the solvers take it: bias factor / (softness dt^2) = k / dt [N/m]."""
    return joint["bias_factor"] / (joint["softness"] * f32(1.0 / 60.0) ** 2)


def add_pyramid(world: World, base: int, left: float) -> None:
    """Boxes in rows, each of one less than the row below; the lowest of `base`, from x = left on [m].

    The rows are 2 m apart: the boxes fall before they stand.
    """
    for row in range(base):
        for i in range(base - row):
            position = (left + 0.5 * PYRAMID_SPACING * row + PYRAMID_SPACING * i, 0.75 + 2.0 * row)
            world.create_body(Box(1, 1), position=position, mass=10, friction=FRICTION)


@scene(
    "The Talk/Single Box",
    shows=Criterion(
        "the box has sunk into the ground by",
        lambda world: 0.5 - float(world.positions[1, 1]),
        unit="m",
        after=5.0,
        at_most=and_a_fifth(lambda world, dt: predicted_column(world, dt, 1)),
    ),
    view=(0.0, 3.0, 10.0),
)
def single_box(world: World) -> None:
    """One box falls onto the ground and rests."""
    add_ground(world)
    world.create_body(Box(1, 1), position=(0, 4), mass=200, friction=FRICTION)


@scene(
    "The Talk/Simple Pendulum",
    shows=Criterion(
        "the bob's distance from its joint differs from 9 m by",
        lambda world: abs(distance_from(world, 1, 0.0, 11.0) - 9.0),
        unit="m",
        after=10.0,
        # At its lowest point it pulls with three times its weight, two of them to turn.
        at_most=and_a_fifth(lambda world, dt: joint_gap(world, dt, 3.0 * GRAVITY, 2.0 * GRAVITY)),
        throughout=True,
    ),
    view=(0.0, 8.0, 24.0),
)
def simple_pendulum(world: World) -> None:
    """One box swings from a joint: watch how the energy drifts."""
    ground = add_ground(world)
    bob = world.create_body(Box(1, 1), position=(9, 11), mass=100, friction=FRICTION)
    world.create_joint_revolute(ground, bob, anchor=(0, 11))


@scene(
    "The Talk/Varying Friction",
    shows=Criterion(
        "boxes that stay on the first ramp:",
        lambda world: float(np.count_nonzero(world.positions[-5:, 1] > 9.0)),
        unit="",
        after=10.0,
        # The slope is tan(0.25) = 0.255, friction sqrt(0.2 mu) = 0.39, 0.32, 0.265, 0.14, 0: two must stick, two must
        # slide; the third would come to rest in the end, if the ramp were long enough after its fall.
        at_least=2.0,
        at_most=3.0,
    ),
    view=(0.0, 7.0, 18.0),
)
def varying_friction(world: World) -> None:
    """Five boxes, from rough to slippery, slide down three ramps."""
    add_ground(world)
    for size, position, angle in (
        (Box(13, 0.25), (-2, 11), -0.25),
        (Box(0.25, 1), (5.25, 9.5), 0.0),
        (Box(13, 0.25), (2, 7), 0.25),
        (Box(0.25, 1), (-5.25, 5.5), 0.0),
        (Box(13, 0.25), (-2, 3), -0.25),
    ):
        world.create_body(size, position=position, angle=angle, kind="static", friction=FRICTION)
    for i, friction in enumerate((0.75, 0.5, f32(0.35), f32(0.1), 0.0)):
        world.create_body(Box(0.5, 0.5), position=(-7.5 + 2 * i, 14), mass=25, friction=friction)


# what the random numbers of Box2D Lite were in the run that its reference trajectory shows
STACK_X = (-0.09591947, -0.09669044, 0.008631155, 0.02698081, 0.082005896,
           -0.077507675, -0.00082212687, 0.009669766, 0.019220017, 0.056690075)  # fmt: skip
STACK_Y = [float(np.float32(0.51) + np.float32(1.05) * np.float32(i)) for i in range(10)]


@scene(
    "The Talk/Randomized Stacking",
    shows=Criterion(
        "the top box is lower than ten boxes by",
        lambda world: 9.5 - float(world.positions[10, 1]),
        unit="m",
        after=10.0,
        at_most=and_a_fifth(lambda world, dt: predicted_column(world, dt, 10)),
    ),
    view=(0.0, 5.0, 13.0),
)
def randomized_stacking(world: World) -> None:
    """Ten boxes, each a little off the one below, stand as a tower."""
    add_ground(world)
    for x, y in zip(STACK_X, STACK_Y, strict=True):
        world.create_body(Box(1, 1), position=(f32(x), y), mass=1, friction=FRICTION)


@scene(
    "The Talk/Pyramid",
    shows=Criterion(
        "the apex is lower than twelve boxes by",
        lambda world: 11.5 - float(world.positions[-1, 1]),
        unit="m",
        after=10.0,
        # twice what statics says: they have fallen askew
        at_most=lambda world, dt: 2.0 * predicted_pyramid(world, dt, 12, PYRAMID_SPACING),
    ),
    view=(0.0, 7.5, 19.0),
)
def pyramid(world: World) -> None:
    """Seventy-eight boxes fall into a pyramid of base twelve."""
    add_ground(world)
    add_pyramid(world, base=12, left=-6.0)


@scene(
    "The Talk/Teeter",
    shows=(
        Criterion(
            "the small boxes are flung up to",
            lambda world: float(world.positions[2:4, 1].max()),
            unit="m",
            after=4.0,
            at_least=6.0,
            at_most=30.0,  # the weight's 100 kg fall 14 m, and that would lift 50 kg by 28 m
            throughout=True,
        ),
    ),
    view=(0.0, 7.0, 20.0),
)
def teeter(world: World) -> None:
    """A falling weight flings two small boxes off a teeter."""
    ground = add_ground(world)
    board = world.create_body(Box(12, 0.25), position=(0, 1), mass=100, friction=FRICTION)
    world.create_body(Box(0.5, 0.5), position=(-5, 2), mass=25, friction=FRICTION)
    world.create_body(Box(0.5, 0.5), position=(-5.5, 2), mass=25, friction=FRICTION)
    world.create_body(Box(1, 1), position=(5.5, 15), mass=100, friction=FRICTION)
    world.create_joint_revolute(ground, board, anchor=(0, 1))


BRIDGE_SPRING = soft_joint(mass=50, frequency=2)
BRIDGE_SAG = hanging_bridge(15, 1.25, 50, stiffness_of(BRIDGE_SPRING), 18.75, GRAVITY)


@scene(
    "The Talk/Suspension Bridge",
    shows=Criterion(
        "the middle plank hangs below the ends by",
        lambda world: 5.0 - float(world.positions[8, 1]),
        unit="m",
        after=20.0,
        at_least=0.98 * BRIDGE_SAG,
        at_most=1.02 * BRIDGE_SAG,
    ),
    view=(0.5, 4.5, 15.0),
)
def suspension_bridge(world: World) -> None:
    """Fifteen planks hang from soft joints."""
    ground = add_ground(world)
    before = ground
    for i in range(15):
        plank = world.create_body(Box(1, 0.25), position=(-8.5 + 1.25 * i, 5), mass=50, friction=FRICTION)
        world.create_joint_revolute(before, plank, anchor=(-9.125 + 1.25 * i, 5), **BRIDGE_SPRING)
        before = plank
    world.create_joint_revolute(before, ground, anchor=(9.625, 5), **BRIDGE_SPRING)


@scene(
    "The Talk/Dominos",
    shows=Criterion(
        "dominos that still stand:",
        lambda world: float(np.count_nonzero(np.abs(world.angles[2:12]) < 0.5)),
        unit="",
        after=6.0,
        at_most=0.0,
    ),
    view=(-1.0, 7.5, 20.0),
)
def dominos(world: World) -> None:
    """A swinging weight topples a row of dominos, and what follows from it."""
    ground = add_ground(world)
    world.create_body(Box(12, 0.5), position=(-1.5, 10), kind="static", friction=FRICTION)
    for i in range(10):
        world.create_body(Box(f32(0.2), 2), position=(-6.0 + i, 11.125), mass=10, friction=f32(0.1))
    world.create_body(Box(14, 0.5), position=(1, 6), angle=f32(0.3), kind="static", friction=FRICTION)
    post = world.create_body(Box(0.5, 3), position=(-7, 4), kind="static", friction=FRICTION)
    seesaw = world.create_body(Box(12, 0.25), position=(f32(-0.9), 1), mass=20, friction=FRICTION)
    world.create_joint_revolute(ground, seesaw, anchor=(-2, 1))
    weight = world.create_body(Box(0.5, 0.5), position=(-10, 15), mass=10, friction=FRICTION)
    world.create_joint_revolute(post, weight, anchor=(-7, 15))
    chest = world.create_body(Box(2, 2), position=(6, 2.5), mass=20, friction=f32(0.1))
    world.create_joint_revolute(ground, chest, anchor=(6, f32(2.6)))
    lid = world.create_body(Box(2, f32(0.2)), position=(6, f32(3.6)), mass=10, friction=FRICTION)
    world.create_joint_revolute(chest, lid, anchor=(7, 3.5))


@scene(
    "The Talk/Multi-Pendulum",
    shows=Criterion(
        "the energy above that of the start is",
        lambda world: (world.diagnostics().energy - 15 * 10.0 * GRAVITY * 12.0) / (15 * 10.0 * GRAVITY * 12.0),
        unit="of it",
        after=10.0,
        at_most=1e-3,
        throughout=True,
    ),
    view=(0.0, 6.0, 26.0),
)
def multi_pendulum(world: World) -> None:
    """Fifteen links on soft joints swing down together."""
    before = add_ground(world)
    spring = soft_joint(mass=10, frequency=4)
    for i in range(15):
        link = world.create_body(Box(0.75, 0.25), position=(0.5 + i, 12), mass=10, friction=FRICTION)
        world.create_joint_revolute(before, link, anchor=(i, 12), **spring)
        before = link


ROLLERS = [(-7.5 + 1.1 * (i % 6), 10.0 + 1.1 * (i // 6)) for i in range(24)]  # where they start [m]
FIRST_ROLLER = 5  # number of creation


def still_moving(world: World) -> float:
    """Kinetic energy, in parts of what the fall has set free."""
    rollers = world.bodies[FIRST_ROLLER:]
    freed = sum(body.mass * GRAVITY * (y - body.position.y) for body, (_, y) in zip(rollers, ROLLERS, strict=True))
    return world.diagnostics().kinetic_energy / freed


@scene(
    "The Talk/Circles",
    shows=Criterion(
        "what still moves of the energy that the fall has set free is", still_moving, "of it", 20.0, at_most=0.01
    ),
    view=(0.0, 6.0, 16.0),
)
def circles(world: World) -> None:
    """The first exercise: circles and boxes roll down two ramps into a trough."""
    add_ground(world)
    for shape, position, angle in (
        (Box(10, 0.25), (-4, 7), -0.3),
        (Box(10, 0.25), (4, 4), 0.3),
        (Box(0.25, 2), (-6, 1), 0.0),
        (Box(0.25, 2), (2, 1), 0.0),
    ):
        world.create_body(shape, position=position, angle=angle, kind="static", friction=0.6)
    for i, start in enumerate(ROLLERS):
        if i % 4 == 3:
            world.create_body(Box(0.7, 0.7), position=start, friction=0.4)
        else:
            world.create_body(Circle(0.25 + 0.05 * (i % 5)), position=start, friction=0.6)
