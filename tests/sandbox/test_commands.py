"""Commands are checked when they are made, come back from JSON, and do what they say."""

from __future__ import annotations

import json
import math
import random
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import SOLVERS, Box
from sandbox import commands as ask
from sandbox import simulation as simulations
from sandbox.commands import PHYSICS, PhysicsCommand, command_from_dict
from sandbox.scenes import SCENES, UnknownScene
from sandbox.simulation import Simulation
from tests.sandbox.watching import bits


def number(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


PLACE = number(-1e5, 1e5)
HAND = st.integers(0, 2**31)
VALID: dict[type[PhysicsCommand], dict[str, st.SearchStrategy]] = {
    ask.SetGravity: {"x": number(-1000, 1000), "y": number(-1000, 1000)},
    ask.SetIterations: {"iterations": st.integers(1, 1000)},
    ask.SetSwitch: {
        "switch": st.sampled_from(["accumulate_impulses", "warm_starting", "position_correction"]),
        "on": st.booleans(),
    },
    ask.SetSolver: {"solver": st.sampled_from(sorted(SOLVERS))},
    ask.Spawn: {
        "shape": st.sampled_from(["box", "circle"]), "x": PLACE, "y": PLACE,
        "width": number(0.05, 20), "height": number(0.05, 20), "mass": number(1e-3, 1e6), "friction": number(0, 10),
        "count": st.integers(1, 200),
    },
    ask.Bomb: {"x": PLACE, "y": PLACE, "angle": number(-1e3, 1e3), "vx": number(-1e3, 1e3), "vy": number(-1e3, 1e3),
               "spin": number(-1e3, 1e3)},
    ask.Grab: {"hand": HAND, "x": PLACE, "y": PLACE},
    ask.MoveHand: {"hand": HAND, "x": PLACE, "y": PLACE},
    ask.Release: {"hand": HAND},
}  # fmt: skip
ANY_COMMAND = st.one_of([st.builds(kind, **fields) for kind, fields in VALID.items()])

NO_NUMBERS: list[Any] = [
    math.nan, math.inf, -math.inf, 1e308, -1e308, 10**400, "1", "", b"1", None, True, False, [1.0], (), {}, 1j,
    np.float32("nan"), np.float64("inf"), np.array([1.0, 2.0]), object(),
]  # fmt: skip
NO_WHOLE_NUMBERS = [*NO_NUMBERS, 1.5, 2.0, -1, 2**31 + 1, 10**5000]
NO_OPTIONS: list[Any] = ["", "Box", "nope", "precision", "gravity", 0, None, True, [], {}, b"box", math.nan, "x" * 9999]
NO_SWITCHES: list[Any] = [0, 1, 1.0, "true", "on", None, [], math.nan]

WRONG_FOR_ALL: dict[str, list[Any]] = {
    "shape": NO_OPTIONS, "switch": NO_OPTIONS, "solver": NO_OPTIONS, "on": NO_SWITCHES,
    "hand": NO_WHOLE_NUMBERS, "iterations": [*NO_WHOLE_NUMBERS, 0, 1001], "count": [*NO_WHOLE_NUMBERS, 0, 201],
}  # fmt: skip
OUT_OF_RANGE: dict[str, list[Any]] = {
    "width": [0.0, -1.0, 0.0499, 20.001], "height": [0.0, -1.0, 0.0499, 20.001], "mass": [0.0, -1.0, 9e-4, 1.1e6],
    "friction": [-1e-9, 10.01], "angle": [-1001.0, 1001.0], "vx": [1001.0], "vy": [-1001.0], "spin": [1001.0],
}  # fmt: skip
FIELDS = [pytest.param(kind, field, id=f"{kind.name}-{field}") for kind, fields in VALID.items() for field in fields]


def bad_values(kind: type[PhysicsCommand], field: str) -> list[Any]:
    if field in WRONG_FOR_ALL:
        return WRONG_FOR_ALL[field]
    coordinate = [1000.1, -1001] if kind is ask.SetGravity else [1.001e5, -1.001e5]
    return [*NO_NUMBERS, *OUT_OF_RANGE.get(field, coordinate)]


GOOD: dict[type[PhysicsCommand], dict[str, Any]] = {
    ask.SetGravity: {"x": 0.0, "y": -3.0},
    ask.SetIterations: {"iterations": 4},
    ask.SetSwitch: {"switch": "warm_starting", "on": False},
    ask.SetSolver: {"solver": "sequential_impulses"},
    ask.Spawn: {"shape": "circle", "x": 1.0, "y": 9.0, "width": 0.5, "height": 1.0, "mass": 2.0, "friction": 0.1,
                "count": 5},
    ask.Bomb: {"x": -3.0, "y": 15.0, "angle": 0.5, "vx": 4.0, "vy": -20.0, "spin": 3.0},
    ask.Grab: {"hand": 1, "x": 0.0, "y": 4.0},
    ask.MoveHand: {"hand": 1, "x": 2.0, "y": 5.0},
    ask.Release: {"hand": 1},
}  # fmt: skip


def test_every_physics_command_is_tested_here() -> None:
    assert {kind.name: kind for kind in VALID} == PHYSICS
    assert {kind.name: kind for kind in GOOD} == PHYSICS


# --- made, and made again from JSON -----------------------------------------------------------------------------------


@given(ANY_COMMAND)
def test_comes_back_from_json(command: PhysicsCommand) -> None:
    again = command_from_dict(json.loads(json.dumps(command.to_dict())))
    assert again == command
    assert type(again) is type(command)
    assert repr(again) == repr(command)  # -0.0 too


@given(st.integers(0, 2**63))
def test_random_bomb_is_box2d_lites(seed: int) -> None:
    bomb = ask.Bomb.random(random.Random(seed))
    assert bomb.y == 15.0
    assert abs(bomb.x) <= 15.0
    assert (bomb.vx, bomb.vy) == (-1.5 * bomb.x, -22.5)
    assert abs(bomb.angle) <= 1.5
    assert abs(bomb.spin) <= 20.0
    assert command_from_dict(bomb.to_dict()) == bomb


@pytest.mark.parametrize(("kind", "field"), FIELDS)
def test_bad_value_is_refused_by_name(kind: type[PhysicsCommand], field: str) -> None:
    for value in bad_values(kind, field):
        with pytest.raises(ValueError, match=rf"^{field} = (.|\n)*: must be ") as refusal:
            kind(**{**GOOD[kind], field: value})
        assert len(str(refusal.value)) < 300
        with pytest.raises(ValueError, match=rf"^{field} = "):
            command_from_dict({"command": kind.name, **GOOD[kind], field: value})


@pytest.mark.parametrize("kind", VALID)
def test_ends_of_the_ranges_are_allowed(kind: type[PhysicsCommand]) -> None:
    ends = {"x": 1e5, "y": -1e5, "width": 0.05, "height": 20.0, "mass": 1e6, "friction": 0.0, "count": 200, "hand": 0}
    if kind is ask.SetGravity:
        ends |= {"x": 1000.0, "y": -1000.0}
    kind(**{field: ends.get(field, value) for field, value in GOOD[kind].items()})


@pytest.mark.parametrize("kind", VALID)
def test_numpy_numbers_become_plain_ones(kind: type[PhysicsCommand]) -> None:
    as_numpy = {float: np.float32, int: np.int64, bool: np.bool_, str: str}
    command = kind(**{field: as_numpy[type(value)](value) for field, value in GOOD[kind].items()})
    json.dumps(command.to_dict())


@pytest.mark.parametrize("kind", VALID)
def test_missing_or_further_arguments_are_refused(kind: type[PhysicsCommand]) -> None:
    whole = kind(**GOOD[kind]).to_dict()
    for field in GOOD[kind]:
        with pytest.raises(ValueError, match="exactly"):
            command_from_dict({name: value for name, value in whole.items() if name != field})
    with pytest.raises(ValueError, match="exactly"):
        command_from_dict({**whole, "name": "x"})
    with pytest.raises(ValueError, match="exactly"):
        command_from_dict({**whole, "extra": 1})


@pytest.mark.parametrize(
    "data", [{}, {"command": None}, {"command": "quit"}, {"command": "pause"}, {"command": ["spawn"]}, {"x": 1.0},
             [], None, "spawn", 5, [["command", "spawn"]]],
)  # fmt: skip
def test_what_is_no_command_is_refused(data: Any) -> None:
    with pytest.raises(ValueError, match=r"^command = "):
        command_from_dict(data)


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(), lambda x: st.lists(x) | st.dictionaries(
    st.sampled_from(["command", "x", "y", "hand", "count", "shape"]) | st.text(), x)))  # fmt: skip
