"""Contacts and joints as tables and as objects: two views of one thing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import CONTACT_RECORD, JOINT_RECORD, Box, World
from tests.engine.worlds import DT, PRECISIONS, busy, run

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("precision", PRECISIONS)
def test_arbiters_and_contact_records_agree(precision: str) -> None:
    world = run(busy(precision), 45)
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


@pytest.mark.parametrize("precision", PRECISIONS)
def test_joint_records_follow_the_bodies(precision: str) -> None:
    world = World(gravity=(0, 0), precision=precision)
    a = world.create_body(Box(1, 1), position=(1, 2), angle=0.3)
    b = world.create_body(Box(1, 1), position=(-4, 1), angle=-2)
    joint = world.create_joint_revolute(b, a, anchor=(0.5, 0.75))
    record = world.joint_records()[0]
    assert record.dtype == JOINT_RECORD
    assert (record["joint"], record["body1"], record["body2"]) == (joint.serial, b.serial, a.serial)
    assert (record["x1"], record["y1"]) == pytest.approx((0.5, 0.75), abs=1e-6)
    assert (record["x2"], record["y2"]) == pytest.approx((0.5, 0.75), abs=1e-6)
    a.position, a.angle = (10, 10), 0.3 + math.pi / 2
    x, y = 0.5 - 1, 0.75 - 2
    first, second = joint.anchors
    assert tuple(first) == pytest.approx((0.5, 0.75), abs=1e-6)
    assert tuple(second) == pytest.approx((10 - y, 10 + x), abs=1e-6)  # turned by 90 degrees with its body
    run(world, 1)
    record = world.joint_records()[0]
    assert (record["impulse_x"], record["impulse_y"]) == tuple(joint.impulse) != (0, 0)


def test_contacts_are_those_that_the_step_began_with() -> None:
    world = World(precision="double")
    world.create_body(Box(10, 1), kind="static")
    world.create_body(Box(1, 1), position=(0, 0.9999))
    assert world.arbiters == []
    world.step(DT)
    assert world.contact_records()["separation"] == pytest.approx([-0.0001] * 2, abs=1e-12)
