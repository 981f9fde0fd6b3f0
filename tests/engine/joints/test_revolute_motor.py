"""The motor of a revolute joint: it spins up as its torque says, keeps its speed, holds what it can, and costs nothing
where there is none.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, Box, Circle, RevoluteJoint, Snapshot, World
from tests.engine.worlds import DT, PRECISIONS, busy, fingerprint, run

pytestmark = pytest.mark.kernel

either = pytest.mark.parametrize("solver", [name for name in SOLVERS if "joint motors" not in SOLVERS[name].lacks])
precisely = pytest.mark.parametrize("precision", PRECISIONS)


def wheel(speed: float | None, torque: float, **settings) -> RevoluteJoint:
    """A disc, pinned to the world at its centre, without gravity."""
    world = World(gravity=(0, 0), **settings)
    axle = world.create_body(kind="static")
    disc = world.create_body(Circle(0.5), position=(2, 1), mass=3)
    return world.create_joint_revolute(axle, disc, anchor=(2, 1), motor_speed=speed, max_motor_torque=torque)


def arm(torque: float, **settings) -> RevoluteJoint:
    """A bar of 3 kg whose centre is 1 m beside its pin, held by a motor that would not turn."""
    world = World(**settings)
    pin = world.create_body(kind="static")
    bar = world.create_body(Box(2, 0.2), position=(1, 0), mass=3)
    return world.create_joint_revolute(pin, bar, anchor=(0, 0), motor_speed=0.0, max_motor_torque=torque)


@either
@precisely
def test_spins_up_as_torque_over_inertia_until_it_has_its_speed(precision: str, solver: str) -> None:
    joint = wheel(-4.0, 6.0, solver=solver, precision=precision)
    inertia = 0.5 * 3 * 0.5**2
    rounding = 1e-5 if precision == "single" else 1e-12
    for step in range(1, 30):
        joint.world.step(DT)
        assert joint.body2.angular_velocity == pytest.approx(-min(4.0, 6.0 / inertia * step * DT), rel=rounding)
        if 6.0 / inertia * step * DT < 4.0:
            assert joint.motor_torque == pytest.approx(-6.0, rel=rounding)
    assert joint.motor_torque == pytest.approx(0.0, abs=1e-4), "nothing slows it"
    assert tuple(joint.body2.position) == pytest.approx((2, 1), abs=1e-6)


@either
def test_it_turns_body2_over_body1_and_keeps_angular_momentum(solver: str) -> None:
    world = World(gravity=(0, 0), precision="double", solver=solver)
    a = world.create_body(Circle(0.5), mass=1, angular_velocity=1.0)
    b = world.create_body(Circle(0.7), mass=2)
    world.create_joint_revolute(a, b, anchor=(0, 0), collide_connected=False, motor_speed=3.0, max_motor_torque=2.0)
    before = a.inertia * 1.0
    run(world, 60)
    assert b.angular_velocity - a.angular_velocity == pytest.approx(3.0, rel=1e-12)
    assert a.inertia * a.angular_velocity + b.inertia * b.angular_velocity == pytest.approx(before, rel=1e-12)


@either
@precisely
def test_it_holds_an_arm_up_to_its_torque(precision: str, solver: str) -> None:
    load = 3 * 10 * 1.0  # m g l
    holds = arm(1.03 * load, solver=solver, precision=precision)
    run(holds.world, 180)
    assert abs(holds.body2.angle) < (0.02 if solver == "xpbd" else 0.003)  # its rows are not yet of one mind at first
    assert holds.body2.angular_velocity == pytest.approx(0.0, abs=1e-4)
    assert holds.motor_torque == pytest.approx(load, rel=1e-3)

    # it sinks past the angle at which torque and weight are equal, and comes to rest where the motor can hold it
    slips = arm(0.8 * load, solver=solver, precision=precision)
    run(slips.world, 20)
    assert slips.motor_torque == pytest.approx(0.8 * load, rel=1e-5)
    inertia = 3 * (2**2 + 0.2**2) / 12 + 3
    assert slips.body2.angular_velocity == pytest.approx(-0.2 * load / inertia * 20 * DT, rel=0.05)
    run(slips.world, 300)
    assert slips.body2.angle < -math.acos(0.8)
    assert slips.motor_torque == pytest.approx(load * math.cos(slips.body2.angle), rel=1e-2)


@either
def test_speed_and_torque_are_set_at_any_time(solver: str) -> None:
    joint = wheel(None, 0.0, solver=solver, precision="double")
    run(joint.world, 5)
    assert (joint.motor_speed, joint.max_motor_torque, joint.motor_torque) == (None, 0.0, 0.0)
    assert joint.body2.angular_velocity == 0.0
    joint.motor_speed = 2.0
    run(joint.world, 5)
    assert joint.body2.angular_velocity == 0.0, "no torque yet"
    joint.max_motor_torque = 50.0
    run(joint.world, 5)
    assert joint.body2.angular_velocity == pytest.approx(2.0, rel=1e-12)
    joint.motor_speed = -1.5
    run(joint.world, 5)
    assert joint.body2.angular_velocity == pytest.approx(-1.5, rel=1e-12)
    joint.motor_speed = None
    run(joint.world, 1)
    joint.body2.angular_velocity = 7.0
    run(joint.world, 5)
    assert joint.body2.angular_velocity == pytest.approx(7.0, rel=1e-12), "it runs free"
    assert (joint.motor_speed, joint.max_motor_torque, joint.motor_torque) == (None, 50.0, 0.0)


@either
def test_the_torque_that_it_tells_is_what_it_holds_against_whatever_the_time_step(solver: str) -> None:
    joint = wheel(0.0, 6.0, solver=solver, precision="double")
    for dt in (DT, DT, DT / 3, DT, DT / 2):
        joint.body2.torque = -5.0
        joint.world.step(dt)
        assert joint.motor_torque == pytest.approx(5.0, rel=1e-12)
        assert joint.body2.angular_velocity == pytest.approx(0.0, abs=1e-12)


@either
def test_no_motor_means_no_brake_beside_one(solver: str) -> None:
    joint = wheel(4.0, 6.0, solver=solver, precision="double")
    free = joint.world.create_body(Circle(0.5), position=(5, 5), angular_velocity=3.0)
    joint.world.create_joint_revolute(joint.body1, free, anchor=(5, 5), max_motor_torque=100.0)
    run(joint.world, 10)
    assert free.angular_velocity == pytest.approx(3.0, rel=1e-12)


def test_a_motor_taken_away_gives_nothing() -> None:
    joint = wheel(400.0, 6.0)
    run(joint.world, 2)
    assert joint.motor_torque == pytest.approx(6.0, rel=1e-6)
    joint.motor_speed = None
    assert joint.motor_torque == 0.0
    joint.motor_speed = 400.0
    assert joint.world.snapshot().tables["joints.turns"]["motor_impulse"].tolist() == [0.0], "a new one begins so"


@either
def test_what_it_keeps_is_the_impulse_of_a_whole_step(solver: str) -> None:
    joint = arm(40.0, solver=solver, precision="double")
    run(joint.world, 240)
    kept = joint.world.snapshot().tables["joints.turns"]["motor_impulse"]
    assert kept.tolist() == pytest.approx([30.0 * DT], rel=1e-3)


@either
def test_without_warm_starting_it_turns_all_the_same(solver: str) -> None:
    joint = wheel(4.0, 6.0, solver=solver, precision="double", warm_starting=False)
    run(joint.world, 60)
    assert joint.body2.angular_velocity == pytest.approx(4.0, rel=1e-12)


@either
@precisely
def test_a_snapshot_holds_what_the_motor_does(precision: str, solver: str) -> None:
    joint = arm(31.0, solver=solver, precision=precision)
    run(joint.world, 40)
    other = World(precision=precision)
    other.restore(Snapshot.from_bytes(joint.world.snapshot().to_bytes()))
    again = other.joints[0]
    assert (again.motor_speed, again.max_motor_torque) == (0.0, 31.0)
    assert again.motor_torque == joint.motor_torque != 0.0
    for _ in range(10):
        joint.world.step(DT)
        other.step(DT)
        assert other.state_hash() == joint.world.state_hash()
    # what it gives is carried over: left out, the next step is another, and so is the hash before it
    tables = joint.world.snapshot().tables
    tables["joints.turns"]["motor_impulse"] = 0.0
    other.restore(Snapshot(joint.world.settings, tables))
    assert other.state_hash() != joint.world.state_hash()


def test_a_world_without_motors_has_no_table_of_them() -> None:
    world = busy()
    plain = run(busy(), 20).state_hash()
    world.joints[0].max_motor_torque = 5.0
    world.joints[0].motor_speed = 3.0
    assert "joint motors" in {effect.name for effect in world.effects if effect.called_for}
    world.joints[0].motor_speed = None
    assert "joint motors" not in {effect.name for effect in world.effects if effect.called_for}
    run(world, 20)
    assert not [name for name in world._state.scratch if "motors" in name]
    assert world.state_hash() == plain
    motored = busy()
    motored.joints[0].max_motor_torque = 5.0
    motored.joints[0].motor_speed = 3.0
    assert run(motored, 20).state_hash() != plain


def test_a_row_used_again_has_no_motor() -> None:
    joint = wheel(4.0, 6.0)
    world, ends = joint.world, (joint.body1, joint.body2)
    joint.destroy()
    again = world.create_joint_revolute(*ends, anchor=(2, 1))
    assert (again.motor_speed, again.max_motor_torque) == (None, 0.0)
    world.step(DT)
    assert np.all(world.angular_velocities == 0.0)
    for name in ("motor_speed", "max_motor_torque", "motor_torque"):
        with pytest.raises(ValueError, match="living"):
            getattr(joint, name)
    for name in ("motor_speed", "max_motor_torque"):
        with pytest.raises(ValueError, match="living"):
            setattr(joint, name, 1.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("motor_speed", math.nan), ("motor_speed", "fast"), ("motor_speed", True), ("motor_speed", 1e39),
        ("max_motor_torque", -1.0), ("max_motor_torque", math.inf), ("max_motor_torque", None),
        ("max_motor_torque", 1e39),
    ],
)  # fmt: skip
def test_refusals(name: str, value: object) -> None:
    joint = wheel(4.0, 6.0)
    before = fingerprint(joint.world)
    with pytest.raises(ValueError, match=f"{name} = .*must be"):
        setattr(joint, name, value)
    given = {"motor_speed": 1.0, "max_motor_torque": 1.0, name: value}
    with pytest.raises(ValueError, match=f"{name} = .*must be"):
        joint.world.create_joint_revolute(joint.body1, joint.body2, anchor=(0, 0), **given)
    assert fingerprint(joint.world) == before
