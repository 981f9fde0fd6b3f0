"""A solver that is broken is caught: experiments and hard cases that hold with the sound one do not with it.

The soft step's program is run stage by stage, so that stages can be left out and its tables spoilt in between, all in
compiled code. Two more are wrong in whole steps: one moves nothing, one takes a part of all speeds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import World
from engine.solvers import SOLVERS, soft_step
from engine.solvers.soft_step.schedule import PREPARE, RELAX, RELAX_LAST
from engine.solvers.soft_step.work import run
from sandbox.lab import measures
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.lab.hard_cases import CASES
from sandbox.lab.stability import check
from sandbox.lab.stability_ladder import Variant
from sandbox.simulation import TIME_STEP
from tests.sandbox.lab.experimenting import empty_world, history_of

Spoil = Callable[[dict[str, Any]], None]


def stage_by_stage(left_out: tuple[int, ...] = (), spoil: Spoil = lambda tables: None) -> Callable[..., None]:
    """A solve that leaves out some kinds of stages, and spoils the tables once contacts are prepared."""

    def solve(state: Any, settings: Any) -> None:
        state.follow_contacts()
        plan = soft_step.plan_of(state, settings)
        _, _, counters, program, stages, _, *tables = plan.arguments
        for k in range(stages):
            kind = int(program["kind"][k])
            if kind not in left_out:
                run(True, 1, counters, program[k : k + 1], 1, counters, *tables)
            if kind == PREPARE:
                spoil(state.scratch)

    return solve


def forget_turning(tables: dict[str, Any]) -> None:
    """Effective masses without the term r^2 / I: as if a push never turned anything."""
    rows = tables["constraints"]
    straight = rows["inverse_mass1"] + rows["inverse_mass2"]
    for point in "ab":
        there = rows[f"{point}_mass"] > 0.0
        rows[f"{point}_mass"] = np.where(there, 1.0 / np.where(there, straight, 1.0), 0.0)


def double_masses(tables: dict[str, Any]) -> None:
    """Effective masses twice what they are."""
    for point in "ab":
        tables["constraints"][f"{point}_mass"] *= 2.0


def unclamp_friction(tables: dict[str, Any]) -> None:
    """Friction holds whatever presses."""
    tables["frictions"]["friction"] = 1e9


BROKEN = {
    "sound": stage_by_stage(),
    "no relax pass": stage_by_stage(left_out=(RELAX, RELAX_LAST)),
    "effective mass without turning": stage_by_stage(spoil=forget_turning),
    "effective mass doubled": stage_by_stage(spoil=double_masses),
    "friction unclamped": stage_by_stage(spoil=unclamp_friction),
}
CAUGHT_BY = {
    "no relax pass": {"collision_inelastic", "sliding", "incline"},
    "effective mass without turning": {"off_centre"},
    "effective mass doubled": {"off_centre", "collision"},
    "friction unclamped": {"sliding", "incline"},
}
LOOKED_AT = sorted(set.union(*CAUGHT_BY.values()))


def missed(name: str) -> list[str]:
    """Measures of an experiment whose error is above what a sound solver's is."""
    world = empty_world(substeps=8)
    history = history_of(EXPERIMENTS[name], world)
    found = []
    for measure in EXPERIMENTS[name].measures:
        limit = measure.limit(world, TIME_STEP)
        if limit is not None and not measure.error(history, TIME_STEP) <= limit:
            found.append(measure.what)
    return found


@pytest.mark.parametrize("name", LOOKED_AT)
@pytest.mark.parametrize("fault", BROKEN)
def test_experiments_catch_it(fault: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if fault != "sound" and name not in CAUGHT_BY[fault]:
        return
    monkeypatch.setitem(SOLVERS, "soft_step", replace(SOLVERS["soft_step"], solve=BROKEN[fault]))
    assert bool(missed(name)) == (fault != "sound")


def test_stage_by_stage_is_the_solver_itself() -> None:
    hashes = []
    for solve in (SOLVERS["soft_step"].solve, BROKEN["sound"]):
        with pytest.MonkeyPatch.context() as patch:
            patch.setitem(SOLVERS, "soft_step", replace(SOLVERS["soft_step"], solve=solve))
            world = empty_world()
            EXPERIMENTS["stack"].build(world)
            for _ in range(10):
                world.step(TIME_STEP)
            hashes.append(world.state_hash())
    assert hashes[0] == hashes[1]


def test_unclamped_friction_leaves_its_cone(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {}
    for fault in ("sound", "friction unclamped"):
        monkeypatch.setitem(SOLVERS, "soft_step", replace(SOLVERS["soft_step"], solve=BROKEN[fault]))
        world = empty_world()
        EXPERIMENTS["sliding"].build(world)
        world.step(TIME_STEP)
        found[fault] = measures.cone_violation(world).value
    assert found["sound"] < 1e-9
    assert found["friction unclamped"] > 0.1


def test_contacts_are_not_complementary_with_wrong_masses(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {}
    for fault in ("sound", "effective mass doubled"):
        monkeypatch.setitem(SOLVERS, "soft_step", replace(SOLVERS["soft_step"], solve=BROKEN[fault]))
        world = empty_world()
        EXPERIMENTS["collision_inelastic"].build(world)
        worst = []
        for _ in range(25):
            world.step(TIME_STEP)
            worst.append(measures.complementarity(world, TIME_STEP).value)
        found[fault] = max(worst)
    assert found["sound"] < 1e-9
    assert found["effective mass doubled"] > 0.1


# --- whole steps, in the hard cases -----------------------------------------------------------------------------------

STOLEN = 0.2  # of all speeds, in each step
SOUND_STEP = World.step
FROZEN_HOLDS = {"joint_grid": "a taut net: were its joints rigid, it would rest as it begins"}
"""Hard cases that cannot tell a world in which nothing moves, and why: what is at rest all the time."""
DAMPED_FALLS = {  # where something falls, slides, spins, swings or bounces, and does not only come to rest
    "ball_and_chain", "bounce_house", "bouncing_column", "bridge_160", "cart", "create_and_destroy", "dt_zero",
    "fast_spin", "friction_creep", "friction_ramp", "ghost_bumps", "gravity_flip", "pinball", "restitution",
    "restitution_threshold", "rush", "telescope", "tunnelling_1000",
}  # fmt: skip


def frozen(world: World, dt: float) -> None:
    """Time passes, and nothing moves."""
    world._state.time += dt
    world._state.step_count += dt > 0.0


def damped(world: World, dt: float) -> None:
    """A fifth of all speeds is lost."""
    SOUND_STEP(world, dt)
    if dt > 0.0:
        motions = world._state.bodies.tables["motions"]
        for name in ("vx", "vy", "w"):
            motions[name] *= 1.0 - STOLEN


@pytest.mark.parametrize("name", sorted(set(CASES) - {"pyramid_100"}))  # a dear one: pyramid_20 has its criteria
def test_hard_cases_catch_a_world_that_does_not_move(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(World, "step", frozen)
    assert check(name, Variant("soft_step")).passed is (name in FROZEN_HOLDS)


@pytest.mark.parametrize("name", sorted(DAMPED_FALLS))
def test_hard_cases_catch_stolen_speed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(World, "step", damped)
    assert check(name, Variant("soft_step")).passed is False
