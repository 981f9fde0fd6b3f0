"""Joints as scalar rows: values as the handles tell them, Jacobians by differences, impulses kept where they belong."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest

from engine import World
from engine.solvers.joint_rows import (
    ACROSS_AXIS,
    ALONG_THE_AXIS,
    ALONG_THE_WAY,
    DRIVES,
    HOLDS,
    LACKING,
    LOWER,
    SPRINGS,
    TURN,
    UPPER,
    Rows,
    X,
    Y,
    prepare,
    refresh,
    rows_of,
    store,
)  # fmt: skip
from engine.solvers.soft_step.tables import mover_dtype
from engine.stages import prepare_step
from engine.tables import empty
from tests.engine.joints.making import MAKERS, PARTS, two_free
from tests.engine.worlds import DT

pytestmark = pytest.mark.kernel

CASES = [(kind, full) for kind in MAKERS if f"{kind} joints" not in LACKING for full in (False, True)]
EXPECTED = {
    ("revolute", False): [(X, HOLDS), (Y, HOLDS)],
    ("revolute", True): [(TURN, SPRINGS), (TURN, DRIVES), (TURN, LOWER), (TURN, UPPER), (X, HOLDS), (Y, HOLDS)],
    ("distance", False): [(ALONG_THE_WAY, HOLDS)],
    ("distance", True): [(ALONG_THE_WAY, use) for use in (SPRINGS, DRIVES, LOWER, UPPER)],
    ("prismatic", False): [(ACROSS_AXIS, HOLDS), (TURN, HOLDS)],
    ("prismatic", True): [
        *((ALONG_THE_AXIS, use) for use in (SPRINGS, DRIVES, LOWER, UPPER)), (ACROSS_AXIS, HOLDS), (TURN, HOLDS),
    ],
    ("weld", False): [(TURN, HOLDS), (X, HOLDS), (Y, HOLDS)],
    ("weld", True): [(TURN, SPRINGS), (X, SPRINGS), (Y, SPRINGS)],
    ("wheel", False): [(ALONG_THE_AXIS, SPRINGS), (ACROSS_AXIS, HOLDS)],
    ("wheel", True): [
        (TURN, DRIVES), *((ALONG_THE_AXIS, use) for use in (SPRINGS, LOWER, UPPER)), (ACROSS_AXIS, HOLDS),
    ],
}  # fmt: skip


class Case(NamedTuple):
    """Two bodies, one joint, and its rows as a step begins."""

    world: World
    joint: Any  # its handle
    rows: Rows
    movers: np.ndarray


def begin(world: World) -> tuple[Rows, np.ndarray]:
    state = world._state
    prepare_step(state, world.settings, DT)
    found = rows_of(state)
    assert found is not None
    movers = empty(len(state.bodies.tables["bodies"]), mover_dtype(world.precision))
    movers["cosine"] = 1
    joints, bodies = state.joints.tables, state.bodies.tables
    prepare(
        found.rows, found.frames, joints["joints"], joints["turns"], joints["slides"], bodies["bodies"],
        bodies["motions"], movers, state.steps[0],
    )  # fmt: skip
    return found, movers


def made(kind: str, full: bool) -> Case:
    world = World(precision="double", sleeping=False)
    a, b = two_free(world)
    joint = MAKERS[kind](world, a, b, **(PARTS[kind] if full else {}))
    b.position, b.angle = (b.position.x + 0.13, b.position.y - 0.07), b.angle + 0.21  # so that nothing is at rest
    return Case(world, joint, *begin(world))


@pytest.mark.parametrize(("kind", "full"), [case for case in CASES if case[0] != "filter"])
def test_which_rows_a_joint_has(kind: str, full: bool) -> None:
    rows = made(kind, full).rows.rows
    assert list(zip(rows["measures"], rows["use"], strict=True)) == EXPECTED[kind, full]
    assert (rows["least"] < rows["most"]).all()
    assert np.isinf(rows["most"][rows["use"] <= SPRINGS]).all()
    assert (rows["least"][rows["use"] == LOWER] == 0).all()
    assert (rows["most"][rows["use"] == UPPER] == 0).all()


def test_a_filter_has_no_rows() -> None:
    world = World()
    MAKERS["filter"](world, *two_free(world))
    prepare_step(world._state, world.settings, DT)
    assert rows_of(world._state) is None


def values(joint: Any) -> dict[int, float]:
    """What rows measure, as the handle tells it."""
    one, two = joint.anchors
    way = two - one
    found = {X: way.x, Y: way.y, ALONG_THE_WAY: math.hypot(way.x, way.y)}
    if hasattr(joint, "angle"):
        found[TURN] = joint.angle
    elif joint.kind == "prismatic":
        found[TURN] = joint.body2.angle - joint.body1.angle - float(joint._part("joints")["reference_angle"])
    if hasattr(joint, "translation"):
        across = (-joint.axis.y, joint.axis.x)
        found[ACROSS_AXIS] = across[0] * way.x + across[1] * way.y
        found[ALONG_THE_AXIS] = joint.translation
    return found


@pytest.mark.parametrize(("kind", "full"), EXPECTED)
def test_errors_are_what_the_handle_tells(kind: str, full: bool) -> None:
    case = made(kind, full)
    told = values(case.joint)
    for row in case.rows.rows:
        zero = {LOWER: getattr(case.joint, "lower", 0), UPPER: getattr(case.joint, "upper", 0)}.get(int(row["use"]))
        if row["use"] == DRIVES:
            zero = told[int(row["measures"])]
        elif zero is None:
            zero = case.joint.length if row["measures"] == ALONG_THE_WAY else 0.0
        assert row["error"] == pytest.approx(told[int(row["measures"])] - zero, abs=1e-14)


def jacobian(case: Case) -> np.ndarray:
    """(rows, 6): how an error changes with both bodies' places and angles."""
    rows = case.rows.rows
    n = np.stack([rows["nx"], rows["ny"]], axis=1)
    return np.concatenate([-n, -rows["arm1"][:, None], n, rows["arm2"][:, None]], axis=1)