def test_any_json_is_a_command_or_a_value_error(data: Any) -> None:
    with suppress(ValueError):
        command_from_dict(data)


def test_session_commands_are_checked_too() -> None:
    for value in [*NO_NUMBERS, 0.09, 4.1, 0.0, -1.0]:
        with pytest.raises(ValueError, match=r"^speed = "):
            ask.SetSpeed(value)
    assert ask.SetSpeed(4).speed == 4.0
    no_scenes: list[Any] = ["Nope", None, 5, [], {}]
    for name in no_scenes:
        with pytest.raises(UnknownScene):
            ask.LoadScene(name)
    assert ask.LoadScene("dominos").scene == "The Talk/Dominos"


def test_a_command_cannot_be_changed() -> None:
    command = ask.SetIterations(4)
    with pytest.raises(AttributeError):
        command.iterations = 5  # type: ignore[misc]


# --- applied ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def simulation() -> Simulation:
    simulation = Simulation("The Talk/Single Box")
    simulation.step()
    return simulation


def test_settings_are_set(simulation: Simulation) -> None:
    for command in (ask.SetGravity(1.0, 2.5), ask.SetIterations(33), ask.SetSolver("sequential_impulses")):
        simulation.apply(command)
    settings = simulation.world.settings
    assert (settings.gravity, settings.iterations, settings.solver) == ((1.0, 2.5), 33, "sequential_impulses")
    for name in ask.SWITCHES:
        simulation.apply(ask.SetSwitch(name, False))
        assert getattr(simulation.world.settings, name) is False
        simulation.apply(ask.SetSwitch(name, True))
        assert getattr(simulation.world.settings, name) is True


