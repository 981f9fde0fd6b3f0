"""What no joint takes: each argument of each kind, when it is made and when it is set. Nothing of the world changes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from engine import SOLVERS, Box, World
from tests.engine.joints.making import MAKERS, two_free
from tests.engine.test_validate import NO_NUMBERS, NO_SWITCHES, NO_VECTORS
from tests.engine.worlds import fingerprint

HUGE = [1e39, -1e39]  # no float32
NUMBER = [*NO_NUMBERS[:6], *NO_NUMBERS[9:11], 10**400, *HUGE]
NON_NEGATIVE = [*NUMBER, -1, -1e-300]
POSITIVE = [*NON_NEGATIVE, 0, 0.0]
NONE = [None]
FAR = [(2e9, 0.0), (0.0, -2e9), (1e300, 0.0)]  # farther than an arm may reach
VECTOR = [*NO_VECTORS[:14], *FAR]
LIMIT = [*NUMBER, 2e9, -2e9]

EVERY = {"break_force": NON_NEGATIVE, "break_torque": NON_NEGATIVE, "collide_connected": NO_SWITCHES}
ANCHOR = {"anchor": VECTOR}
AXIS = {"axis": [*NO_VECTORS[:14], (0, 0), (0.0, -0.0), (1e-310, 0)]}
LENGTHS = {"lower": [*LIMIT, -1e-3], "upper": [*LIMIT, -1e-3]}
LIMITS = {"lower": LIMIT, "upper": LIMIT}
SPRING = {"hertz": POSITIVE, "damping_ratio": [*NON_NEGATIVE, 2e6, None]}
TARGET = {"target": [*NUMBER, 2e9, None]}
TURNER = {"motor_speed": NUMBER, "max_motor_torque": [*NON_NEGATIVE, None]}
SLIDER = {"motor_speed": NUMBER, "max_motor_force": [*NON_NEGATIVE, None]}
HELD = {
    f"{part}_{name}": values for part in ("linear", "angular") for name, values in SPRING.items()
}  # fmt: skip

REFUSED: dict[str, dict[str, list]] = {
    "revolute": {
        **ANCHOR, **LIMITS, **SPRING, **TARGET, **TURNER, **EVERY, "softness": [*NON_NEGATIVE, None],
        "bias_factor": [*NUMBER, -0.1, 1.1],
    },
    "distance": {
        "anchor1": VECTOR, "anchor2": VECTOR, "length": [*NON_NEGATIVE, 2e9], **LENGTHS, **SPRING, **SLIDER, **EVERY,
    },
    "prismatic": {**ANCHOR, **AXIS, **LIMITS, **SPRING, **TARGET, **SLIDER, **EVERY},
    "weld": {**ANCHOR, **HELD, **EVERY},
    "wheel": {**ANCHOR, **AXIS, **LIMITS, **SPRING, **TARGET, **TURNER, **EVERY},
    "motor": {
        "offset": VECTOR[1:], "angle": [*NUMBER, 2e9], "max_force": NON_NEGATIVE, "max_torque": NON_NEGATIVE, **HELD,
        **EVERY,
    },
    "mouse": {"target": VECTOR, "anchor": VECTOR[1:], **SPRING, "max_force": NON_NEGATIVE, **EVERY},
    "filter": {},
}  # fmt: skip
"""What each argument of each kind does not take; None only where it has no meaning."""

ONCE = ("anchor", "anchor1", "anchor2", "axis", "collide_connected")  # and never changed afterwards
ARGUMENTS = [(kind, name) for kind, names in REFUSED.items() for name in names]
SET = [(kind, name) for kind, name in ARGUMENTS if name not in ONCE]

every_kind = pytest.mark.parametrize("kind", MAKERS)


def make_world() -> tuple[World, Any, Any]:
    world = World()  # single precision, whose range is the smaller one
    return world, *two_free(world)


def unchanged(world: World, call: Callable[[], object], match: str) -> None:
    before, joints = fingerprint(world), world.joint_count
    with pytest.raises(ValueError, match=match) as raised:
        call()
    assert "must be" in str(raised.value)
    assert fingerprint(world) == before
    assert world.joint_count == joints


@pytest.mark.parametrize(("kind", "name"), ARGUMENTS)
def test_an_argument_is_refused(kind: str, name: str) -> None:
    world, a, b = make_world()
    for value in REFUSED[kind][name]:
        unchanged(world, lambda value=value: MAKERS[kind](world, a, b, **{name: value}), f"^{name} = .*must be")


@pytest.mark.parametrize(("kind", "name"), SET)
def test_a_property_is_refused(kind: str, name: str) -> None:
    world, a, b = make_world()
    joint = MAKERS[kind](world, a, b)
    world.step(1 / 60) if kind == "filter" else None
    kept = getattr(joint, name)
    values = REFUSED[kind][name] + ([None] if name in ("length", "offset", "angle") else [])
    for value in values:
        unchanged(world, lambda value=value: setattr(joint, name, value), f"^{name} = .*must be")
    assert getattr(joint, name) == kept


@every_kind
def test_bodies_are_refused(kind: str) -> None:
    world, a, b = make_world()
    other = World().create_body(Box(1, 1))
    gone = world.create_body(Box(1, 1))
    gone.destroy()
    static, kinematic = (world.create_body(Box(1, 1), kind=which) for which in ("static", "kinematic"))
    more = {
        "distance": {"anchor1": (0, 0), "anchor2": (1, 0)}, "prismatic": {"anchor": (0, 0), "axis": (1, 0)},
        "wheel": {"anchor": (0, 0), "axis": (1, 0)}, "mouse": {"target": (0, 0)}, "motor": {}, "filter": {},
    }.get(kind, {"anchor": (0, 0)})  # fmt: skip
    make = getattr(world, f"create_joint_{kind}")
    cases = [
        (a, a, "body2 = .*another body than body1"), (a, other, "body2 = .*of this world, not of another"),
        (other, b, "body1 = .*of this world, not of another"), (gone, b, "body1 = .*this one was destroyed"),
        (a, gone, "body2 = .*this one was destroyed"), (None, b, "body1 = None"), (a, "b", "body2 = 'b'"),
        (static, kinematic, "body2 = .*dynamic where body1 is static"), (kinematic, static, "body2 = .*kinematic"),
    ]  # fmt: skip
    for first, second, message in cases:
        unchanged(world, lambda first=first, second=second: make(first, second, **more), message)


@pytest.mark.parametrize("kind", ["revolute", "distance", "prismatic", "wheel"])
def test_a_lower_limit_above_the_upper_one(kind: str) -> None:
    world, a, b = make_world()
    unchanged(world, lambda: MAKERS[kind](world, a, b, lower=0.5, upper=0.4), "^lower = 0.5: must be at most upper")
    joint = MAKERS[kind](world, a, b, lower=0.1, upper=0.4)
    unchanged(world, lambda: setattr(joint, "lower", 0.5), "at most upper, which is 0.4")
    unchanged(world, lambda: setattr(joint, "upper", 0.05), "upper = 0.05: must be at least lower")
    assert (joint.lower, joint.upper) == (pytest.approx(0.1), pytest.approx(0.4))


@every_kind
def test_the_talks_solver_refuses_what_it_lacks(kind: str) -> None:
    world = World(solver="sequential_impulses")
    a, b = two_free(world)
    if kind in ("revolute", "filter"):
        MAKERS[kind](world, a, b)
    else:
        unchanged(world, lambda: MAKERS[kind](world, a, b), "solver = 'sequential_impulses'.*knows " + kind)
    soft = World()
    MAKERS[kind](soft, *two_free(soft))
    if kind not in ("revolute", "filter"):
        unchanged(soft, lambda: soft.set(solver="sequential_impulses"), "solver = 'sequential_impulses'")


@pytest.mark.parametrize(("name", "value"), [("hertz", 2.0), ("lower", -1.0), ("upper", 1.0)])
def test_the_talks_solver_has_neither_springs_nor_limits(name: str, value: float) -> None:
    world = World(solver="sequential_impulses")
    a, b = two_free(world)
    unchanged(world, lambda: MAKERS["revolute"](world, a, b, **{name: value}), "None with the solver")
    joint = MAKERS["revolute"](world, a, b)
    unchanged(world, lambda: setattr(joint, name, value), "None with the solver")
    soft = World()
    MAKERS["revolute"](soft, *two_free(soft), **{name: value})
    unchanged(soft, lambda: soft.set(solver="sequential_impulses"), "solver = 'sequential_impulses'")


@pytest.mark.parametrize(("kind", "name"), ARGUMENTS)
def test_what_is_given_is_what_is_told(kind: str, name: str) -> None:
    world, a, b = make_world()
    given = {
        "collide_connected": False, "lower": 0.25, "upper": 0.75, "bias_factor": 0.5, "motor_speed": -1.5,
        "offset": (0.5, -0.25), "angle": -0.75, "target": -0.5,
    }.get(name, 0.625)  # fmt: skip
    if name in ("anchor", "anchor1", "anchor2", "axis") or (kind, name) == ("mouse", "target"):
        return
    joint = MAKERS[kind](world, a, b, **{name: given})
    told = getattr(joint, name)
    assert (tuple(told) if name == "offset" else told) == given
    if name != "collide_connected":
        setattr(joint, name, given)
        assert getattr(joint, name) == told
    assert math.isfinite(joint.torque)


@pytest.mark.parametrize("solver", [name for name, solver in SOLVERS.items() if "joint motors" in solver.lacks])
@pytest.mark.parametrize("kind", ["revolute", "distance", "prismatic", "wheel"])
def test_a_solver_without_motors_refuses_them(kind: str, solver: str) -> None:
    world = World(solver=solver)
    a, b = world.create_body(kind="static"), world.create_body(Box(1, 1), position=(2, 0))
    where: dict[str, Any] = {"distance": {"anchor1": (0, 0), "anchor2": (2, 0)}}.get(kind, {"anchor": (1, 0)})
    if kind in ("prismatic", "wheel"):
        where["axis"] = (1, 0)
    make = getattr(world, f"create_joint_{kind}")
    before = fingerprint(world)
    with pytest.raises(ValueError, match=rf"^motor_speed = 2\.0: must be None with the solver '{solver}'$"):
        make(a, b, **where, motor_speed=2.0)
    assert fingerprint(world) == before
    joint = make(a, b, **where)
    before = fingerprint(world)
    with pytest.raises(ValueError, match=r"^motor_speed = 2\.0: must be None with"):
        joint.motor_speed = 2.0
    assert fingerprint(world) == before
