"""What a solver is to the step: its last three stages, and what it can do."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State


def no_chains(state: State, settings: Settings, order: np.ndarray) -> None:
    """Joints are visited one by one."""


def rounded_step(dt: float) -> float:
    """The time step for which `find_chains` chooses [s]: 1/60 times a power of two. So a step that is measured, and
    never quite the same, calls for a choice no more often than it doubles or halves.
    """
    return 2.0 ** round(math.log2(60.0 * dt)) / 60.0


def solve_planned(
    state: State, settings: Settings, solve_all: Callable[..., Any], arguments: Callable[[State, Settings], tuple]
) -> None:
    """Solves with what `arguments` looks up, anew only where content, settings or what touches changed."""
    state.follow_contacts()
    if state.solve_plan is None:
        state.solve_plan = arguments(state, settings)
    solve_all(*state.solve_plan)


@dataclass(frozen=True)
class Solver:
    """A way to keep contacts and joints. The stages that can lose a body return its row, or -1."""

    name: str
    apply_forces: Callable[[State, Settings], int]
    solve: Callable[[State, Settings], None]
    update_positions: Callable[[State, Settings], int]
    iterations: int  # where the user says nothing
    substeps: int = 1
    has_substeps: bool = False
    has_iterations: bool = True  # else it solves its constraints at once
    visits: float = 1.0  # of each constraint in one iteration: by these the laboratory counts work
    speculative: bool = False  # it takes contacts before shapes touch, and kept ones
    talk_clipping: bool = False  # two boxes collide as in the talk
    find_chains: Callable[[State, Settings, np.ndarray], Any] = no_chains  # joints that it solves at once
    lacks: tuple[str, ...] = ()  # effects that it refuses
