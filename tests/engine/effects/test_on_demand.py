"""An effect that a scene does not call for has no table, compiles no kernel and runs no code."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import engine
from engine import EFFECTS, SOLVERS, Circle, World
from tests.engine.effects import effect_worlds, plain_pyramid
from tests.engine.worlds import DT, PRECISIONS, gathering, run

ROOT = Path(engine.__file__).parents[1]

# Where the code of effects is that solvers and stages bring: all of these kernels, or one.
ELSEWHERE = {
    "restitution": ("engine.solvers.soft_step.restitution.",),
    "rolling resistance": ("engine.solvers.soft_step.rolling.",),
    "conveyor": ("engine.solvers.soft_step.friction.prepare_belts",),
    "revolute joints": ("engine.solvers.soft_step.joints.point.", "engine.solvers.talk_joints."),
    "prismatic joints": ("engine.solvers.soft_step.joints.line.",),
    "distance joints": ("engine.solvers.soft_step.joints.slide.",),
    "weld joints": ("engine.solvers.soft_step.joints.turn.",),
    "joint springs": ("engine.solvers.soft_step.joints.free.",),
    "chains": ("engine.solvers.soft_step.direct.",),
    "joined without colliding": ("engine.pairs.drop_joined",),
    "events": ("engine.happened.", "engine.touching."),
    "diagnostics": ("engine.diagnostics.",),
    "bullets": ("engine.continuous.stops.",),  # nothing there is fast, let alone a bullet
}


def both(program: ModuleType) -> dict[bool, Any]:
    """What a program prints in a process of its own, by whether it compiled; both at once."""
    running = {}
    for compiled in (False, True):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": str(int(not compiled))}
        environment.pop("NUMBA_JIT_COVERAGE", None)
        running[compiled] = subprocess.Popen(
            [sys.executable, str(program.__file__)], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True,
        )  # fmt: skip
    found = {}
    for compiled, process in running.items():
        out, errors = process.communicate()
        assert process.returncode == 0, errors
        found[compiled] = json.loads(out)
    return found


@pytest.fixture(scope="module")
def pyramid() -> dict[bool, Any]:
    return both(plain_pyramid)


@pytest.fixture(scope="module")
def worlds() -> dict[bool, Any]:
    return both(effect_worlds)


def test_a_plain_pyramid_compiles_no_kernel_of_an_unused_effect(pyramid: dict[bool, Any]) -> None:
    signatures = pyramid[True]["signatures"]
    assert pyramid[True]["used"] == sorted(plain_pyramid.USED)
    compiled = {name for name, found in signatures.items() if found}
    assert "engine.solvers.soft_step.work.run" in compiled
    assert not {name for name in compiled if name.startswith("engine.effects.")}
    for effect, places in ELSEWHERE.items():
        for place in places:
            assert any(name.startswith(place) for name in signatures), f"{effect}: {place} is not there any more"
            assert not [name for name in compiled if name.startswith(place)], effect


def test_more_effects_change_no_kernel_and_no_signature(pyramid: dict[bool, Any]) -> None:
    # as they are, with ten more, and with those alone that the pyramid uses: one process after the other
    assert pyramid[True]["signatures"] == pyramid[True]["signatures after"]
    assert {row["hash"] for row in pyramid[True]["counts"].values()} == {pyramid[True]["hash"]}


def test_more_effects_change_no_instruction_of_a_step(pyramid: dict[bool, Any]) -> None:
    """Without compilation a kernel is Python: every bytecode that a step runs is counted."""
    counts = pyramid[False]["counts"]
    plain = counts["as they are"]
    assert plain["bytecodes"] > 100_000
    assert not [name for name in plain["calls"] if name.startswith("effects")]
    assert plain == counts["with more"]
    assert plain == counts["those used"]


@pytest.mark.parametrize("name", effect_worlds.variants())
def test_same_bits_with_and_without_compilation(worlds: dict[bool, Any], name: str) -> None:
    plain, compiled = worlds[False]["worlds"][name], worlds[True]["worlds"][name]
    assert plain == compiled
    assert len(set(plain)) == effect_worlds.STEPS


def test_every_kernel_of_the_effects_is_compiled_for_few_types(worlds: dict[bool, Any]) -> None:
    counts = worlds[True]["signatures"]
    assert counts["engine.effects.drag.add_drag"] == 2, "one for each precision"
    # what works in float64 alone is compiled once; nothing for dt = 1 beside dt = 1.0
    too_many = {name: count for name, count in counts.items() if count > 2}
    assert not too_many


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_forced_code_without_content_changes_nothing(solver: str, precision: str) -> None:
    expected = run(gathering(precision, solver=solver), 60).state_hash()
    world = gathering(precision, solver=solver)
    idle = {effect.name for effect in world.effects if not effect.called_for}
    assert {"drag", "wind", "buoyancy", "magnets", "point gravity"} <= idle
    world._state.forced = frozenset(idle)
    run(world, 60)
    assert len(world._state.forces) == sum(effect.apply is not None for effect in EFFECTS), "their code did run"
    assert world.state_hash() == expected


def test_content_that_changes_while_it_runs_is_seen() -> None:
    world = World(gravity=(0, 0), precision="double")
    world.create_fluid((90, -9), (110, 9), density=1.0, linear_drag=1.0)
    sun = world.create_body(Circle(0.5), position=(0, 50), attraction=9.0)
    first = world.create_body(Circle(0.5), position=(100, 0), velocity=(1, 0), drag=0.1, magnet=1.0)
    world.create_body(Circle(0.5), position=(0, 0), magnet=1.0)
    run(world, 2)
    places = {"drag": (40, 0), "magnet": (1.5, 0), "attraction": (40, -40), "fluid": (100, 3)}
    late = {name: world.create_body(Circle(0.5), position=place, velocity=(1, 0)) for name, place in places.items()}
    late["drag"].drag = 0.5
    late["magnet"].magnet = 1.0
    late["attraction"].attraction = 50.0
    before = sun.velocity
    world.step(DT)
    assert late["drag"].velocity.x < 0.995
    assert late["magnet"].velocity.x > 1.005
    assert late["fluid"].velocity.x < 0.995
    assert sun.velocity.x > before.x, "drawn to the one that came later"
    speed = first.velocity.x
    first.drag = 0.0
    world.fluids[0].destroy()
    world.step(DT)
    assert first.velocity.x == pytest.approx(speed, abs=5e-4), "nothing holds it back any more"


def test_suppressed_code_does_not_run() -> None:
    world = World()
    world.create_fluid((-9, -9), (9, 9), density=2.0)
    body = world.create_body(Circle(0.5), drag=1.0)
    world._state.suppressed = frozenset({"buoyancy", "drag", "gravity"})
    run(world, 3)
    assert tuple(body.velocity) == (0.0, 0.0)
    assert world._state.forces == []
    world._state.suppressed = frozenset()
    world._content_changed()
    world.step(DT)
    assert body.velocity.y > 0.0


def test_every_effect_has_a_name_of_its_own_and_says_what_it_is() -> None:
    names = [effect.name for effect in EFFECTS]
    assert len(set(names)) == len(names) >= 18
    for effect in EFFECTS:
        assert effect.summary
        assert not effect.summary.endswith(".")
        assert effect.needs in ("", *names)
        for item in (*effect.body, *effect.shape):
            assert item.meaning
            assert item.check(item.name, item.default) == item.default
