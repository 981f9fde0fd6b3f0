"""Many steps in a row that stay in compiled code, as long as nothing calls for Python.

The stages are those of engine/stages.py in their order, and the kernels are the very ones that these call. Python takes
over in the middle of a step when a shape has left its fat box, so that pairs may change; when something began or ceased
to touch, so that it needs a colour; when something may fall asleep; when a body is so fast that it might go through
something; and when one is lost.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np

from engine.broad_phase.dynamic_tree import DynamicTree
from engine.broad_phase.tree_leaves import mark_outside, mark_some_outside
from engine.calling import address_of, call
from engine.colouring import any_change, any_change_among
from engine.continuous.ahead import drop_ahead
from engine.continuous.content import ahead
from engine.jit import kernel
from engine.narrow_phase.recycling import choose_pairs, write_boxes, write_some_boxes
from engine.rows import wide
from engine.settings import Settings
from engine.shapes.placing import GROUP
from engine.simd import WIDTH
from engine.sleeping import asking, may_sleep
from engine.solvers import SOLVERS
from engine.solvers.soft_step import SOFT_STEP, hurrying, movers, plan_of
from engine.solvers.soft_step.speeds import find_fast
from engine.solvers.soft_step.work import run
from engine.stages import STAGES, bounding, boxing, choosing, colliding, lost_in_solver
from engine.state import NOTHING, State
from engine.tables import empty
from engine.threads import usable

AT_MOST = 1000  # steps without a look at Python, which may have been told to stop
BODY_STEPS = 200_000  # likewise: steps times bodies
WORTHWHILE = 8  # steps that make up for what it takes to begin
LONGEST_PAUSE = 31  # steps that Python takes before the next try, where the last ones were not worthwhile
FIND_PAIRS, GIVE_COLOURS, UPDATE_POSITIONS, NOWHERE = 0, 3, 5, -1  # the stage from which Python goes on
LOST = len(STAGES)

GROUPS = wide(GROUP)
CALL = np.dtype([("address", np.int64), ("first", np.int64), ("last", np.int64)])
"""The kernel of one kind of shape or of pair, and where its own begin and end in the list of all."""

KERNELS = (
    "mark_outside", "write_boxes", "choose_pairs", "drop_ahead", "any_change", "may_sleep", "run", "find_fast",
    "finish",
)  # fmt: skip
ADDRESSES = np.dtype([(name, np.int64) for name in KERNELS])


@kernel(_nrt=False)  # as in soft_step/work.py
def repeat(
    number, dt, clock, report, addresses, outlines, colliders, groups, chosen, nothing, bounds, outside, boxes, choice,
    collision, ahead, change, rest, solution, hurry, end, ready,
):  # fmt: skip
    """Takes up to `number` steps, and adds their time to clock[0].

    Writes into report (3,) int64 how many it took, from which stage Python must go on with the next one, and which
    body was lost. The tuples, from `bounds` on, are what the kernels take, but for what differs from kind to kind.
    """
    to = addresses[0]
    for done in range(number):
        report[0] = done
        for k in range(len(outlines)):
            kind = outlines[k]
            call(kind.address, None, (groups[kind.first : kind.last], *bounds))
        if call(to.mark_outside, 0, outside) > 0:
            report[1] = FIND_PAIRS
            return
        call(to.write_boxes, None, boxes)
        for k in range(len(colliders)):
            kind = colliders[k]
            last = kind.first + call(to.choose_pairs, 0, (kind.first, kind.last, *choice))
            if last > kind.first:
                for place in range(last, last + WIDTH):
                    chosen[place] = nothing
                call(kind.address, None, (chosen, kind.first, last, *collision))
        call(to.drop_ahead, None, ahead)
        if call(to.any_change, False, change) or call(to.may_sleep, False, rest):
            report[1] = GIVE_COLOURS
            return
        call(to.run, None, solution)
        if call(to.find_fast, 0, hurry) > 0:
            report[1] = UPDATE_POSITIONS
            return
        ready[0] = call(to.finish, 0, end)
        if ready[0] < 0:
            report[1], report[2] = LOST, -1 - ready[0]
            return
        clock[0] += dt
    report[0] = number
    report[1] = NOWHERE


class Repetition(NamedTuple):
    """What `repeat` needs after number, dt, clock and report, as long as the solver's plan is the same."""

    plan: Any
    arguments: tuple


