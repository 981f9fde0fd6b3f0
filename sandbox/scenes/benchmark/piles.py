"""Heaps: bodies dropped into a container, which come to rest on each other as they happen to fall."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World
from sandbox.scenes.benchmark.parts import grid_places, one_steps_fall, outside, overlap
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH
from sandbox.scenes.registry import Build, scene

SEED = 20261122
APART = 1.45  # of boxes [m]: more than their diagonal, they may turn as they like
CIRCLES_APART = 1.1


def columns_of(count: int) -> int:
    """Of so many bodies, four times as many beside each other as on each other."""
    return math.ceil(2.0 * math.sqrt(count))


def half_width(count: int, apart: float) -> float:
    """Of a container for so many [m]."""
    return 0.5 * apart * (columns_of(count) + 0.5)


def add_container(world: World, half: float, height: float) -> Body:
    """A floor at y = 0 and walls at -half and half [m]."""
    container = world.create_body(Box(2.0 * half + 4.0, 2.0), offset=(0.0, -1.0), kind="static", friction=ROUGH)
    for x in (-half - 1.0, half + 1.0):
        container.add_shape(Box(2.0, height), offset=(x, 0.5 * height), friction=ROUGH)
    return container


def drop_places(count: int, apart: float) -> np.ndarray:
    """(count, 2) places above the floor, row by row; each row is half a place beside the one below [m]."""
    columns = columns_of(count)
    rows = math.ceil(count / columns)
    places = grid_places(rows, columns, 0.5 * apart, -0.5 * apart * (columns - 1), apart, apart)[:, ::-1]
    places[:, 0] += np.repeat(np.resize((0.25, -0.25), rows), columns) * apart
    return places[:count]


def held(count: int, apart: float, after: float = 0.5) -> tuple[Criterion, Criterion]:
    """That the container holds so many, and that they do not sink into each other."""
    half = half_width(count, apart)
    return (
        Criterion(
            "the middle of a body has left the container by",
            lambda world: outside(world, 1, (-half, 0.0, half, np.inf)),
            unit="m",
            after=after,
            at_most=0.0,
        ),
        Criterion("the deepest overlap is", overlap, unit="m", after=after, at_most=one_steps_fall(after)),
    )


# --- boxes ------------------------------------------------------------------------------------------------------------


def pile(count: int) -> Build:
    """A scene of so many boxes."""

    def build(world: World) -> None:
        half = half_width(count, APART)
        add_container(world, half, half)
        turns = np.random.default_rng(SEED).uniform(0.0, math.tau, count)
        world.create_bodies(Box(1, 1), positions=drop_places(count, APART), angles=turns, friction=ROUGH)

    half = half_width(count, APART)
    build.__doc__ = f"{count:,} boxes, turned at random, are dropped into a container and settle as a heap."
    shown = scene(f"Benchmark/Pile {count}", shows=held(count, APART), view=(0.0, 0.5 * half, 1.6 * half))
    return shown(build)


pile_1000, pile_5000, pile_20000 = pile(1000), pile(5000), pile(20_000)


# --- circles ----------------------------------------------------------------------------------------------------------

CIRCLES = 5000


@scene(
    "Benchmark/Circles 5000",
    shows=held(CIRCLES, CIRCLES_APART),
    view=(0.0, 0.5 * half_width(CIRCLES, CIRCLES_APART), 1.6 * half_width(CIRCLES, CIRCLES_APART)),
)
def circles_5000(world: World) -> None:
    """Five thousand discs are dropped into a container and settle as a heap."""
    half = half_width(CIRCLES, CIRCLES_APART)
    add_container(world, half, half)
    places = drop_places(CIRCLES, CIRCLES_APART)
    places += np.random.default_rng(SEED).uniform(-0.04, 0.04, places.shape)  # or they would stand in columns
    world.create_bodies(Circle(0.5), positions=places, friction=ROUGH)


# --- every shape ------------------------------------------------------------------------------------------------------

MIXED = 3000
SHAPES: tuple[Shape, ...] = (
    Box(1.0, 0.6),
    Circle(0.45),
    Capsule(0.7, 0.25),
    Polygon(((0.5, -0.2), (0.3, 0.4), (-0.2, 0.5), (-0.5, 0.0), (-0.1, -0.4))),
    Polygon(((0.35, -0.25), (0.0, 0.35), (-0.35, -0.25)), radius=0.15),
)


@scene(
    "Benchmark/Mixed Pile",
    shows=held(MIXED, APART, after=1.5),
    view=(0.0, 0.5 * half_width(MIXED, APART), 1.6 * half_width(MIXED, APART)),
)
def mixed_pile(world: World) -> None:
    """Three thousand boxes, discs, capsules, polygons and rounded ones fall on a chain and two segments."""
    half = half_width(MIXED, APART)
    container = add_container(world, half, half)
    waves = tuple((x, 1.5 - 1.5 * math.cos(0.25 * x)) for x in np.linspace(-half, half, 160).tolist())
    container.add_shape(Chain(waves), friction=ROUGH)
    for side in (-1.0, 1.0):
        container.add_shape(Segment((side * half, 8.0), (side * 0.7 * half, 4.0)), friction=ROUGH)
    rng = np.random.default_rng(SEED)
    places = drop_places(MIXED, APART)
    places[:, 1] += 9.0
    rng.shuffle(places)
    turns = rng.uniform(0.0, math.tau, MIXED)
    for k, shape in enumerate(SHAPES):
        own = slice(k, None, len(SHAPES))
        world.create_bodies(shape, positions=places[own], angles=turns[own], friction=ROUGH)
