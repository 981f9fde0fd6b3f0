"""Heavy on light: on a pyramid, on the points of triangles, on what grows, and box on box."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine import Box, Polygon, World
from sandbox.lab.sag import BOX_INERTIA, predicted_sink, pyramid
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor, and_a_fifth, but_a_fifth, moved
from sandbox.scenes.registry import scene

STANDS = 10.0  # [s]
DEEPEST = 0.5  # half of the smallest: a body that sinks so deep into another is lost in it [m]


def stays(places: np.ndarray, structure: Structure, body: int) -> Criterion:
    """No body is further off its place than the heaviest sinks into its contacts, by statics."""
    return Criterion(
        "a body is off its place by",
        lambda world: moved(world, 1, places),
        unit="m",
        after=STANDS,
        at_most=and_a_fifth(lambda world, dt: predicted_sink(world, dt, structure, body), DEEPEST),
        at_least=but_a_fifth(lambda world, dt: predicted_sink(world, dt, structure, body), DEEPEST),
    )


def weighted(structure: Structure, body: int, ratio: float) -> Structure:
    """With one body so many times as heavy."""
    times = np.ones(len(structure.masses))
    times[body] = ratio
    return replace(structure, masses=times * structure.masses, inertias=times * structure.inertias)


# --- on a pyramid -----------------------------------------------------------------------------------------------------

BASE, RATIO = 10, 300.0
PYRAMID = weighted(pyramid(BASE), -1, RATIO)
PYRAMID_PLACES = PYRAMID.centers - (0.5 * (BASE - 1), 0.0)


@scene(
    "Robustness/Heavy on a Pyramid",
    shows=stays(PYRAMID_PLACES, PYRAMID, len(PYRAMID.masses) - 1),
    view=(0.0, 5.0, 13.0),
)
def heavy_on_a_pyramid(world: World) -> None:
    """The topmost box of a pyramid is 300 times as heavy as the others. As Box2D's first of high mass ratios."""
    add_floor(world, 40)
    world.create_bodies(Box(1, 1), positions=PYRAMID_PLACES[:-1], friction=ROUGH)
    world.create_body(Box(1, 1), position=tuple(PYRAMID_PLACES[-1]), density=RATIO, friction=ROUGH)


# --- on the points of triangles ---------------------------------------------------------------------------------------

SIDE, FEET = 10.0, 4.5  # of the box, and how far the triangles are from the middle [m]
TRIANGLE = Polygon(((-0.5, -1.0 / 3.0), (0.5, -1.0 / 3.0), (0.0, 2.0 / 3.0)))  # about its centre of mass
TRIANGLE_PLACES = np.array([(-FEET, 1.0 / 3.0), (FEET, 1.0 / 3.0), (0.0, 1.0 + 0.5 * SIDE)])


def on_points() -> Structure:
    """A triangle touches the ground with two corners and carries the box on the third."""
    points = []
    for k, x in enumerate((-FEET, FEET)):
        points += [Point(GROUND, k, x - 0.5, 0.0), Point(GROUND, k, x + 0.5, 0.0), Point(k, 2, x, 1.0)]
    masses = np.array([TRIANGLE.area, TRIANGLE.area, SIDE * SIDE])
    inertia = TRIANGLE.inertia(TRIANGLE.area)
    return Structure(TRIANGLE_PLACES, masses, np.array([inertia, inertia, SIDE**4 * BOX_INERTIA]), points)


@scene(
    "Robustness/Heavy on Triangles",
    shows=stays(TRIANGLE_PLACES, on_points(), 2),
    view=(0.0, 5.5, 14.0),
)
def heavy_on_triangles(world: World) -> None:
    """A box balances on the points of two triangles of a 200th of its mass. As Box2D's third of high mass ratios."""
    add_floor(world, 40)
    for place in TRIANGLE_PLACES[:2]:
        world.create_body(TRIANGLE, position=tuple(place), friction=ROUGH)
    world.create_body(Box(SIDE, SIDE), position=tuple(TRIANGLE_PLACES[2]), friction=ROUGH)


# --- each twice as large as the one below -----------------------------------------------------------------------------

SIDES = np.array([1.0, 2.0, 4.0, 8.0])  # [m]
GROWING_PLACES = np.column_stack([np.zeros(len(SIDES)), np.cumsum(SIDES) - 0.5 * SIDES])


def growing() -> Structure:
    """Each stands on the sides of the one below."""
    points = [Point(GROUND, 0, -0.5, 0.0), Point(GROUND, 0, 0.5, 0.0)]
    tops = np.cumsum(SIDES)
    for k in range(1, len(SIDES)):
        half = 0.5 * SIDES[k - 1]
        points += [Point(k - 1, k, -half, tops[k - 1]), Point(k - 1, k, half, tops[k - 1])]
    return Structure(GROWING_PLACES, SIDES**2, BOX_INERTIA * SIDES**4, points)


@scene(
    "Robustness/Growing Stack",
    shows=stays(GROWING_PLACES, growing(), len(SIDES) - 1),
    view=(0.0, 7.5, 20.0),
)
def growing_stack(world: World) -> None:
    """Each box is twice as large as the one below, and four times as heavy. As the demo of AVBD has it."""
    add_floor(world, 40)
    for side, place in zip(SIDES, GROWING_PLACES, strict=True):
        world.create_body(Box(side, side), position=tuple(place), friction=ROUGH)


# --- box on box -------------------------------------------------------------------------------------------------------

PAIR_PLACES = np.array([(0.0, 0.5), (0.0, 1.5)])


def pair(ratio: float) -> Structure:
    """A unit box on another, so many times as heavy."""
    points = [Point(k - 1 if k else GROUND, k, x, float(k)) for k in (0, 1) for x in (-0.5, 0.5)]
    masses = np.array([1.0, ratio])
    return Structure(PAIR_PLACES, masses, BOX_INERTIA * masses, points)


def pair_stays(ratio: float) -> Criterion:
    """That of a heavy box on a light one."""
    return stays(PAIR_PLACES, pair(ratio), 1)


def add_pair(world: World, ratio: float) -> None:
    """A box on a box."""
    add_floor(world, 40)
    world.create_body(Box(1, 1), position=tuple(PAIR_PLACES[0]), friction=ROUGH)
    world.create_body(Box(1, 1), position=tuple(PAIR_PLACES[1]), density=ratio, friction=ROUGH)


@scene("Robustness/Heavy on Light", shows=pair_stays(100.0), view=(0.0, 1.5, 5.0))
def heavy_on_light(world: World) -> None:
    """A box on another of the same size and a hundredth of its mass."""
    add_pair(world, 100.0)