def repetition(state: State) -> Repetition:
    """Looks up all tables, and where the compiled kernels are."""
    table, plan, tree = state.arbiters, state.solve_plan, state.broad_phase
    assert isinstance(tree, DynamicTree)
    bodies, motions, order = state.bodies.tables["bodies"], state.bodies.tables["motions"], state.awake_order
    groups = _joined([group for _, group in state.awake_plan], GROUPS)
    indices = _joined([own for _, own, _ in state.meetings], np.dtype(np.int64))
    chosen = np.empty(len(indices) + WIDTH, np.int64)

    bounds = bounding(state)
    ranks = NOTHING if state.watched_ranks is None else state.watched_ranks
    watched = NOTHING if state.watched is None else state.watched
    outside = (state.bounds, *tree.borders(), ranks)
    boxes = boxing(state, ranks)
    choice = choosing(state, indices, chosen)
    collision = colliding(state)
    further, hurry = ahead(state), hurrying(state)
    change = (table.rows, table.count, watched)
    rest = asking(state)
    end = (0, len(order), order, bodies, motions, state.scratch["movers"], state.timed)
    if state.acting is None:
        mark, write, differ = mark_outside, write_boxes, any_change
    else:
        mark, write, differ = mark_some_outside, write_some_boxes, any_change_among

    def find(kernel: Any, result: Any, *arguments: Any) -> int:
        if kernel not in state.addresses:
            state.addresses[kernel] = address_of(kernel, result, arguments)
        return state.addresses[kernel]

    addresses = empty(1, ADDRESSES)
    addresses[0] = (
        find(mark, 0, *outside), find(write, None, *boxes), find(choose_pairs, 0, 0, 0, *choice),
        find(drop_ahead, None, *further), find(differ, False, *change), find(may_sleep, False, *rest),
        find(run, None, *plan.arguments), find(find_fast, 0, *hurry),
        find(movers.finish, 0, *end),
    )  # fmt: skip
    outlines, colliders = empty(len(state.awake_plan), CALL), empty(len(state.meetings), CALL)
    first = 0
    for k, (write_bounds, own) in enumerate(state.awake_plan):
        outlines[k] = (find(write_bounds, None, own, *bounds), first, first + len(own))
        first += len(own)
    first = 0
    for k, (collide, own, count) in enumerate(state.meetings):
        colliders[k] = (find(collide, None, chosen, 0, 0, *collision), first, first + count)
        first += len(own)
    return Repetition(
        plan,
        (
            addresses, outlines, colliders, groups, chosen, table.nothing, bounds, outside, boxes, choice, collision,
            further, change, rest, plan.arguments, hurry, end, state.ready,
        ),
    )  # fmt: skip


def _joined(lists: list[np.ndarray], dtype: np.dtype) -> np.ndarray:
    """One after the other."""
    return lists[0] if len(lists) == 1 else np.concatenate([np.empty(0, dtype), *lists])


def can_repeat(state: State, settings: Settings) -> bool:
    """Whether steps of this world, as it is prepared, can stay in compiled code."""
    return (
        not (
            numba.config.DISABLE_JIT
            or state.pairs_are_stale
            or state.colours_are_stale
            or state.forces
            or state.happened.on
            or state.lists_are_stale
            or state.boxes_are_stale
        )
        and state.prepared_carried == 1.0
        and "breaking joints" not in state.effects
        and SOLVERS[settings.solver] is SOFT_STEP
        and isinstance(state.broad_phase, DynamicTree)
        and usable(state.threads, max(len(state.awake_order), state.arbiters.count)) == 1
    )


def rest_through(state: State, steps: int, dt: float) -> int:
    """So many steps in which all sleeps. Returns how many."""
    for _ in range(steps):
        state.time += dt
    state.step_count += steps
    state.last_dt = dt
    return steps


def run_quietly(state: State, settings: Settings, steps: int, dt: float) -> tuple[int, int]:
    """Takes as many of the steps as it can. The state must be prepared for dt.

    Returns how many, and from which stage Python must go on with the next one: NOWHERE if nothing calls for it.
    StepError as in World.step.
    """
    if state.acting is not None and state.dormant:
        return rest_through(state, min(steps, AT_MOST), dt), NOWHERE
    if state.pause_left > 0 or not can_repeat(state, settings):
        state.pause_left = max(0, state.pause_left - 1)
        return 0, FIND_PAIRS
    plan = plan_of(state, settings)
    if state.repetition is None or state.repetition.plan is not plan:
        state.repetition = repetition(state)
    clock, report = np.array([state.time]), np.zeros(3, np.int64)
    most = max(1, min(AT_MOST, BODY_STEPS // max(1, len(state.awake_order))))
    repeat(min(steps, most), dt, clock, report, *state.repetition.arguments)
    done, stage, lost = (int(number) for number in report)
    if stage != NOWHERE:
        state.pause = 0 if done >= WORTHWHILE else min(2 * state.pause + 1, LONGEST_PAUSE)
        state.pause_left = state.pause
    if done:
        state.step_count += done
        state.time = float(clock[0])
        state.last_dt = dt
    if stage == LOST:
        raise lost_in_solver(state, int(state.awake_order[lost]))
    return done, stage
