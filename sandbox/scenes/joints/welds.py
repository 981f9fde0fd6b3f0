"""Welds, stiff and soft: beams that bend as far as they must, and rings that wobble."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Capsule, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import gaps
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor
from sandbox.scenes.registry import scene

# --- cantilever -------------------------------------------------------------------------------------------------------

PIECES, PIECE = 4, (2.0, 0.5)  # of a beam; size of one [m]
HERTZ, DAMPING = 9.0, 8.0  # of the soft one's welds: the beam itself swings 30 times slower
STIFF_AT, SOFT_AT = 9.0, 5.0  # heights of the beams [m]


def add_beam(world: World, wall: Body, y: float, hertz: float | None) -> list[Body]:
    """Boxes in a row, welded to each other and the first to the wall, at x = 0."""
    beam = [world.create_body(Box(*PIECE), position=(PIECE[0] * (k + 0.5), y), friction=ROUGH) for k in range(PIECES)]
    for k, (one, other) in enumerate(zip([wall, *beam[:-1]], beam, strict=True)):
        world.create_joint_weld(
            one, other, anchor=(PIECE[0] * k, y), angular_hertz=hertz, angular_damping_ratio=DAMPING,
            collide_connected=False,
        )  # fmt: skip
    return beam


def height_of(index: int) -> float:
    """Of the soft beam's pieces at rest, how high the middle of one lies below its wall [m].

    A weld's spring turns by torque / (m_e w^2), w = 2 pi hertz and m_e = 1/(1/I1 + 1/I2); its torque is that of the
    pieces beyond it, which lie the nearer the more they hang: repeated until it stays.
    """
    mass = PIECE[0] * PIECE[1]
    inertia = mass * (PIECE[0] ** 2 + PIECE[1] ** 2) / 12.0
    stiffness = np.full(PIECES, 0.5 * inertia * (2.0 * math.pi * HERTZ) ** 2)
    stiffness[0] *= 2.0  # the wall does not turn
    angles = np.zeros(PIECES)
    for _ in range(200):
        ends = np.concatenate([[0.0], np.cumsum(PIECE[0] * np.cos(angles))])
        middles = 0.5 * (ends[:-1] + ends[1:])
        torques = np.array([mass * GRAVITY * np.sum(middles[k:] - ends[k]) for k in range(PIECES)])
        angles = 0.5 * angles - 0.5 * np.cumsum(torques / stiffness)
    y = np.concatenate([[0.0], np.cumsum(PIECE[0] * np.sin(angles))])
    return float(0.5 * (y[index] + y[index + 1]))


TIP = height_of(PIECES - 1)


@scene(
    "Joints/Cantilever",
    shows=(
        Criterion(
            "the stiff beam's last piece is off its place by",
            lambda world: abs(float(world.positions[PIECES, 1]) - STIFF_AT),
            unit="m",
            after=15.0,
            at_most=0.01,
        ),
        Criterion(
            "the soft beam's last piece is off where its springs let it hang by",
            lambda world: abs(float(world.positions[2 * PIECES, 1]) - SOFT_AT - TIP),
            unit="m",
            after=15.0,
            at_most=0.01,
        ),
    ),
    view=(4.0, 6.0, 12.0),
)
def cantilever(world: World) -> None:
    """Two beams stick out of a wall: welds hold one straight, and springs let the other hang as deep as they must."""
    world.sleeping = False  # the soft one takes seconds to come down, too slowly to be told from rest
    wall = world.create_body(Box(2.0, 12.0), position=(-1.0, 6.0), kind="static")
    add_beam(world, wall, STIFF_AT, None)
    add_beam(world, wall, SOFT_AT, HERTZ)


# --- donuts -----------------------------------------------------------------------------------------------------------

SIDES, RADIUS, TUBE = 14, 1.2, 0.3  # pieces of a donut; radius of its ring and of its dough [m]
SOFT = 12.0  # hertz of its welds
DONUTS = ((-2.0, 5.5), (1.2, 8.0), (-0.6, 10.8))  # where they begin [m]


def add_donut(world: World, x: float, y: float) -> None:
    """Capsules in a ring, each welded softly to the next."""
    side = 2.0 * RADIUS * math.sin(math.pi / SIDES)
    ring = []
    for k in range(SIDES):
        turn = 2.0 * math.pi * k / SIDES
        place = (x + RADIUS * math.cos(turn), y + RADIUS * math.sin(turn))
        ring.append(
            world.create_body(Capsule(side, TUBE), position=place, angle=turn + 0.5 * math.pi, friction=0.3)
        )  # fmt: skip
    for k, body in enumerate(ring):
        turn = 2.0 * math.pi * (k + 0.5) / SIDES
        corner = RADIUS / math.cos(math.pi / SIDES)
        world.create_joint_weld(
            body, ring[(k + 1) % SIDES], anchor=(x + corner * math.cos(turn), y + corner * math.sin(turn)),
            angular_hertz=SOFT, angular_damping_ratio=0.1, collide_connected=False,
        )  # fmt: skip


def roundest(world: World) -> float:
    """How far the widest and narrowest of the donuts' radii are from each other, at most [m]."""
    rings = world.positions[1:].reshape(len(DONUTS), SIDES, 2)
    radii = np.hypot(*(rings - rings.mean(axis=1, keepdims=True)).transpose(2, 0, 1))
    return float((radii.max(axis=1) - radii.min(axis=1)).max())


@scene(
    "Joints/Soft Donuts",
    shows=(
        gaps(8.0, at_most=TUBE),
        Criterion("within the fall, a donut is out of round by", roundest, "m", 8.0, at_least=0.2, throughout=True),
        Criterion("at rest, a donut is out of round by", roundest, "m", 8.0, at_most=0.7 * RADIUS),
    ),
    view=(0.0, 5.5, 14.0),
)
def soft_donuts(world: World) -> None:
    """Three rings of soft welds fall down a slope and onto each other: they wobble and come round again."""
    ground = add_floor(world, 40)
    ground.add_shape(Box(6.0, 0.4), offset=(-2.5, 3.6), angle=-0.4, friction=0.3)
    ground.add_shape(Box(0.4, 3.0), offset=(6.0, 2.5), friction=0.3)
    ground.add_shape(Box(0.4, 3.0), offset=(-6.0, 2.5), friction=0.3)
    for place in DONUTS:
        add_donut(world, *place)
