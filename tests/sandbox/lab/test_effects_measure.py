"""What effects cost is measured on copies; costs that are known are found."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

import engine.lacking
import engine.state
from engine import EFFECTS, Box, Circle, World
from engine.settings import Settings
from engine.state import State
from sandbox.lab import ablation
from sandbox.lab.ablation import Difference, ablations, compare_all, everything_idle, measure, step_time
from sandbox.lab.compile_costs import CompileError, compile_costs
from tests.engine.worlds import DT, busy, fingerprint, run

BURNT_US = 400.0
QUICK = 0.2  # [s]


def burn(state: State, settings: Settings) -> None:
    """Takes a known time."""
    end = time.thread_time_ns() + 1e3 * BURNT_US
    while time.thread_time_ns() < end:
        pass


@pytest.fixture
def slow_drag(monkeypatch: pytest.MonkeyPatch) -> None:
    """Drag takes BURNT_US and does nothing."""
    effects = tuple(replace(effect, apply=burn) if effect.name == "drag" else effect for effect in EFFECTS)
    for module in (engine.state, engine.lacking, ablation):
        monkeypatch.setattr(module, "EFFECTS", effects)


@pytest.mark.usefixtures("slow_drag")
@pytest.mark.parametrize("drag", [0.0, 1.0])
def test_a_known_cost_is_found(drag: float) -> None:
    """Whether the scene calls for the effect, and it is left out, or not, and it is forced."""
    world = World()
    world.create_body(Circle(0.5), drag=drag)
    costs = measure(world, names=("drag", "gravity"), seconds=QUICK)
    assert costs["drag"] == pytest.approx(BURNT_US, rel=0.2)
    assert abs(costs["gravity"]) < 0.1 * BURNT_US


@pytest.mark.usefixtures("slow_drag")
def test_the_cost_of_wind_is_without_that_of_drag() -> None:
    world = World()
    world.create_body(Circle(0.5))
    assert abs(measure(world, names=("wind",), seconds=QUICK)["wind"]) < 0.2 * BURNT_US


@pytest.mark.usefixtures("slow_drag")
def test_everything_that_is_idle_together() -> None:
    world = World()
    world.create_body(Circle(0.5), linear_damping=1.0)
    idle = everything_idle(world)
    forced, suppressed = idle.with_it
    assert suppressed == frozenset()
    assert {"drag", "wind", "buoyancy", "restitution"} <= forced
    assert not forced & {"gravity", "linear damping", "diagnostics", "explosions"}
    found = compare_all(world.snapshot(), [idle], seconds=QUICK)["everything idle"]
    assert BURNT_US < found.median < 2.0 * BURNT_US
    assert not found.is_noise


def test_noise_is_told_from_a_cost() -> None:
    rng = np.random.default_rng(5)
    noise = rng.normal(0.0, 10.0, 400)
    assert Difference.of(noise).is_noise
    assert 0.5 < Difference.of(noise).noise < 2.0
    assert not Difference.of(noise + 3.0).is_noise


def test_the_world_is_only_read() -> None:
    world = run(busy("single"), 20)
    before, state = fingerprint(world), world._state
    costs = measure(world, seconds=QUICK)
    assert fingerprint(world) == before
    assert world._state is state
    assert (state.forced, state.suppressed) == (frozenset(), frozenset())
    assert set(costs) == {effect.name for effect in EFFECTS}
    assert run(world, 20).state_hash() == run(busy("single"), 40).state_hash()


def test_on_a_thread_of_its_own_while_the_world_goes_on() -> None:
    world = run(busy("single"), 5)
    found: dict[str, float] = {}
    snapshot = world.snapshot()
    thread = threading.Thread(target=lambda: found.update(measure(snapshot, names=("friction",), seconds=QUICK)))
    thread.start()
    run(world, 200)
    thread.join()
    assert "friction" in found
    assert world.state_hash() == run(busy("single"), 205).state_hash()


def test_what_the_solver_lacks_is_left_out() -> None:
    world = busy("single", solver="sequential_impulses")
    names = {one.name for one in ablations(world)}
    assert "gravity" in names
    assert not names & {"restitution", "rolling resistance", "conveyor"}


def test_a_scene_that_cannot_do_without_an_effect_is_measured_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World()
    body = world.create_body(Box(1, 1))
    calls = iter(range(10_000))

    def fail(state: State, settings: Settings) -> None:
        if next(calls) % 7 == 0:
            body_force = state.bodies.tables["bodies"]["force_x"]
            body_force[body._row] = float("nan")

    effects = tuple(replace(effect, apply=fail) if effect.name == "drag" else effect for effect in EFFECTS)
    for module in (engine.state, engine.lacking, ablation):
        monkeypatch.setattr(module, "EFFECTS", effects)
    assert "gravity" in measure(world, names=("drag", "gravity"), seconds=QUICK)


def test_progress_ends_with_all_of_it() -> None:
    told: list[float] = []
    measure(busy("single"), names=("friction",), seconds=QUICK, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert len(told) >= ablation.FEWEST_ROUNDS


@pytest.mark.usefixtures("slow_drag")
def test_the_time_of_a_step() -> None:
    world = World()
    world.create_body(Circle(0.5), drag=1.0)
    assert BURNT_US < step_time(world) < 3.0 * BURNT_US
    assert world.step_count == 0


def test_compiling_is_timed_from_nothing() -> None:
    world = World()
    world.create_body(Circle(0.5))
    world.step(DT)
    costs = compile_costs(world.snapshot())
    assert set(costs) == {effect.name for effect in EFFECTS}
    assert all(seconds >= 0.0 for seconds in costs.values())
    for name in ("drag", "buoyancy", "magnets", "explosions", "friction", "revolute joints", "filters"):
        assert costs[name] > 0.02, f"{name} has kernels of its own"
    assert costs["buoyancy"] > costs["drag"], "ten kernels against one"
    assert costs["gravity"] < 0.5 * costs["buoyancy"], "only an argument of a kernel that is there anyway"


def test_a_process_that_fails_is_told_in_one_line() -> None:
    world = World()
    world.create_body(Circle(0.5))
    snapshot = world.snapshot()
    snapshot.tables["step_count"] = snapshot.tables["step_count"] - 1
    with pytest.raises(CompileError, match=r"failed: ValueError: snapshot: its table step_count must be >= 0$") as told:
        compile_costs(snapshot)
    assert "\n" not in str(told.value)
