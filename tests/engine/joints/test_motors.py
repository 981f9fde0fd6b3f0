"""Motors of joints: force over mass until they have their speed, and no more than their force, whatever the kind."""

from __future__ import annotations

import pytest

from engine import Circle
from tests.engine.joints.making import GRAVITY, Sprung, one_freedom, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run

TURNING, SLIDING = ("revolute", "wheel"), ("prismatic", "distance")
every_motor = pytest.mark.parametrize("name", TURNING + SLIDING)


def driven(name: str, speed: float | None, most: float, **settings) -> Sprung:
    """A motor of that speed and strength, without gravity."""
    strength = {"max_motor_torque" if name in TURNING else "max_motor_force": most}
    world = world_of_joints(**{"gravity": (0, 0), **settings})
    sprung = one_freedom(name, world, motor_speed=speed, **strength)
    if name != "wheel":
        return sprung
    wheel = sprung.joint.body2  # the motor of a wheel turns it

    def pull(torque: float) -> None:
        wheel.torque = torque

    def move(at: float, speed: float) -> None:
        wheel.angle, wheel.angular_velocity = at, speed

    return Sprung(world, sprung.joint, lambda: wheel.angle, move, wheel.inertia, pull, lambda: sprung.joint.torque)


def speed_of(sprung: Sprung, name: str) -> float:
    body = sprung.joint.body2
    return body.angular_velocity if name in TURNING else body.velocity.x * 0.6 + body.velocity.y * 0.8


def strength_of(sprung: Sprung, name: str) -> float:
    return sprung.joint.motor_torque if name in TURNING else sprung.joint.motor_force


@every_motor
@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_speeds_up_as_force_over_mass_until_it_has_its_speed(name: str, precision: str) -> None:
    most = 0.9
    sprung = driven(name, -0.5, most, precision=precision)
    rounding = 1e-4 if precision == "single" else 1e-10
    accelerating = 0
    for step in range(1, 181):
        sprung.world.step(DT)
        expected = min(0.5, most / sprung.inertia * step * DT)
        assert speed_of(sprung, name) == pytest.approx(-expected, rel=rounding)
        if most / sprung.inertia * step * DT < 0.5:
            assert strength_of(sprung, name) == pytest.approx(-most, rel=rounding)
            assert sprung.told() == pytest.approx(-most, rel=rounding)
            accelerating = step
    assert accelerating >= 3
    assert strength_of(sprung, name) == pytest.approx(0.0, abs=1e-4), "nothing slows it"


@every_motor
def test_it_holds_a_load_up_to_its_force_and_no_further(name: str) -> None:
    holds = driven(name, 0.0, 5.0)
    for _ in range(60):
        holds.pull(4.9)
        holds.world.step(DT)
    assert speed_of(holds, name) == pytest.approx(0.0, abs=1e-12)
    assert holds.value() == pytest.approx(0.0, abs=1e-12)
    assert strength_of(holds, name) == pytest.approx(-4.9, rel=1e-10)
    assert holds.told() == pytest.approx(-4.9, rel=1e-10)

    slips = driven(name, 0.0, 5.0)
    for step in range(1, 31):
        slips.pull(5.0 + 0.3)
        slips.world.step(DT)
        assert speed_of(slips, name) == pytest.approx(0.3 / slips.inertia * step * DT, rel=1e-9)
        assert strength_of(slips, name) == pytest.approx(-5.0, rel=1e-10)


@every_motor
def test_it_keeps_its_speed_under_a_load(name: str) -> None:
    sprung = driven(name, 0.7, 50.0)
    for _ in range(60):
        sprung.pull(-20.0)
        sprung.world.step(DT)
    assert speed_of(sprung, name) == pytest.approx(0.7, rel=1e-10)
    assert strength_of(sprung, name) == pytest.approx(20.0, rel=1e-9)


