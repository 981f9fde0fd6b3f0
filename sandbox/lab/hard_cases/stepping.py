"""Time steps that are long, that vary, and that are none."""

from __future__ import annotations

from engine import Circle, World
from sandbox.lab.hard_cases.case import Case, Stage, variant
from sandbox.lab.references import flight, flight_lag
from sandbox.lab.sag import predicted_column
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor, and_a_fifth, but_a_fifth
from sandbox.scenes.stacking.stacks import add_stack, column_stands
from sandbox.simulation import TIME_STEP

COUNT, STANDS = 10, 20.0  # boxes; [s]
LONGEST, SHORTEST = 2.0, 0.25  # in time steps
GOLDEN = 0.6180339887498949  # its multiples are spread as evenly as can be, and never repeat


def stack(world: World) -> None:
    """Ten boxes."""
    add_floor(world, 40)
    add_stack(world, COUNT)


def varying(stage: Stage, number: int, dt: float) -> float:
    """From an eighth of the longest to that."""
    part = (number * GOLDEN) % 1.0
    return dt * (SHORTEST + (LONGEST - SHORTEST) * part)


VARIED = (
    Criterion(
        "the top box has sunk by",
        lambda world: COUNT - 0.5 - float(world.positions[COUNT, 1]),
        unit="m",
        after=STANDS,
        at_most=and_a_fifth(
            lambda world, dt: predicted_column(world, LONGEST * dt, COUNT)
        ),  # as the longest would have
        at_least=but_a_fifth(lambda world, dt: predicted_column(world, SHORTEST * dt, COUNT)),  # and as the shortest
    ),
    column_stands(COUNT)[1],
)

# --- none -------------------------------------------------------------------------------------------------------------

DROPPED, FELL = 20.0, 1.5  # [m], [s]


def stack_and_stone(world: World) -> None:
    """Ten boxes, and a stone that falls beside them."""
    stack(world)
    world.create_body(Circle(0.4), position=(8.0, DROPPED))


def now_and_then_none(stage: Stage, number: int, dt: float) -> float:
    """Every other step takes no time: nothing may change in it."""
    return dt if number % 2 == 0 else 0.0


NOTHING = (
    Criterion(
        "the stone is off its parabola by",
        lambda world: abs(float(world.positions[COUNT + 1, 1]) - flight(DROPPED, 0.0, GRAVITY, FELL)),
        unit="m",
        after=FELL,
        at_most=lambda world, dt: 1.01 * flight_lag(GRAVITY, dt, FELL),  # symplectic Euler's, a whole step at a time
    ),
    *column_stands(COUNT),
)


def long_steps(rate: int) -> Case:
    """So many steps a second."""
    return variant(
        "Stacking/Vertical Stack 10",
        stack,
        f"Ten boxes, in steps of 1/{rate} s.",
        shows=column_stands(COUNT),
        dt=1.0 / rate,
        quick=True,
    )


CASES: dict[str, Case] = {
    "dt_30": long_steps(30),
    "dt_20": long_steps(20),
    "dt_varying": variant(
        "Stacking/Vertical Stack 10",
        stack,
        f"Ten boxes, in steps of {1e3 * SHORTEST * TIME_STEP:.0f} to {1e3 * LONGEST * TIME_STEP:.0f} ms.",
        shows=VARIED,
        program=varying,
        quick=True,
    ),
    "dt_zero": variant(
        "Stacking/Vertical Stack 10",
        stack_and_stone,
        "Ten boxes and a falling stone; every other step takes no time.",
        shows=NOTHING,
        program=now_and_then_none,
        quick=True,
    ),
}
