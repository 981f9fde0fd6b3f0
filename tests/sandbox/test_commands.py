"""Commands are checked when they are made, come back from JSON, and do what they say."""

from __future__ import annotations

import json
import math
import random
from contextlib import nullcontext, suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import SHAPE_KINDS, Box, Circle
from engine.settings import SettingInfo
from sandbox import commands as ask
from sandbox import simulation as simulations
from sandbox.commands import PHYSICS, PhysicsCommand, command_from_dict
from sandbox.commands.settings import CHANGEABLE
from sandbox.scenes import SCENES, UnknownScene
from sandbox.simulation import Simulation
from tests.sandbox.watching import bits


def number(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


PLACE = number(-1e5, 1e5)
HAND = st.integers(0, 2**31)
SIZE = number(0.05, 20)
BODY = st.integers(-1, 2)


def setting_value(info: SettingInfo) -> st.SearchStrategy[Any]:
    """Anything that this setting may be set to."""
    if info.kind == "vector":
        return st.tuples(number(-1000, 1000), number(-1000, 1000))
    if info.kind == "whole":
        return st.none() | st.integers(1, 1000)
    if info.kind == "number":
        return number(max(info.low, 1e-3) if info.low > 0.0 else 0.0, 1000)
    return st.booleans() if info.kind == "switch" else st.sampled_from(info.choices)


SETTINGS = st.sampled_from(list(CHANGEABLE.values()))
ANY_SETTING = SETTINGS.flatmap(lambda info: st.builds(ask.Set, st.just(info.name), setting_value(info)))
SEVERAL = st.lists(SETTINGS, min_size=1, max_size=4, unique_by=lambda info: info.name).flatmap(
    lambda infos: st.fixed_dictionaries({info.name: setting_value(info) for info in infos}).map(ask.SetAll)
)
VALID: dict[type[PhysicsCommand], dict[str, st.SearchStrategy]] = {
    ask.Spawn: {
        "shape": st.sampled_from(["box", "circle", "capsule", "polygon", "segment", "chain"]), "x": PLACE, "y": PLACE,
        "width": SIZE, "height": SIZE, "mass": number(1e-3, 1e6), "friction": number(0, 10),
        "count": st.integers(1, 200), "kind": st.just("static"), "angle": number(-1e3, 1e3),
        "restitution": number(0, 1), "rolling_resistance": number(0, 1), "corners": st.integers(3, 8),
        "rounding": number(0, 20),
    },
    ask.Bomb: {"x": PLACE, "y": PLACE, "angle": number(-1e3, 1e3), "vx": number(-1e3, 1e3), "vy": number(-1e3, 1e3),
               "spin": number(-1e3, 1e3)},
    ask.Grab: {"hand": HAND, "x": PLACE, "y": PLACE},
    ask.MoveHand: {"hand": HAND, "x": PLACE, "y": PLACE},
    ask.Release: {"hand": HAND},
    ask.DriveMotor: {"joint": HAND, "speed": number(-1e3, 1e3)},
    ask.Join: {
        "kind": st.sampled_from(sorted({*ask.JOINS} - {"filter"})), "body1": BODY, "x1": PLACE, "y1": PLACE,
        "body2": st.integers(0, 2), "x2": PLACE, "y2": PLACE, "hertz": number(0, 240), "damping_ratio": number(0, 10),
        "limited": st.booleans(), "lower": number(-1e5, 0), "upper": number(0, 1e5), "speed": number(-1e3, 1e3),
        "strength": number(0, 1e9), "break_force": number(0, 1e9), "collide": st.booleans(),
    },
    ask.Unjoin: {"body": HAND},
}  # fmt: skip
SOLID_SPAWN = VALID[ask.Spawn] | {
    "shape": st.sampled_from(["box", "circle", "capsule", "polygon"]),
    "kind": st.sampled_from(["static", "dynamic"]),
}
ANY_COMMAND = st.one_of(
    ANY_SETTING,
    SEVERAL,
    st.builds(ask.Spawn, **SOLID_SPAWN),
    *(st.builds(kind, **fields) for kind, fields in VALID.items()),
)

NO_NUMBERS: list[Any] = [
    math.nan, math.inf, -math.inf, 1e308, -1e308, 10**400, "1", "", b"1", None, True, False, [1.0], (), {}, 1j,
    np.float32("nan"), np.float64("inf"), np.array([1.0, 2.0]), object(),
]  # fmt: skip
NO_WHOLE_NUMBERS = [*NO_NUMBERS, 1.5, 2.0, -1, 2**31 + 1, 10**5000]
NO_OPTIONS: list[Any] = ["", "Box", "nope", "precision", "gravity", 0, None, True, [], {}, b"box", math.nan, "x" * 9999]
NO_SWITCHES: list[Any] = [0, 1, 1.0, "true", "on", None, [], math.nan]

WRONG_FOR_ALL: dict[str, list[Any]] = {
    "shape": NO_OPTIONS, "kind": [*NO_OPTIONS, "kinematic"], "hand": NO_WHOLE_NUMBERS, "joint": NO_WHOLE_NUMBERS,
    "count": [*NO_WHOLE_NUMBERS, 0, 201], "corners": [*NO_WHOLE_NUMBERS, 2, 9], "body": NO_WHOLE_NUMBERS,
    "body1": [*NO_NUMBERS, 1.5, 2.0, -2, 2**31 + 1], "body2": [*NO_NUMBERS, 1.5, 2.0, -2, 2**31 + 1],
    "limited": NO_SWITCHES, "collide": NO_SWITCHES,
}  # fmt: skip
OUT_OF_RANGE: dict[str, list[Any]] = {
    "width": [0.0, -1.0, 0.0499, 20.001], "height": [0.0, -1.0, 0.0499, 20.001], "mass": [0.0, -1.0, 9e-4, 1.1e6],
    "friction": [-1e-9, 10.01], "angle": [-1001.0, 1001.0], "vx": [1001.0], "vy": [-1001.0], "spin": [1001.0],
    "speed": [-1001.0, 1001.0], "restitution": [-1e-9, 1.01], "rolling_resistance": [-1e-9, 1.01],
    "rounding": [-1e-9, 20.1], "hertz": [-1e-9, 240.1], "damping_ratio": [-1e-9, 10.1], "strength": [-1e-9, 1.1e9],
    "break_force": [-1e-9, 1.1e9], "lower": [-1.001e5, 0.6],
}  # fmt: skip
FIELDS = [pytest.param(kind, field, id=f"{kind.name}-{field}") for kind, fields in VALID.items() for field in fields]


def bad_values(kind: type[PhysicsCommand], field: str) -> list[Any]:
    if field in WRONG_FOR_ALL:
        return WRONG_FOR_ALL[field]
    return [*NO_NUMBERS, *OUT_OF_RANGE.get(field, [1.001e5, -1.001e5])]


GOOD: dict[type[PhysicsCommand], dict[str, Any]] = {
    ask.Spawn: {"shape": "polygon", "x": 1.0, "y": 9.0, "width": 0.5, "height": 1.0, "mass": 2.0, "friction": 0.1,
                "count": 5, "kind": "dynamic", "angle": 0.5, "restitution": 0.5, "rolling_resistance": 0.1,
                "corners": 6, "rounding": 0.1},
    ask.Bomb: {"x": -3.0, "y": 15.0, "angle": 0.5, "vx": 4.0, "vy": -20.0, "spin": 3.0},
    ask.Grab: {"hand": 1, "x": 0.0, "y": 4.0},
    ask.MoveHand: {"hand": 1, "x": 2.0, "y": 5.0},
    ask.Release: {"hand": 1},
    ask.DriveMotor: {"joint": 1, "speed": -4.5},
    ask.Join: {"kind": "revolute", "body1": 1, "x1": 0.25, "y1": -0.5, "body2": -1, "x2": 1.0, "y2": 4.0, "hertz": 2.0,
               "damping_ratio": 0.5, "limited": True, "lower": -0.5, "upper": 0.5, "speed": 2.0, "strength": 50.0,
               "break_force": 900.0, "collide": True},
    ask.Unjoin: {"body": 1},
}  # fmt: skip


def test_every_physics_command_is_tested_here() -> None:
    assert {kind.name: kind for kind in (ask.Set, ask.SetAll, *VALID)} == PHYSICS
    assert {kind.name: kind for kind in (ask.Set, ask.SetAll, *GOOD)} == PHYSICS


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


WRONG_SETTINGS: dict[str, list[Any]] = {
    "gravity": [*NO_NUMBERS[:-2], (1.0,), (1.0, math.nan), (1000.1, 0.0), [0.0, -1001.0]], "wind": [(0.0, 1e9)],
    "solver": NO_OPTIONS, "stiffness": NO_OPTIONS, "friction_mixing": NO_OPTIONS,
    "iterations": [value for value in (*NO_WHOLE_NUMBERS, 0, 1001) if value is not None], "substeps": [0, 1001, 2.5],
    "contact_hertz": [*NO_NUMBERS, 0.0, -1.0, 1001.0], "push_out_speed": [-1e-9, 1000.1],
    "warm_starting": NO_SWITCHES, "recycling": NO_SWITCHES,
}  # fmt: skip


@pytest.mark.parametrize("setting", WRONG_SETTINGS)
def test_a_bad_value_of_a_setting_is_refused_by_its_name(setting: str) -> None:
    for value in WRONG_SETTINGS[setting]:
        with pytest.raises(ValueError, match=rf"^{setting} = (.|\n)*: must be ") as refusal:
            ask.Set(setting, value)
        assert len(str(refusal.value)) < 300
        with pytest.raises(ValueError, match=rf"^{setting} = "):
            ask.SetAll({"sleeping": False, setting: value})


@pytest.mark.parametrize("setting", ["precision", "name", "gravity_x", "", None, 3, [], True])
def test_what_is_no_setting_is_refused(setting: Any) -> None:
    with pytest.raises(ValueError, match=r"^setting = "):
        ask.Set(setting, "single")


@pytest.mark.parametrize("settings", [{}, [], None, "solver", 3, [("solver", "avbd")], {"precision": "double"}, {1: 2}])
def test_several_settings_are_a_mapping(settings: Any) -> None:
    with pytest.raises(ValueError, match=r"^settings? = "):
        ask.SetAll(settings)
    with pytest.raises(ValueError, match=r"^settings? = "):
        command_from_dict({"command": "set_all", "settings": settings})


@pytest.mark.parametrize(
    ("older", "today"),
    [
        ({"command": "set_gravity", "x": 1.0, "y": -3.0}, ask.Set("gravity", (1.0, -3.0))),
        ({"command": "set_iterations", "iterations": 7}, ask.Set("iterations", 7)),
        ({"command": "set_switch", "switch": "warm_starting", "on": False}, ask.Set("warm_starting", False)),
        ({"command": "set_solver", "solver": "soft_step"}, ask.Set("solver", "soft_step")),
        ({"command": "spawn", "shape": "circle", "x": 1.0, "y": 2.0, "width": 0.5, "height": 1.0, "mass": 3.0,
          "friction": 0.1, "count": 2}, ask.Spawn("circle", 1.0, 2.0, 0.5, 1.0, 3.0, 0.1, 2)),
    ],
)  # fmt: skip
def test_commands_of_older_recordings_are_understood(older: dict[str, Any], today: PhysicsCommand) -> None:
    assert command_from_dict(older) == today
    with pytest.raises(ValueError, match=r"exactly|must be"):
        command_from_dict({**older, "extra": 1})


@pytest.mark.parametrize("kind", VALID)
def test_ends_of_the_ranges_are_allowed(kind: type[PhysicsCommand]) -> None:
    ends = {
        "x": 1e5,
        "y": -1e5,
        "width": 0.05,
        "height": 20.0,
        "mass": 1e6,
        "friction": 0.0,
        "count": 200,
        "hand": 0,
        "joint": 0,
        "speed": 1e3,
    }
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
    command = ask.Release(4)
    with pytest.raises(AttributeError):
        command.hand = 5  # type: ignore[misc]


# --- applied ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def simulation() -> Simulation:
    simulation = Simulation("The Talk/Single Box")
    simulation.step()
    return simulation


def test_settings_are_set(simulation: Simulation) -> None:
    for command in (ask.Set("gravity", (1.0, 2.5)), ask.Set("substeps", 6), ask.Set("stiffness", "fixed")):
        simulation.apply(command)
    settings = simulation.world.settings
    assert (settings.gravity, settings.substeps, settings.stiffness) == ((1.0, 2.5), 6, "fixed")
    simulation.apply(ask.Set("solver", "sequential_impulses"))
    simulation.apply(ask.Set("iterations", 33))
    assert (simulation.world.solver, simulation.world.iterations) == ("sequential_impulses", 33)
    simulation.apply(ask.Set("iterations", None))
    assert simulation.world.iterations == 10, "the solver's own"
    with pytest.raises(ValueError, match=r"^substeps = 4: must be 1 where the solver is"):
        simulation.apply(ask.Set("substeps", 4))
    for name in ("warm_starting", "recycling"):
        for value in (False, True):
            simulation.apply(ask.Set(name, value))
            assert getattr(simulation.world.settings, name) is value


def test_several_settings_are_set_all_or_none(simulation: Simulation) -> None:
    simulation.apply(ask.SetAll({"solver": "sequential_impulses", "iterations": 33, "gravity": [1, 2]}))
    settings = simulation.world.settings
    assert (settings.solver, settings.iterations, settings.gravity) == ("sequential_impulses", 33, (1.0, 2.0))
    bouncing = Simulation("Effects/Restitution")
    before = bouncing.world.settings
    with pytest.raises(ValueError, match="restitution"):
        bouncing.apply(ask.SetAll({"iterations": 50, "solver": "avbd"}))
    assert bouncing.world.settings == before


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
    assert circle.shape == Circle(0.25)
    assert circle.position == (2.0, 8.0)
    frame = simulation.frame()
    assert frame.shape_kinds[-1] == 1
    assert frame.sizes[-1].tolist() == [0.25, 0.0]


def test_spawns_a_polygon_as_round_and_as_turned_as_asked(simulation: Simulation) -> None:
    simulation.apply(ask.Spawn("polygon", 0.0, 8.0, 2.0, 1.0, angle=0.5, corners=6, rounding=0.1))
    body = simulation.world.bodies[-1]
    assert (len(body.shape.points), body.shape.radius, body.angle) == (6, 0.1, 0.5)
    assert body.shape.extent == pytest.approx((2.0, 1.0))
    simulation.apply(ask.Spawn("polygon", 4.0, 8.0, 2.0, 1.0, rounding=20.0))
    assert simulation.world.bodies[-1].shape.extent == pytest.approx((2.0, 1.0)), "never larger than asked"


@pytest.mark.parametrize("shape", ["segment", "chain"])
def test_lines_are_static(simulation: Simulation, shape: str) -> None:
    with pytest.raises(ValueError, match=f"kind = 'dynamic': must be 'static' for a {shape}"):
        ask.Spawn(shape, 0.0, 8.0)
    simulation.apply(ask.Spawn(shape, 0.0, 8.0, 3.0, 1.0, kind="static", friction=0.7, count=2))
    assert [body.kind for body in simulation.world.bodies[2:]] == ["static"] * 2
    assert simulation.world.bodies[-1].shapes[0].friction == 0.7


def test_what_is_spawned_has_its_material_and_no_column_where_it_is_the_usual(simulation: Simulation) -> None:
    simulation.apply(ask.Spawn("box", 2.0, 8.0))
    assert {"restitution", "rolling resistance"}.isdisjoint(called_for(simulation))
    simulation.apply(ask.Spawn("capsule", 2.0, 9.0, restitution=0.5, rolling_resistance=0.1))
    shape = simulation.world.bodies[-1].shapes[0]
    assert (shape.restitution, shape.rolling_resistance) == (0.5, 0.1)
    assert {"restitution", "rolling resistance"} <= called_for(simulation)


def called_for(simulation: Simulation) -> set[str]:
    return {effect.name for effect in simulation.world.effects if effect.called_for}


@pytest.mark.parametrize("shape", SHAPE_KINDS)
@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_spawned_side_by_side_nothing_overlaps(simulation: Simulation, shape: str, angle: float) -> None:
    kind = "static" if shape in ask.LINES else "dynamic"
    simulation.apply(ask.Spawn(shape, 0.0, 9.0, 1.5, 0.5, angle=angle, kind=kind, count=12))
    simulation.apply(ask.Set("broad_phase", "all_pairs"))
    simulation.step()
    touching = simulation.world.contact_records()
    assert not [contact for contact in touching if contact["body1"] >= 2 and contact["separation"] < 0.0]


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


def test_motors_are_driven_and_nothing_else() -> None:
    simulation = Simulation("Joints/Car")
    (drive,) = simulation.scene.drives
    assert simulation.frame().drives == (1.0,)
    for joint in drive.joints:
        simulation.apply(ask.DriveMotor(joint, -0.5 * drive.gain))
    assert [joint.motor_speed for joint in simulation.world.joints] == [-0.5 * drive.gain] * 2
    assert simulation.frame().drives == (-0.5,)
    before = bits(simulation)
    simulation.apply(ask.DriveMotor(99, 1.0))  # there is no such joint
    assert bits(simulation) == before
    pendulum = Simulation("The Talk/Simple Pendulum")
    pendulum.apply(ask.DriveMotor(0, 1.0))
    (joint,) = pendulum.world.joints
    assert joint.motor_speed is None, "it has no motor, and gets none"
    assert pendulum.frame().drives == ()


def test_a_motor_that_is_driven_back_takes_the_car_back() -> None:
    simulation = Simulation("Joints/Car")
    start = simulation.world.positions[1, 0]
    for joint in (0, 1):
        simulation.apply(ask.DriveMotor(joint, 20.0))
    for _ in range(90):
        simulation.step()
    assert simulation.world.positions[1, 0] < start - 0.5


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
    with suppress(ValueError) if isinstance(command, ask.Join | ask.SetAll) else nullcontext():  # not together
        simulation.apply(command)
    for _ in range(3):
        simulation.step()
    assert np.isfinite(simulation.world.positions).all()
