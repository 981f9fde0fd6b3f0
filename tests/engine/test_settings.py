"""Settings: there and back, as JSON and as properties of a world; each of them reaches the step."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError, fields
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import SOLVERS, Box, Circle, Settings, World
from engine.settings import SettingInfo, describe
from tests.engine.worlds import DT, busy, floor, run

CHANGES: dict[str, Any] = {
    "gravity": (1.5, -3.0),
    "solver": "sequential_impulses",
    "substeps": 3,
    "iterations": 17,
    "broad_phase": "all_pairs",
    "stiffness": "fixed",
    "contact_hertz": 15.0,
    "contact_damping_ratio": 2.5,
    "push_out_speed": 0.5,
    "joint_hertz": 11.0,
    "joint_damping_ratio": 0.5,
    "joint_solving": "direct",
    "restitution_threshold": 0.25,
    "speculative_distance": 0.0,
    "recycling": False,
    "recycling_distance": 0.001,
    "continuous": False,
    "maximum_speed": 30.0,
    "sleeping": False,
    "sleep_speed": 0.125,
    "sleep_time": 2.0,
    "friction_mixing": "product",
    "restitution_mixing": "mean",
    "wind": (8.0, 1.0),
    "accumulate_impulses": False,
    "warm_starting": False,
    "position_correction": False,
    "tell_events": True,
    "hit_speed": 0.25,
}
INFOS = {info.name: info for info in describe()}


def values_of(info: SettingInfo) -> st.SearchStrategy[Any]:
    """What a setting may be."""
    if info.kind == "vector":
        return st.tuples(st.floats(-100, 100), st.floats(-100, 100))
    if info.kind == "choice":
        return st.sampled_from(info.choices)
    if info.kind == "switch":
        return st.booleans()
    if info.kind == "whole":
        return st.none() | st.integers(1, 1000)
    return st.floats(max(info.low, 1e-3), 10 * info.high)


@given(values=st.fixed_dictionaries({}, optional={name: values_of(info) for name, info in INFOS.items()}))
def test_there_and_back_through_json(values: dict[str, Any]) -> None:
    if values.get("solver", "soft_step") != "soft_step":
        values.pop("substeps", None)  # it has none
    settings = Settings(**values)
    assert Settings.from_dict(json.loads(json.dumps(settings.to_dict()))) == settings
    for name, value in values.items():
        if value is not None:
            assert getattr(settings, name) == value
    assert World(**settings.to_dict()).settings == settings


def test_unknown_name_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^setting = 'color': must be one of 'gravity'"):
        Settings.from_dict({"color": 1})
    with pytest.raises(ValueError, match=r"^setting = 'itrations': must be one of 'gravity'"):
        World(itrations=3)


def test_immutable_and_normalised() -> None:
    settings = Settings(gravity=[0, -3], contact_hertz=30)  # type: ignore[arg-type]
    assert settings.gravity == (0.0, -3.0)
    assert type(settings.gravity) is tuple
    assert type(settings.contact_hertz) is float
    with pytest.raises(FrozenInstanceError):
        settings.iterations = 3  # type: ignore[misc]


def test_every_setting_is_a_property_of_the_world() -> None:
    assert {*CHANGES, "precision"} == {field.name for field in fields(Settings)} == set(INFOS)
    world = World(precision="double")
    for name, value in CHANGES.items():
        if name not in ("solver", "substeps", "iterations"):
            assert getattr(world, name) == getattr(Settings(), name) != value
            setattr(world, name, value)
            assert getattr(world, name) == getattr(world.settings, name) == value
    world.substeps, world.iterations = 3, 17
    together = {name: value for name, value in CHANGES.items() if name != "solver"}
    other = World(precision="double")
    other.set(**together)
    assert other.settings == world.settings
    assert other.settings == World(precision="double", **together).settings
    with pytest.raises(ValueError, match="precision = 'single'"):
        world.precision = "single"
    world.precision = "double"


def test_what_there_is_to_say_of_each() -> None:
    # the page and the command line ask nothing else
    for name, info in INFOS.items():
        default = getattr(Settings(), name)
        assert info.hint
        assert info.check(default) == default
        assert set(info.solvers) <= set(SOLVERS)
        if info.kind == "choice":
            assert default in info.choices
            assert all(info.check(choice) == choice for choice in info.choices)
        elif info.kind in ("number", "whole"):
            assert info.low <= default <= info.high
            assert info.check(info.low) == info.low
            assert info.check(info.high) == info.high
            assert info.step > 0


def test_each_solver_brings_its_own_numbers() -> None:
    world = World(substeps=9, iterations=3)
    world.solver = "sequential_impulses"
    assert (world.substeps, world.iterations) == (1, 10)
    world.iterations = 25
    world.set(solver="sequential_impulses", warm_starting=False)
    assert world.iterations == 25, "the same solver keeps what was set"
    world.set(solver="soft_step", substeps=2)
    assert (world.substeps, world.iterations) == (2, 1)
    with pytest.raises(ValueError, match=r"^substeps = 2: must be 1 where the solver is 'sequential_impulses'"):
        world.set(solver="sequential_impulses", substeps=2)
    assert (world.solver, world.substeps) == ("soft_step", 2)
    with pytest.raises(ValueError, match=r"^substeps = 4: must be 1 where"):
        World(solver="sequential_impulses", substeps=4)


def demanding(solver: str, **settings: Any) -> World:
    """A world in which every setting of that solver has something to do."""
    world = busy("double", solver=solver, **settings)
    world.create_body(Box(1, 1), position=(4, 0.3))  # in the floor
    world.create_body(Circle(0.4), position=(-4, 2), friction=0.7, drag=0.3)
    if "restitution" not in SOLVERS[solver].lacks:
        world.create_body(Circle(0.4), position=(8, 0.6), restitution=0.6, friction=0.8)
        world.create_body(Circle(0.4), position=(9, 0.4), restitution=0.2, velocity=(-2, 0))
    if "continuous collision" not in SOLVERS[solver].lacks and solver != "sequential_impulses":
        world.create_body(Box(0.01, 2), position=(12, 6), kind="static")
        world.create_body(Circle(0.1), position=(6, 6), velocity=(600, 0))
    for k in range(3):
        world.create_body(Box(1, 1), position=(-8 + 0.02 * k, 0.505 + 1.005 * k))
    return world


MORE: dict[str, dict[str, Any]] = {  # what else it takes to matter: with 4 substeps in 1/60 s "fixed" is what follows
    "stiffness": {"substeps": 8},
    "contact_hertz": {"stiffness": "fixed"},
    "joint_hertz": {"stiffness": "fixed"},
}


TELLING = ("tell_events", "hit_speed")  # what happened, and change nothing


@pytest.mark.parametrize("solver", SOLVERS)
def test_every_setting_reaches_the_step(solver: str) -> None:
    # each of them changes what such a world does, if it says that it matters to the solver; and else nothing. Chains
    # are not in it: tests/engine/joints/test_chains.py
    plain = run(demanding(solver), 40).state_hash()
    for name, value in CHANGES.items():
        if name in ("solver", "broad_phase", "joint_solving") or (
            (name == "substeps" and not SOLVERS[solver].has_substeps)
            or (name.startswith("sleep") and solver in ("xpbd", "avbd"))
        ):
            continue
        info = INFOS[name]
        more = MORE.get(name, {}) if solver == "soft_step" else {}
        before = run(demanding(solver, **more), 40).state_hash() if more else plain
        changed = run(demanding(solver, **{name: value, **more}), 40).state_hash()
        matters = name not in TELLING and (not info.solvers or solver in info.solvers)
        assert (changed != before) == matters, name


def test_a_setting_may_change_while_the_world_runs() -> None:
    for name, value in CHANGES.items():
        if name == "solver":
            continue
        world, other = demanding("soft_step"), demanding("soft_step")
        run(world, 10)
        run(other, 10)
        world.set(**{name: value})
        taken = World(precision="double")
        taken.restore(world.snapshot())
        assert getattr(taken, name) == value
        run(world, 10)
        run(taken, 10)
        assert taken.state_hash() == world.state_hash(), name
        world.set(**{name: getattr(Settings(), name)})
        assert world.settings == other.settings


def test_the_solver_may_change_while_the_world_runs() -> None:
    world = busy("single")
    for step in range(120):
        world.step(DT)
        if step % 20 == 10:
            world.solver = "sequential_impulses" if world.solver == "soft_step" else "soft_step"
    assert world.positions[:, 1].min() > -1.01
    assert abs(world.velocities).max() < 5
    floor_contacts = world.contact_records()
    assert floor_contacts["separation"].min() > -0.03


def test_what_a_solver_lacks_is_refused_by_name() -> None:
    world = World()
    floor(world)
    ball = world.create_body(Circle(0.5), position=(0, 3), restitution=0.5)
    before = world.settings
    with pytest.raises(
        ValueError,
        match=r"^solver = 'sequential_impulses': must be one that knows restitution: 1 of 2 shapes has restitution$",
    ):
        world.set(iterations=3, solver="sequential_impulses")
    assert world.settings is before
    ball.shapes[0].restitution = 0.0
    world.solver = "sequential_impulses"
    with pytest.raises(ValueError, match=r"^restitution = 0.25: must be 0.0 with the solver 'sequential_impulses'$"):
        ball.shapes[0].restitution = 0.25
    with pytest.raises(ValueError, match=r"^tangent_speed = 1.0: must be 0.0 with the solver"):
        world.create_body(Box(1, 1), tangent_speed=1)
    ball.shapes[0].restitution = 0
    ball.linear_damping = 0.3
    run(world, 3)