def test_spawns_boxes_side_by_side(simulation: Simulation) -> None:
    content = simulation.content
    simulation.apply(ask.Spawn("box", 2.0, 8.0, 0.5, 0.75, mass=3.0, friction=0.9, count=5))
    spawned = simulation.world.bodies[2:]
    assert [(body.shape.width, body.shape.height, body.mass, body.friction) for body in spawned] == [
        (0.5, 0.75, 3.0, 0.9)
    ] * 5
    assert all(body.kind == "dynamic" for body in spawned)
    assert simulation.content == content + 1
    simulation.step()
    assert not [c for c in simulation.world.contact_records() if c["body1"] >= 2], "they overlap"
    x = [body.position.x for body in spawned]
    assert min(x) == pytest.approx(2.0 - 0.55)
    assert max(x) == pytest.approx(2.0 + 0.55)
    assert min(body.position.y for body in spawned) == pytest.approx(8.0, abs=0.01)


def test_spawns_a_circle_of_that_diameter(simulation: Simulation) -> None:
    simulation.apply(ask.Spawn("circle", 2.0, 8.0, 0.5, 20.0))
    circle = simulation.world.bodies[-1]
    assert circle.shape.radius == 0.25
    assert circle.position == (2.0, 8.0)
    frame = simulation.frame()
    assert frame.shape_kinds[-1] == 1
    assert frame.sizes[-1].tolist() == [0.25, 0.0]


def test_bomb_is_one_body_thrown_again_and_again(simulation: Simulation) -> None:
    simulation.apply(ask.Bomb(-3.0, 15.0, 0.5, 4.0, -20.0, 3.0))
    assert simulation.world.body_count == 3
    bomb = simulation.world.bodies[-1]
    assert (bomb.mass, bomb.shape, bomb.friction) == (50.0, Box(1, 1), float(np.float32(0.2)))
    for _ in range(30):
        simulation.step()
    simulation.apply(ask.Bomb(3.0, 14.0, -0.5, -4.0, -21.0, -3.0))
    assert simulation.world.body_count == 3
    assert (bomb.position, bomb.angle, bomb.velocity, bomb.angular_velocity) == ((3, 14), -0.5, (-4, -21), -3)
    bomb.destroy()
    simulation.apply(ask.Bomb(3.0, 14.0, -0.5, -4.0, -21.0, -3.0))
    assert simulation.world.body_count == 3


def test_hands_take_move_and_let_go(simulation: Simulation) -> None:
    simulation.apply(ask.Grab(7, 0.25, 4.25))
    simulation.apply(ask.MoveHand(7, 5.0, 6.0))
    hand = simulation.hands[7]
    assert hand.serial == 1
    assert (hand.x, hand.y) == (5.0, 6.0)
    simulation.apply(ask.MoveHand(8, 1.0, 1.0))  # there is no such hand
    assert list(simulation.hands) == [7]
    simulation.apply(ask.Grab(7, 50.0, 50.0))  # lets go of what it held, and holds nothing
    assert simulation.hands == {}
    simulation.apply(ask.Grab(7, 0.0, 4.0))
    simulation.apply(ask.Release(7))
    simulation.apply(ask.Release(7))
    assert simulation.hands == {}


@pytest.mark.parametrize("command", [ask.Spawn("box", 0, 9, count=4), ask.Bomb(0, 15, 0, 0, -20, 0)])
def test_no_more_bodies_than_there_is_room_for(
    simulation: Simulation, monkeypatch: pytest.MonkeyPatch, command: PhysicsCommand
) -> None:
    monkeypatch.setattr(simulations, "MOST_BODIES", 2)
    before = bits(simulation), simulation.content
    with pytest.raises(ValueError, match="count = "):
        simulation.apply(command)
    assert (bits(simulation), simulation.content) == before


@given(ANY_COMMAND)
def test_whatever_is_allowed_can_be_applied_and_stepped(command: PhysicsCommand) -> None:
    simulation = Simulation(SCENES["The Talk/Single Box"])
    simulation.apply(ask.Grab(1, 0.0, 4.0))
    simulation.apply(command)
    for _ in range(3):
        simulation.step()
    assert np.isfinite(simulation.world.positions).all()