@every_motor
def test_speed_and_force_are_set_at_any_time(name: str) -> None:
    sprung = driven(name, None, 0.0)
    joint = sprung.joint
    most = "max_motor_torque" if name in TURNING else "max_motor_force"
    assert (joint.motor_speed, getattr(joint, most)) == (None, 0.0)
    joint.motor_speed = 0.4
    run(joint.world, 3)
    assert speed_of(sprung, name) == 0.0, "no force yet"
    setattr(joint, most, 1000.0)
    run(joint.world, 3)
    assert speed_of(sprung, name) == pytest.approx(0.4, rel=1e-12)
    joint.motor_speed = -0.3
    run(joint.world, 3)
    assert speed_of(sprung, name) == pytest.approx(-0.3, rel=1e-12)


def test_a_lift_carries_its_weight_at_its_speed() -> None:
    # a prismatic motor upwards against gravity: v until the force is not enough
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    box = world.create_body(Circle(0.3), position=(0, 1), mass=2)
    lift = world.create_joint_prismatic(ground, box, anchor=(0, 1), axis=(0, 1), motor_speed=0.5, max_motor_force=21.0)
    run(world, 120)
    assert box.velocity.y == pytest.approx(0.5, rel=1e-9)
    assert lift.motor_force == pytest.approx(2 * GRAVITY, rel=1e-9)
    lift.max_motor_force = 19.0
    start = box.velocity.y
    run(world, 30)
    assert box.velocity.y == pytest.approx(start - (2 * GRAVITY - 19) / 2 * 30 * DT, rel=1e-9)
    assert tuple(lift.force) == pytest.approx((0.0, 19.0), abs=1e-9)


def test_a_motor_drives_up_to_the_limit_and_pushes_against_it() -> None:
    sprung = driven("prismatic", 1.0, 30.0)
    sprung.joint.upper = 0.25
    run(sprung.world, 240)
    assert sprung.value() == pytest.approx(0.25, abs=2e-3)
    assert sprung.joint.motor_force == pytest.approx(30.0, rel=1e-9)
    assert sprung.told() == pytest.approx(0.0, abs=1e-6), "the limit holds against the motor"


@every_motor
@pytest.mark.parametrize("settings", [{"warm_starting": False}, {"iterations": 4}, {"substeps": 1}, {"substeps": 9}])
def test_whatever_the_settings_it_gets_its_speed(name: str, settings: dict) -> None:
    sprung = driven(name, 0.6, 2.0, **settings)
    for step in range(1, 11):
        sprung.world.step(DT)
        assert speed_of(sprung, name) == pytest.approx(min(0.6, 2.0 / sprung.inertia * step * DT), rel=1e-9)


@pytest.mark.parametrize("name", TURNING)
def test_a_turning_motor_keeps_angular_momentum(name: str) -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Circle(0.5), mass=1, angular_velocity=1.0)
    b = world.create_body(Circle(0.7), mass=2)
    more = {"axis": (0, 1)} if name == "wheel" else {}
    make = getattr(world, f"create_joint_{name}")
    make(a, b, anchor=(0, 0), collide_connected=False, motor_speed=3.0, max_motor_torque=2.0, **more)
    run(world, 90)
    assert b.angular_velocity - a.angular_velocity == pytest.approx(3.0, rel=1e-12)
    assert a.inertia * a.angular_velocity + b.inertia * b.angular_velocity == pytest.approx(a.inertia, rel=1e-12)


@pytest.mark.parametrize("name", SLIDING)
def test_a_sliding_motor_keeps_momentum(name: str) -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Circle(0.2), mass=1, velocity=(0.5, 0))
    b = world.create_body(Circle(0.2), position=(1, 0), mass=2)
    places = {"anchor": (0, 0), "axis": (1, 0)} if name == "prismatic" else {"anchor1": (0, 0), "anchor2": (1, 0)}
    make = getattr(world, f"create_joint_{name}")
    make(a, b, collide_connected=False, motor_speed=0.9, max_motor_force=2.0, **places)
    run(world, 120)
    assert b.velocity.x - a.velocity.x == pytest.approx(0.9, rel=1e-12)
    assert a.velocity.x + 2 * b.velocity.x == pytest.approx(0.5, rel=1e-12)