def errors_at(case: Case, moved: np.ndarray) -> np.ndarray:
    """Errors after both bodies moved by so much: (2, 3), x and y [m] and angle [rad]."""
    for body, (x, y, angle) in zip((case.joint.body1, case.joint.body2), moved, strict=True):
        mover = case.movers[body._row]
        mover["dx"], mover["dy"], mover["turned"] = x, y, angle
        mover["cosine"], mover["sine"] = math.cos(angle), math.sin(angle)
    refresh(case.rows.rows, case.rows.frames, case.movers)
    return np.array(case.rows.rows["error"])


MOVED = np.array([[0.3, -0.2, 0.7], [-0.15, 0.4, -0.5]])


@pytest.mark.parametrize(("kind", "full"), EXPECTED)
@pytest.mark.parametrize("start", [0.0, 1.0])
def test_jacobians_are_those_of_the_errors(kind: str, full: bool, start: float) -> None:
    case, small = made(kind, full), 1e-6
    found = np.empty((len(case.rows.rows), 6))
    for k in range(6):
        step = np.zeros(6)
        step[k] = small
        there, back = (errors_at(case, start * MOVED + sign * step.reshape(2, 3)) for sign in (1, -1))
        found[:, k] = (there - back) / (2 * small)
    errors_at(case, start * MOVED)
    np.testing.assert_allclose(jacobian(case), found, atol=1e-9)


