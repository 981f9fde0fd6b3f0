"""Columns that are not boxes on boxes: tilted, and of circles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import Box, Circle, World
from engine.constants import SLOP
from sandbox.lab.sag import BOX_INERTIA, contact_hertz, is_soft, spring_sag
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor, and_a_fifth, but_a_fifth, moved
from sandbox.scenes.registry import scene

STANDS = 10.0  # [s]

# --- tilted -----------------------------------------------------------------------------------------------------------

BOXES, LEAN = 10, 0.05  # boxes; how far each is beside the one below [m]
TILTED = np.column_stack([LEAN * np.arange(BOXES), 0.5 + np.arange(BOXES)])


def tilted() -> Structure:
    """It stands: above each box the rest's centre of mass is LEAN (n + 1) / 2 beside its middle, at most 0.25 m."""
    points = [Point(GROUND, 0, -0.5, 0.0), Point(GROUND, 0, 0.5, 0.0)]
    for k in range(1, BOXES):
        points += [Point(k - 1, k, LEAN * k - 0.5, k), Point(k - 1, k, LEAN * (k - 1) + 0.5, k)]
    return Structure(TILTED, np.ones(BOXES), np.full(BOXES, BOX_INERTIA), points)


def leaning(world: World, dt: float) -> float:
    """How far a box moves at most until its contacts carry it [m]."""
    structure = tilted()
    if not is_soft(world):
        return 2.0 * SLOP * float(structure.carried(BOXES - 1).sum())  # sunk by one half, and leaning by the other
    rest = structure.settle(contact_hertz(world, dt), -world.gravity[1])
    return float(np.hypot(*rest.moved[:, :2].T).max())


STAYS = Criterion(
    "a box is off its place by",
    lambda world: moved(world, 1, TILTED),
    unit="m",
    after=STANDS,
    at_most=and_a_fifth(leaning, 0.5),  # half a box
)
LEANS = replace(STAYS, at_least=but_a_fifth(leaning, 0.5))
"""Where nothing falls asleep: it leans over so slowly that it would be held on its way."""


@scene(
    "Robustness/Tilted Stack",
    shows=STAYS,
    view=(0.0, 5.0, 13.0),
)
def tilted_stack(world: World) -> None:
    """Ten boxes, each a little beside the one below: they lean, and stand."""
    add_floor(world, 40)
    world.create_bodies(Box(1, 1), positions=TILTED, friction=ROUGH)


# --- of circles -------------------------------------------------------------------------------------------------------

DISCS, RADIUS = 10, 0.5  # [m]
COLUMN = np.column_stack([np.zeros(DISCS), RADIUS * (2 * np.arange(DISCS) + 1)])


def column_of_discs(world: World, dt: float) -> float:
    """How far the top disc sinks [m]: one point a contact, of half a disc's mass; of a whole one's on the ground."""
    if not is_soft(world):
        return DISCS * SLOP
    hertz = contact_hertz(world, dt)
    pairs = spring_sag(GRAVITY * DISCS * (DISCS - 1) / 2.0, 0.5, hertz)
    return pairs + spring_sag(GRAVITY * DISCS, 1.0, 2.0 * hertz)


@scene(
    "Robustness/Circle Stack",
    shows=Criterion(
        "a disc is off its place by",
        lambda world: moved(world, 1, COLUMN),
        unit="m",
        after=STANDS,
        at_most=and_a_fifth(column_of_discs, RADIUS),
        at_least=but_a_fifth(column_of_discs, RADIUS),
    ),
    view=(0.0, 5.0, 13.0),
)
def circle_stack(world: World) -> None:
    """Ten discs balance on each other: nothing pushes them aside, so long as what is symmetric stays so to the bit."""
    add_floor(world, 40)
    world.create_bodies(Circle(RADIUS), positions=COLUMN, friction=ROUGH)
