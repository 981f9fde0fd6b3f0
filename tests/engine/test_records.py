"""Contacts and joints as tables and as objects: two views of one thing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import CONTACT_RECORD, JOINT_RECORD, SHAPE_KINDS, SOLVERS, Box, World
from engine.tables import SHAPE
from tests.engine.worlds import DT, POINTS, PRECISIONS, busy, gathering, run

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("make", [busy, gathering])
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_arbiters_and_contact_records_agree(precision: str, solver: str, make) -> None:
    world = run(make(precision, solver=solver), 45)
    records = world.contact_records()
    assert records.dtype == CONTACT_RECORD
    assert len(records) >= 4
    listed = [
        (arbiter.body1.serial, arbiter.body2.serial, contact.feature, *contact.position, *contact.normal,
         contact.separation, contact.normal_impulse, contact.tangent_impulse)
        for arbiter in world.arbiters
        for contact in arbiter.contacts
    ]  # fmt: skip
    assert [tuple(record) for record in records.tolist()] == listed
    for record in records:
        assert math.hypot(record["nx"], record["ny"]) == pytest.approx(1.0, abs=1e-6)


def test_shape_records_tell_every_piece() -> None:
    world = gathering()
    records = world.shape_records()
    assert records.dtype == SHAPE
    kinds = [SHAPE_KINDS[kind] for kind in records["kind"]]
    assert kinds[:5] == ["chain"] * 4 + ["segment"]
    assert set(kinds) == set(SHAPE_KINDS)
    rows = world._state.bodies.tables["bodies"]["serial"][records["body"]]
    assert [int(serial) for serial in rows] == [
        shape.body.serial for body in world.bodies for shape in body.shapes for _ in shape.rows
    ]
    hulls = world.hull_records()
    for record in records[[kind == "polygon" for kind in kinds]]:
        hull = hulls[record["hull"]]
        assert hull["count"] == len(POINTS)
        assert list(zip(hull["x"][:5].tolist(), hull["y"][:5].tolist(), strict=True)) == list(POINTS)
        ends = np.roll(np.array(POINTS), -1, axis=0)
        for k, (a, b) in enumerate(zip(POINTS, ends, strict=True)):
            normal = np.array([hull["nx"][k], hull["ny"][k]])
            assert normal @ normal == pytest.approx(1.0, rel=1e-14)
            assert normal @ (b - a) == pytest.approx(0.0, abs=1e-15)
            assert normal @ np.array(a) > 0, "outwards"
    records["mass"] = 99.0
    hulls["count"] = 3
    assert world.shape_records()["mass"].max() < 5
    assert world.hull_records()["count"].max() == 5


def test_bounds_are_those_of_the_last_step() -> None:
    world = gathering(broad_phase="all_pairs")
    assert world.bounds.shape == (0, 4)
    world.step(DT)
    bounds = world.bounds
    assert bounds.shape == (len(world.shape_records()), 4)
    assert bounds.dtype == np.float32
    assert (bounds[:, :2] < bounds[:, 2:]).all()
    for body in world.bodies[1:]:
        row = next(k for k, shape in enumerate(world.shape_records()) if shape["serial"] == body.shapes[0].serial)
        x, y = body.shapes[0].body.position
        assert bounds[row, 0] - 0.5 < x < bounds[row, 2] + 0.5
        assert bounds[row, 1] - 0.5 < y < bounds[row, 3] + 0.5
    bounds[...] = 0
    assert world.bounds.any()
    world.broad_phase = "dynamic_tree"
    world.step(DT)
    assert (world.bounds[:, 2:] - world.bounds[:, :2]).min() > 0
    world.create_body(Box(1, 1))
    assert world.bounds.shape == (0, 4), "content changed"


def test_records_are_copies() -> None:
    world = run(busy(), 45)
    records, joints = world.contact_records(), world.joint_records()
    before = records.copy(), joints.copy()
    records["normal_impulse"] = 5.0
    joints["impulse_x"] = 5.0
    world.body_records()["x"] = 99.0
    assert np.array_equal(world.contact_records(), before[0])
    assert np.array_equal(world.joint_records(), before[1])
    assert world.positions[:, 0].max() < 50
    run(world, 1)
    assert (records["normal_impulse"] == 5.0).all()


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_joint_records_follow_the_bodies(precision: str, solver: str) -> None:
    world = World(gravity=(0, 0), precision=precision, solver=solver)
    a = world.create_body(Box(1, 1), position=(1, 2), angle=0.3)
    b = world.create_body(Box(1, 1), position=(-4, 1), angle=-2)
    joint = world.create_joint_revolute(b, a, anchor=(0.5, 0.75))
    record = world.joint_records()[0]
    assert record.dtype == JOINT_RECORD
    assert (record["joint"], record["body1"], record["body2"]) == (joint.serial, b.serial, a.serial)
    assert (record["x1"], record["y1"]) == pytest.approx((0.5, 0.75), abs=1e-6)
    assert (record["x2"], record["y2"]) == pytest.approx((0.5, 0.75), abs=1e-6)
    a.position, a.angle, a.velocity = (10, 10), 0.3 + math.pi / 2, (1, 2)
    x, y = 0.5 - 1, 0.75 - 2
    first, second = joint.anchors
    assert tuple(first) == pytest.approx((0.5, 0.75), abs=1e-6)
    assert tuple(second) == pytest.approx((10 - y, 10 + x), abs=1e-6)  # turned by 90 degrees with its body
    run(world, 1)
    record = world.joint_records()[0]
    assert (record["impulse_x"], record["impulse_y"]) == tuple(joint.impulse) != (0, 0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_contacts_are_those_that_the_step_began_with(solver: str) -> None:
    world = World(precision="double", solver=solver)
    world.create_body(Box(10, 1), kind="static")
    world.create_body(Box(1, 1), position=(0, 0.9999))
    assert world.arbiters == []
    world.step(DT)
    assert world.contact_records()["separation"] == pytest.approx([-0.0001] * 2, abs=1e-12)
