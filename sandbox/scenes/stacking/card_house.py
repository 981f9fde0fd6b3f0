"""A house of cards: friction alone keeps it up."""

from __future__ import annotations

import math

from engine import Box, World
from engine.constants import STATIC_STIFFENING
from sandbox.lab.sag import contact_hertz, spring_sag
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor, but_a_fifth
from sandbox.scenes.registry import scene

PAIRS = 4  # of leaning cards on the ground
LENGTH, THICKNESS = 1.0, 0.04  # of a card [m]
LEAN = math.radians(25.0)  # from the vertical
SPACING = 0.98  # from one pair to the next [m]
GRIP = 0.7  # friction. A card that carries a weight P leans with P tan(25 degrees) = 0.47 P.

ACROSS = 0.5 * (THICKNESS * math.cos(LEAN) + LENGTH * math.sin(LEAN))  # from a card's middle to the other card
UP = 0.5 * (LENGTH * math.cos(LEAN) + THICKNESS * math.sin(LEAN))  # from its lowest corner to its middle
STOREY = 2.0 * UP + THICKNESS  # height of one [m]
TOP = (PAIRS - 1) * STOREY + UP  # where the middles of the topmost cards are [m]


def least_sag(world: World, dt: float) -> float:
    """How far the highest card drops at least [m]: all the cards between it and the floor are on the two feet of each
    pair, and a foot is a spring to the floor of at most a card's mass.
    """
    pairs = PAIRS * (PAIRS + 1) // 2
    cards = 2 * pairs + (pairs - PAIRS) * (SPACING - 0.02) / LENGTH  # all of them, in those that lean
    return spring_sag(GRAVITY * cards / (2 * PAIRS), 1.0, STATIC_STIFFENING * contact_hertz(world, dt))


@scene(
    "Stacking/Card House",
    shows=Criterion(
        "the highest card has dropped by",
        lambda world: TOP - float(world.positions[:, 1].max()),
        unit="m",
        after=10.0,
        at_most=0.05,  # a twentieth of a card: it gives way where corners press, but no card has slipped
        at_least=but_a_fifth(least_sag),
    ),
    view=(0.0, 1.9, 5.2),
)
def card_house(world: World) -> None:
    """Four storeys of cards that lean on each other, held by friction alone."""
    add_floor(world, 20, friction=GRIP)
    for storey in range(PAIRS):
        y = STOREY * storey
        pairs = PAIRS - storey
        for i in range(pairs):
            x = SPACING * (i - 0.5 * (pairs - 1))
            for side in (-1, 1):
                place = (x + side * ACROSS, y + UP)
                world.create_body(Box(THICKNESS, LENGTH), position=place, angle=side * LEAN, friction=GRIP)
        for i in range(pairs - 1):
            place = (SPACING * (i + 0.5 - 0.5 * (pairs - 1)), y + 2.0 * UP + 0.5 * THICKNESS)
            world.create_body(Box(SPACING - 0.02, THICKNESS), position=place, friction=GRIP)