@pytest.mark.parametrize(("kind", "full"), EXPECTED)
def test_rows_within_a_step_are_those_of_a_step_that_begins_there(kind: str, full: bool) -> None:
    case = made(kind, full)
    errors_at(case, MOVED)
    within = case.rows.rows.copy()
    for body, (x, y, angle) in zip((case.joint.body1, case.joint.body2), MOVED, strict=True):
        body.position, body.angle = (body.position.x + x, body.position.y + y), body.angle + angle
    rows = begin(case.world)[0].rows
    for name in ("nx", "ny", "arm1", "arm2", "mass", "error"):
        kept = rows["use"] != DRIVES if name == "error" else rows["use"] >= 0  # they count from where a step begins
        np.testing.assert_allclose(within[name][kept], rows[name][kept], atol=1e-12)


@pytest.mark.parametrize(("kind", "full"), EXPECTED)
def test_mass_is_what_an_impulse_feels(kind: str, full: bool) -> None:
    case = made(kind, full)
    bodies = (case.joint.body1, case.joint.body2)
    inverse = np.concatenate([[1 / body.mass, 1 / body.mass, 1 / body.inertia] for body in bodies])
    j = jacobian(case)
    np.testing.assert_allclose(1 / case.rows.rows["mass"], (j * inverse * j).sum(axis=1), rtol=1e-12)


def test_a_spring_has_its_frequency() -> None:
    case = made("prismatic", True)
    row = case.rows.rows[0]
    assert row["use"] == SPRINGS
    assert row["stiffness"] == pytest.approx(row["mass"] * (2 * math.pi * 2.0) ** 2)
    assert row["damping"] == pytest.approx(2 * row["mass"] * 1.0 * 2 * math.pi * 2.0)


def test_a_softness_is_the_spring_that_its_formula_says() -> None:
    stiffness, damping = 700.0, 30.0
    world = World(precision="double")
    a, b = two_free(world)
    soft, bias = 1 / (DT * (damping + DT * stiffness)), DT * stiffness / (damping + DT * stiffness)
    world.create_joint_revolute(a, b, anchor=(0.5, 0.2), softness=soft, bias_factor=bias)
    rows = begin(world)[0].rows
    assert (rows["use"] == SPRINGS).all()
    np.testing.assert_allclose(rows["stiffness"], stiffness, rtol=1e-12)
    np.testing.assert_allclose(rows["damping"], damping, rtol=1e-12)


@pytest.mark.parametrize(("kind", "full"), EXPECTED)
def test_impulses_are_kept_from_step_to_step(kind: str, full: bool) -> None:
    case = made(kind, full)
    rows, joints = case.rows.rows, case.world._state.joints.tables
    wanted = np.arange(1.0, len(rows) + 1) * np.where(rows["use"] == UPPER, -1, 1)
    rows["impulse"], rows["given"] = wanted, 2 * wanted
    store(rows, case.rows.frames, joints["joints"], joints["turns"], joints["slides"], 1.0)
    again = begin(case.world)[0].rows
    np.testing.assert_allclose(again["impulse"], wanted / case.world.substeps)  # each substep starts from its part
    assert (again["given"] == 0).all()
    case.world.warm_starting = False
    assert (begin(case.world)[0].rows["impulse"] == 0).all()


def test_what_was_given_is_what_the_joint_tells() -> None:
    case = made("prismatic", False)
    rows, joints = case.rows.rows, case.world._state.joints.tables
    rows["given"] = (3.0, 0.7)
    store(rows, case.rows.frames, joints["joints"], joints["turns"], joints["slides"], 1.0)
    axis = case.joint.axis
    assert tuple(case.joint.impulse) == pytest.approx((-3.0 * axis.y, 3.0 * axis.x))
    assert case.world.joint_records()["turn_impulse"] == pytest.approx(0.7)


def test_rows_follow_the_content() -> None:
    world = World()
    a, b = two_free(world)
    joint = world.create_joint_revolute(a, b, anchor=(0.5, 0.2))
    assert len(begin(world)[0].rows) == 2
    joint.motor_speed = 1.0
    assert len(begin(world)[0].rows) == 3
    joint.destroy()
    prepare_step(world._state, world.settings, DT)
    assert rows_of(world._state) is None
