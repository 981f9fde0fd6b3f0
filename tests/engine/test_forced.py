"""Every effect's code running without content: not a bit changes in 300 steps.

tests/engine/effects/test_on_demand.py holds the rest: what is not called for has no table, is not compiled, not run.
"""

from __future__ import annotations

import pytest

from engine import EFFECTS, SOLVERS, World
from engine.effects.sleeping import SLEEPING
from tests.engine import tiny_worlds
from tests.engine.worlds import DT, busy, gathering, run

STEPS = 300
PLAIN = {title: case for title, case in tiny_worlds.cases().items() if not case[3]}


def force(world: World) -> World:
    """Runs the code of every effect that the solver knows. Sleeping is a setting, and no test of this."""
    unknown = {SLEEPING.name, *SOLVERS[world.solver].lacks}
    world._state.forced = frozenset(effect.name for effect in EFFECTS if effect.name not in unknown)
    world._state.stale = True
    return world


@pytest.mark.parametrize("title", PLAIN)
def test_forcing_every_effect_changes_nothing(title: str) -> None:
    name, solver, precision, _ = PLAIN[title]
    plain = tiny_worlds.fill(name, solver, precision)
    forced = force(tiny_worlds.fill(name, solver, precision))
    for step in range(STEPS):
        plain.step(DT)
        forced.step(DT)
        if step % 50 == 0:
            assert plain.state_hash() == forced.state_hash(), f"step {step + 1}"
    assert plain.state_hash() == forced.state_hash()
    known = {effect.name for effect in EFFECTS} - {SLEEPING.name, *SOLVERS[solver].lacks}
    assert forced._state.effects - {SLEEPING.name} == known
    assert plain._state.effects < forced._state.effects
    if solver == "soft_step":
        tables = {"frictions", "belts", "rollings", "bounces"}
        assert tables <= set(forced._state.scratch), "their tables are there"
        assert {"bounces", "belts"} & set(plain._state.scratch) == ({"bounces", "belts"} if name == "lively" else set())


@pytest.mark.parametrize("make", [busy, gathering])
def test_what_is_forced_is_told_as_it_is(make) -> None:
    # the list says what the content calls for, whatever is forced
    world, other = force(make("single")), make("single")
    run(world, 3)
    run(other, 3)
    assert world.effects == other.effects


def test_forced_code_lets_go_again() -> None:
    world = force(busy("single"))
    run(world, 3)
    assert world._state.bodies.columns
    world._state.forced = frozenset()
    world._state.stale = True
    run(world, 3)
    assert not world._state.bodies.columns
    assert world._state.gravity_scales is None
