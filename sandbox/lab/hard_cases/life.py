"""What happens to a world during its life: bodies come and go, loads are taken off, sleepers are woken."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from engine import Box, Circle, World
from sandbox.lab.hard_cases.case import Case, Stage, case, variant
from sandbox.lab.sag import BOX_INERTIA, predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, ROUGH, add_floor, but_a_fifth
from sandbox.scenes.robustness.crowds import add_room, outside, overlap
from sandbox.scenes.stacking.stacks import add_stack
from sandbox.simulation import TIME_STEP

# --- a load is taken off ----------------------------------------------------------------------------------------------

UNDER, TAKEN, WATCHED = 4, 3.0, 6.0  # boxes; [s]
BALL = 1.0  # radius of the load [m]


def loaded(world: World, load: float) -> None:
    """Boxes that carry a ball, so many times as heavy as one of them."""
    add_floor(world, 40)
    add_stack(world, UNDER)
    world.create_body(Circle(BALL), position=(0.0, UNDER + BALL), mass=load, friction=ROUGH)


def take_off(stage: Stage, number: int, dt: float) -> float:
    """The ball is gone from one step to the next: what warm starting remembers of it must be, too."""
    if number == round(TAKEN / dt):
        stage.destroy(UNDER + 1)
    return dt


def carrying(load: float) -> Structure:
    """The boxes and the ball upon them."""
    points = [Point(k - 1 if k else GROUND, k, x, float(k)) for k in range(UNDER) for x in (-0.5, 0.5)]
    points.append(Point(UNDER - 1, UNDER, 0.0, float(UNDER)))
    centers = [(0.0, 0.5 + k) for k in range(UNDER)] + [(0.0, UNDER + BALL)]
    masses = np.append(np.ones(UNDER), load)
    inertias = np.append(np.full(UNDER, BOX_INERTIA), 0.5 * load * BALL**2)
    return Structure(np.array(centers), masses, inertias, points)


def relieved(load: float) -> tuple[Criterion, ...]:
    """It was pressed down, as far as statics say, and comes back no further than it was put."""
    return (
        *RELIEVED,
        Criterion(
            "under its load, the top box has sunk by",
            lambda world: UNDER - 0.5 - float(world.positions[UNDER, 1]),
            unit="m",
            after=TAKEN,
            at_least=but_a_fifth(lambda world, dt: predicted_sink(world, dt, carrying(load), UNDER - 1)),
        ),
    )


RELIEVED = (
    Criterion(
        "the top box has risen over where it was put by",
        lambda world: float(world.positions[UNDER, 1]) - (UNDER - 0.5),
        unit="m",
        after=WATCHED,
        at_most=0.01,
        throughout=True,
    ),
    Criterion(
        "in the end, the top box is off its place sideways by",
        lambda world: abs(float(world.positions[UNDER, 0])),
        unit="m",
        after=WATCHED,
        at_most=0.5,
    ),
)

# --- bodies come and go -----------------------------------------------------------------------------------------------

HALF, HEIGHT, CROWD, EVERY, LASTS = 3.0, 12.0, 40, 9, 12.0  # of the room [m]; bodies; steps; [s]
LANES = (-2.1, 0.7, -0.7, 2.1)  # where they come in [m]
SHAPES = (Box(0.6, 0.6), Circle(0.35), Box(0.9, 0.4))


def room(world: World) -> None:
    """Empty."""
    add_room(world, HALF, HEIGHT)


def come_and_go(stage: Stage, number: int, dt: float) -> float:
    """One comes in from above now and then; when there are many, the oldest goes."""
    if number % EVERY == 0:
        k = number // EVERY
        stage.create(SHAPES[k % 3], (LANES[k % 4], HEIGHT - 1.0), angle=0.5 * k, friction=ROUGH)
        if stage.world.body_count > CROWD:
            stage.destroy(1)
    return dt


FALLS = 2.0  # [s]: from the ceiling it is 1.5 s to the ground


def settled(world: World) -> float:
    """The highest of the bodies that came in long enough ago to have fallen [m]."""
    newest = math.ceil(FALLS / (EVERY * TIME_STEP))
    return float(world.positions[1:-newest, 1].max())


COMING_AND_GOING = (
    Criterion("a body is out of the room by", lambda world: outside(world, HALF, HEIGHT), "m", LASTS, 0.0),
    Criterion(
        "the deepest overlap is",
        overlap,
        unit="m",
        after=LASTS,
        at_most=lambda world, dt: math.sqrt(2.0 * GRAVITY * HEIGHT) * dt,  # what meets may go so far in a step
        throughout=True,
    ),
    Criterion(
        "how many bodies there are, but for the room and the crowd",
        lambda world: float(abs(world.body_count - CROWD)),
        unit="",
        after=LASTS,
        at_most=0.0,
    ),
    Criterion(
        "the highest that has been there for two seconds lies at",
        settled,
        unit="m",
        after=LASTS,
        at_most=0.5 * HEIGHT,  # all that there are fill a fifth of the room
    ),
)

# --- a sleep storm ----------------------------------------------------------------------------------------------------

A_ROW, STACK, STORM, CALM = 12, 4, 8.0, 12.0  # stacks and boxes in one; until when they are woken, and all [s]
PLACES = np.array([(2.0 * (i - 0.5 * (A_ROW - 1)), 0.5 + k) for i in range(A_ROW) for k in range(STACK)])


def stacks(world: World) -> None:
    """A row of stacks."""
    add_floor(world, 80)
    world.create_bodies(Box(1, 1), positions=PLACES, friction=ROUGH)


def wake_all(stage: Stage, number: int, dt: float) -> float:
    """All are woken every second, by another gravity, one part in a million more."""
    if number * dt < STORM and number % round(1.0 / dt) == 0:
        stage.set_gravity((0.0, -GRAVITY * (1.0 + 1e-6 * (number % 2))))
        stage.set_gravity((0.0, -GRAVITY * (1.0 + 1e-6 * ((number + 1) % 2))))
    return dt


STORMY = (
    Criterion("bodies awake in the end:", lambda world: float(world.awake_count), "", CALM, at_most=0.0),
    Criterion(
        "a box is off its place sideways by",
        lambda world: float(np.abs(world.positions[1:, 0] - PLACES[:, 0]).max()),
        unit="m",
        after=CALM,
        at_most=1e-3,
    ),
)


CASES: dict[str, Case] = {
    **{
        f"load_removed_{load}": variant(
            "Stacking/Vertical Stack 10",
            partial(loaded, load=float(load)),
            f"A ball of {load} boxes' mass is taken off a stack.",
            shows=relieved(float(load)),
            program=take_off,
            quick=True,
        )
        for load in (20, 100)
    },
    "create_and_destroy": variant(
        "Robustness/Turned Over",
        room,
        "Bodies come in from above, and the oldest go.",
        shows=COMING_AND_GOING,
        program=come_and_go,
    ),
    "sleep_stacks": case("Sleeping/Stacks", sleeping=True, ours_alone="who sleeps is not asked of it"),
    "sleep_storm": variant(
        "Sleeping/Stacks",
        stacks,
        "Stacks that are woken every second fall asleep again, and do not wander.",
        shows=STORMY,
        program=wake_all,
        sleeping=True,
        ours_alone="who sleeps is not asked of it",
        quick=True,
    ),
}
