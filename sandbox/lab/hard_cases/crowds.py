"""Too many in too little room."""

from __future__ import annotations

from sandbox.lab.hard_cases.case import Case, Stage, case
from sandbox.scenes.robustness.crowds import APART, GENTLY

TURNS, EVERY, UNTIL = 10.0, 1.25, 8.0  # gravity [m/s^2]; from one turn to the next, and to the last [s]


def turn_over(stage: Stage, number: int, dt: float) -> float:
    """Gravity is up, then down, and down in the end."""
    if number % round(EVERY / dt) == 0:
        turns = min(number * dt, UNTIL) // EVERY
        stage.set_gravity((0.0, -TURNS if turns % 2 == 0 else TURNS))
    return dt


CASES: dict[str, Case] = {
    "overlap_recovery": case("Stacking/Overlap Recovery", quick=True),
    "all_in_one_place": case("Robustness/All in One Place", shows=(APART, GENTLY)),
    "confined": case("Robustness/Confined"),
    "rush": case("Robustness/Rush"),
    "gravity_flip": case("Robustness/Turned Over", program=turn_over, quick=True),
    "overflow_of_colours": case("Robustness/Overflow of Colours", quick=True),
}
