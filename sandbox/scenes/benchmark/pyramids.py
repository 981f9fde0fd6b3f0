"""Boxes that stand: what a solver is timed with before anything else."""

from __future__ import annotations

from engine import Box, Segment, World
from engine.constants import SLOP
from sandbox.scenes.benchmark.parts import pyramid_places
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor, moved
from sandbox.scenes.registry import scene

# --- one of 5,050 boxes -----------------------------------------------------------------------------------------------

LARGE_BASE = 100
LARGE_PLACES = pyramid_places(LARGE_BASE, 0.0, 0.0)


@scene(
    "Benchmark/Large Pyramid",
    shows=Criterion(
        "a box is off its place by",
        lambda world: moved(world, 1, LARGE_PLACES),
        unit="m",
        after=0.5,
        at_most=LARGE_BASE * SLOP,  # overlap that is left alone, in every layer
    ),
    view=(0.0, 48.0, 110.0),
)
def large_pyramid(world: World) -> None:
    """A pyramid of 5,050 boxes, a hundred in its lowest row.

    As Box2D's large_pyramid: boxes of 1 m side to side and on each other without a gap, friction 0.6.
    """
    add_floor(world, 200)
    world.create_bodies(Box(1, 1), positions=LARGE_PLACES, friction=ROUGH)


# --- four hundred of 55 -----------------------------------------------------------------------------------------------

BASE, ROWS, COLUMNS = 10, 20, 20
PITCH = BASE + 1.0  # from pyramid to pyramid, either way [m]
WIDTH = COLUMNS * PITCH
FEET = [(-0.5 * WIDTH + PITCH * column + 5.5, PITCH * row) for row in range(ROWS) for column in range(COLUMNS)]
APEX = BASE * (BASE + 1) // 2  # bodies a pyramid


def lowest_apex(world: World) -> float:
    """How far the lowest of the tops is below its place [m]."""
    tops = world.positions[APEX::APEX, 1]  # body 0 is the ground
    return float(max(y + BASE - 0.5 - top for (_, y), top in zip(FEET, tops, strict=True)))


@scene(
    "Benchmark/Many Pyramids",
    shows=Criterion(
        "an apex is lower than ten boxes by",
        lowest_apex,
        unit="m",
        after=0.2,
        at_most=BASE * SLOP,  # overlap that is left alone, in every layer
    ),
    view=(0.0, 110.0, 240.0),
)
def many_pyramids(world: World) -> None:
    """Four hundred pyramids of 55 boxes, on twenty shelves.

    As Box2D's many_pyramids: shelves are segments of 220 m and 11 m apart, with twenty pyramids of base ten on each.
    """
    shelves = world.create_body(kind="static")
    for row in range(ROWS):
        shelves.add_shape(Segment((-0.5 * WIDTH, PITCH * row), (0.5 * WIDTH, PITCH * row)), friction=ROUGH)
    for x, y in FEET:
        world.create_bodies(Box(1, 1), positions=pyramid_places(BASE, x, y), friction=ROUGH)
