"""Heavy on light, and bodies that begin inside each other."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, World
from sandbox.lab.sag import BOX_INERTIA, predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor, and_a_fifth, but_a_fifth, moved, nearest
from sandbox.scenes.registry import scene

# --- mass ratio -------------------------------------------------------------------------------------------------------

HEAVY = 20.0  # side of the heavy box [m]: 400 times the mass of a unit box
POSTS = (-9.5, 9.5)  # where the light ones stand, flush with its sides
PLACES = np.array([(POSTS[0], 0.5), (POSTS[1], 0.5), (0.0, 1.0 + 0.5 * HEAVY)])


def heavy_on_light() -> Structure:
    """The three boxes and the points at which they touch."""
    points = []
    for post, x in enumerate(POSTS):
        for side in (-0.5, 0.5):
            points += [Point(GROUND, post, x + side, 0.0), Point(post, 2, x + side, 1.0)]
    masses = np.array([1.0, 1.0, HEAVY**2])
    return Structure(PLACES, masses, BOX_INERTIA * masses * np.array([1.0, 1.0, HEAVY**2]), points)


@scene(
    "Stacking/Mass Ratio 400",
    shows=Criterion(
        "a box is off its place by",
        lambda world: moved(world, 1, PLACES),
        unit="m",
        after=10.0,
        at_most=and_a_fifth(lambda world, dt: predicted_sink(world, dt, heavy_on_light(), 2)),
        at_least=but_a_fifth(lambda world, dt: predicted_sink(world, dt, heavy_on_light(), 2)),
    ),
    view=(0.0, 10.5, 25.0),
)
def mass_ratio_400(world: World) -> None:
    """A box of 400 tonnes on two of one: the light ones must not be squeezed out."""
    add_floor(world, 60)
    for x, y in PLACES[:2]:
        world.create_body(Box(1, 1), position=(x, y), density=1000, friction=ROUGH)
    world.create_body(Box(HEAVY, HEAVY), position=tuple(PLACES[2]), density=1000, friction=ROUGH)


# --- overlap ----------------------------------------------------------------------------------------------------------

ROWS = 4
OVERLAP = 0.25  # of neighbours, sideways and upwards [m]
LEFT = 0.02  # that may be left of it [m]


def push_out_limit(world: World, dt: float) -> float:
    """The speed at which overlap is pushed apart, and that of a fall from as high as all of it lifts the top [m/s]."""
    return world.settings.push_out_speed + math.sqrt(2.0 * GRAVITY * ROWS * OVERLAP)


@scene(
    "Stacking/Overlap Recovery",
    shows=(
        Criterion(
            "the fastest box moves at",
            lambda world: float(np.hypot(*world.velocities.T).max()),
            unit="m/s",
            after=3.0,
            at_most=push_out_limit,
            throughout=True,
        ),
        Criterion(
            "the deepest overlap left is",
            lambda world: world.diagnostics().max_penetration,
            unit="m",
            after=3.0,
            at_most=LEFT,
        ),
        Criterion(
            "the middles of two boxes are apart by at least",
            lambda world: nearest(world, 1),
            unit="m",
            after=3.0,
            at_least=1.0 - LEFT,  # however they lie: each has a disc of 1 m across in it. They began at 0.75 m
        ),
        Criterion(
            "in widths of the lowest row, a box lies off the middle by",
            lambda world: float(np.abs(world.positions[1:, 0]).max()) / ROWS,
            unit="",
            after=3.0,
            at_most=1.0,
        ),
    ),
    view=(0.0, 2.5, 8.0),
)
def overlap_recovery(world: World) -> None:
    """Ten boxes begin a quarter inside each other, and are pushed apart gently."""
    add_floor(world, 40)
    spacing = 1.0 - OVERLAP
    for row in range(ROWS):
        for i in range(ROWS - row):
            position = (spacing * (i - 0.5 * (ROWS - 1 - row)), 0.5 - OVERLAP + spacing * row)
            world.create_body(Box(1, 1), position=position, friction=ROUGH)
