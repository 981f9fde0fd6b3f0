"""Towers and pyramids of unit boxes: they sink by what their contacts give way, and stand."""

from __future__ import annotations

import numpy as np

from engine import Box, World
from sandbox.lab.sag import predicted_column, predicted_pyramid
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, Predict, add_floor, and_a_fifth, but_a_fifth
from sandbox.scenes.registry import scene

STANDS = 20.0  # [s]


def add_stack(world: World, count: int, x: float = 0.0) -> None:
    """Unit boxes on each other, the lowest on y = 0."""
    places = np.column_stack([np.full(count, x), 0.5 + np.arange(count)])
    world.create_bodies(Box(1, 1), positions=places, friction=ROUGH)


def stands(body: int, height: float, predicted: Predict) -> tuple[Criterion, Criterion]:
    """The top box, by its number of creation, sinks by what the contacts' springs say, and stays above the others."""
    return (
        Criterion(
            "the top box has sunk by",
            lambda world: height - float(world.positions[body, 1]),
            unit="m",
            after=STANDS,
            at_most=and_a_fifth(predicted),
            at_least=but_a_fifth(predicted),
        ),
        Criterion(
            "the top box is off its place sideways by",
            lambda world: abs(float(world.positions[body, 0])),
            unit="m",
            after=STANDS,
            at_most=0.5,  # half its width: the weight is still above the base
        ),
    )


def column_stands(count: int) -> tuple[Criterion, Criterion]:
    """That of a stack of so many."""
    return stands(count, count - 0.5, lambda world, dt: predicted_column(world, dt, count))


@scene("Stacking/Vertical Stack 10", shows=column_stands(10), view=(0.0, 5.0, 13.0))
def vertical_stack_10(world: World) -> None:
    """Ten boxes: each contact carries the weight above it, and gives way for it."""
    add_floor(world, 40)
    add_stack(world, 10)


@scene("Stacking/Vertical Stack 20", shows=column_stands(20), view=(0.0, 10.0, 25.0))
def vertical_stack_20(world: World) -> None:
    """Twenty boxes: a column this soft would buckle, if its contacts were found anew in every step."""
    add_floor(world, 40)
    add_stack(world, 20)


@scene("Stacking/Vertical Stack 40", shows=column_stands(40), view=(0.0, 20.0, 48.0))
def vertical_stack_40(world: World) -> None:
    """Forty boxes: four times the sag of twenty, for it grows with the square of the height."""
    add_floor(world, 80)
    add_stack(world, 40)


BASE = 100


@scene(
    "Stacking/Pyramid 100",
    shows=stands(BASE * (BASE + 1) // 2, BASE - 0.5, lambda world, dt: predicted_pyramid(world, dt, BASE)),
    view=(0.0, 48.0, 118.0),
)
def pyramid_100(world: World) -> None:
    """5,050 boxes, a hundred in the lowest row: Box2D's own benchmark."""
    add_floor(world, 160)
    rows = [(row, np.arange(BASE - row)) for row in range(BASE)]
    x = np.concatenate([0.5 * row + i - 0.5 * (BASE - 1) for row, i in rows])
    y = np.concatenate([np.full(len(i), row + 0.5) for row, i in rows])
    world.create_bodies(Box(1, 1), positions=np.column_stack([x, y]), friction=ROUGH)
