"""What several scenes are built of, and how a body is found again."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine import Body, Box, World
from sandbox.lab.sag import LEAST, MARGIN, is_soft

ROUGH = 0.6  # friction of what shall stand
GRAVITY = 10.0  # of a world, unless a scene says otherwise [m/s^2]

Predict = Callable[[World, float], float]


def add_floor(world: World, width: float, friction: float = ROUGH, x: float = 0.0, y: float = 0.0) -> Body:
    """A static box whose top is at y [m]."""
    return world.create_body(Box(width, 2.0), position=(x, y - 1.0), kind="static", friction=friction)


def and_a_fifth(predicted: Predict, most: float = math.inf) -> Predict:
    """What may be at most, where so much is predicted; most: beyond which all is lost, whatever is predicted."""
    return lambda world, dt: min(MARGIN * predicted(world, dt), most)


def but_a_fifth(predicted: Predict, most: float = math.inf) -> Predict:
    """What springs must give way at least, where so much is predicted: what they carry, presses on them.

    most: what may be at most, whatever is predicted. Contacts without springs may stay in no overlap at all.
    """
    return lambda world, dt: LEAST * min(predicted(world, dt), most) if is_soft(world) else -math.inf


def distance_from(world: World, index: int, x: float, y: float) -> float:
    """How far a body, by its number of creation, is from a point [m]."""
    return math.dist(world.positions[index], (x, y))


def nearest(world: World, index: int) -> float:
    """How far the two bodies that are nearest to each other are apart, middle from middle [m]; index: of the first."""
    places = world.positions[index:]
    away = places[:, None] - places
    apart = np.hypot(away[..., 0], away[..., 1])
    return float(apart[np.triu_indices(len(places), 1)].min())


def moved(world: World, index: int, places: np.ndarray) -> float:
    """The farthest that bodies are from (N, 2) places [m]; index: of the first of them."""
    away = world.positions[index : index + len(places)] - places
    return float(np.hypot(away[:, 0], away[:, 1]).max())
