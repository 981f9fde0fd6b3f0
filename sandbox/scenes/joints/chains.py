"""Chains that carry what is far heavier than their links."""

from __future__ import annotations

import itertools
import math

import numpy as np

from engine import Body, Box, Capsule, Circle, World
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.joints.parts import Point, between, gaps, pin
from sandbox.scenes.parts import ROUGH, add_floor
from sandbox.scenes.registry import scene


def add_chain(
    world: World, anchor: Body, first: Point, last: Point, links: int, width: float, density: float = 1.0
) -> list[Body]:
    """Capsules from first to last, which hang on each other and the first on the anchor."""
    points = between(first, last, links)
    angle = math.atan2(last[1] - first[1], last[0] - first[0])
    length = math.dist(first, last) / links
    chain = [
        world.create_body(
            Capsule(length, 0.5 * width), position=(0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])),
            angle=angle, density=density,
        )
        for one, other in itertools.pairwise(points)
    ]  # fmt: skip
    pin(world, [anchor, *chain], points[:-1], collide_connected=False)
    return chain


# --- ball and chain ---------------------------------------------------------------------------------------------------

LINKS, LENGTH, BALL = 30, 30.0, 4.0  # links; their length together and the ball's radius [m]
DENSITY = 20.0  # [kg/m^2]: 1005 kg, where a link has 6 kg


@scene(
    "Joints/Ball and Chain",
    shows=gaps(8.0, at_most=0.005),
    view=(0.0, -18.0, 80.0),
)
def ball_and_chain(world: World) -> None:
    """A ball swings on a chain of 30 links, of which each has a 168th of its mass: no joint opens by 5 mm.

    As Box2D's ball_and_chain.
    """
    ceiling = world.create_body(Box(8.0, 1.0), position=(0.0, 1.5), kind="static")
    chain = add_chain(world, ceiling, (0.0, 0.0), (LENGTH, 0.0), LINKS, 0.25, DENSITY)
    ball = world.create_body(Circle(BALL), position=(LENGTH + BALL, 0.0), density=DENSITY, friction=ROUGH)
    world.create_joint_revolute(chain[-1], ball, anchor=(LENGTH, 0.0), collide_connected=False)


# --- wrecking ball ----------------------------------------------------------------------------------------------------

COLUMNS, ROWS, BRICK = 4, 14, (1.0, 0.6)  # [m]
HOOK, REACH, WRECKER = (-0.5, 14.0), 10.5, 1.2  # [m]
STARTS = 0.95  # of the chain from the vertical [rad]


def fallen(world: World) -> float:
    """Part of the bricks that are not where they were."""
    bricks = world.positions[2 : 2 + COLUMNS * ROWS]
    places = wall_places()
    return float(np.mean(np.hypot(*(bricks - places).T) > BRICK[1]))


def wall_places() -> np.ndarray:
    """(bricks, 2) row by row, every other row half a brick beside the one below [m]."""
    rows = [
        (2.0 + BRICK[0] * (column + 0.2 * (1 if row % 2 else -1)), BRICK[1] * (row + 0.5))
        for row in range(ROWS)
        for column in range(COLUMNS)
    ]
    return np.array(rows)


@scene(
    "Joints/Wrecking Ball",
    shows=(
        gaps(6.0, at_most=0.1),  # half of a link's thickness, when the ball hits
        Criterion(
            "of the wall's bricks, there stand before it is hit", lambda w: 1.0 - fallen(w), "", 0.75, at_least=1.0
        ),
        Criterion("of the wall's bricks, there have fallen", fallen, "", 6.0, at_least=0.5),
    ),
    view=(1.0, 7.0, 20.0),
)
def wrecking_ball(world: World) -> None:
    """A heavy ball on a crane's chain swings into a wall of bricks."""
    add_floor(world, 60)
    crane = world.create_body(Box(20.0, 0.6), position=(-4.0, HOOK[1] + 1.0), kind="static")
    world.create_bodies(Box(*BRICK), positions=wall_places(), density=2.0, friction=ROUGH)
    away = (-math.sin(STARTS), -math.cos(STARTS))
    end = (HOOK[0] + REACH * away[0], HOOK[1] + REACH * away[1])
    chain = add_chain(world, crane, HOOK, end, 16, 0.2)
    ball = world.create_body(
        Circle(WRECKER), position=(end[0] + WRECKER * away[0], end[1] + WRECKER * away[1]), density=30.0, friction=ROUGH
    )
    world.create_joint_revolute(chain[-1], ball, anchor=end, collide_connected=False)
