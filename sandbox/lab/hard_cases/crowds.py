"""Too many in too little room."""

from __future__ import annotations

from engine import World
from sandbox.lab.hard_cases.case import Case, Stage, case
from sandbox.scenes import find_scene
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.robustness.crowds import APART, GENTLY, HALL, SPREAD, TURNED
from sandbox.simulation import TIME_STEP

TURNS, EVERY, UNTIL = 10.0, 1.25, 8.0  # gravity [m/s^2]; from one turn to the next, and to the last [s]


def turn_over(stage: Stage, number: int, dt: float) -> float:
    """Gravity is up, then down, and down in the end."""
    if number % round(EVERY / dt) == 0:
        turns = min(number * dt, UNTIL) // EVERY
        stage.set_gravity((0.0, -TURNS if turns % 2 == 0 else TURNS))
    return dt


def mean_height(world: World) -> float:
    """Of all boxes [m]."""
    return float(world.positions[1:, 1].mean())


OVER = 2.0 * EVERY - TIME_STEP  # just before gravity is down again, it was up for longer than a fall takes [s]
TURNING = (
    *find_scene("Robustness/Turned Over").shows,
    Criterion("at the ceiling, the boxes' mean height is", mean_height, "m", OVER, at_least=0.5 * HALL),
    Criterion("in the end, the boxes' mean height is", mean_height, "m", TURNED, at_most=0.5 * HALL),
)

CASES: dict[str, Case] = {
    "overlap_recovery": case("Stacking/Overlap Recovery", quick=True),
    "all_in_one_place": case("Robustness/All in One Place", shows=(APART, GENTLY, SPREAD)),
    "confined": case("Robustness/Confined"),
    "rush": case("Robustness/Rush"),
    "gravity_flip": case("Robustness/Turned Over", shows=TURNING, program=turn_over, quick=True),
    "overflow_of_colours": case("Robustness/Overflow of Colours", quick=True),
}
