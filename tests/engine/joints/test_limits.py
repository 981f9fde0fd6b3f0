"""Limits of joints: they hold a load and tell it, they let free what is within them, and they never pull."""

from __future__ import annotations

import math

import pytest

from engine import Circle, World
from engine.joints import Joint
from tests.engine.joints.making import GRAVITY, Sprung, joint_omega, one_freedom, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, run

LIMITED = ("revolute", "prismatic", "wheel", "distance")
every_limit = pytest.mark.parametrize("name", LIMITED)
ways = pytest.mark.parametrize("way", [1, -1])


def limited(name: str, lower: float | None, upper: float | None, **settings) -> Sprung:
    """Limits of a value that is 0 as it is made; of a distance joint that is 2 m long then. There is no spring."""
    rest = 2.0 if name == "distance" else 0.0
    more = {} if name != "wheel" else {"hertz": None}
    lower, upper = (None if limit is None else rest + limit for limit in (lower, upper))
    return one_freedom(name, world_of_joints(gravity=(0, 0), **settings), lower=lower, upper=upper, **more)


def loaded(sprung: Sprung, load: float, steps: int) -> None:
    for _ in range(steps):
        sprung.pull(load)
        sprung.world.step(DT)


@every_limit
@ways
def test_it_holds_a_load_and_tells_it(name: str, way: int) -> None:
    load = 12.0
    sprung = limited(name, -0.3, 0.2)
    loaded(sprung, way * load, 240)
    give = load / sprung.inertia / joint_omega(sprung.world) ** 2  # as every rigid joint gives way
    limit = 0.2 if way > 0 else -0.3
    assert sprung.value() == pytest.approx(limit + way * give, abs=1e-8)
    assert sprung.told() == pytest.approx(-way * load, rel=1e-8)


@every_limit
@ways
def test_within_them_it_moves_freely_and_stops_at_the_limit(name: str, way: int) -> None:
    sprung = limited(name, -0.5, 0.5)
    sprung.move(0.0, way * 1.3)
    reached = 0
    for step in range(1, 61):
        sprung.world.step(DT)
        if 1.3 * (step * DT + DT / 4) < 0.5:  # a substep before, the limit begins to slow it down
            assert sprung.value() == pytest.approx(way * 1.3 * step * DT, abs=1e-10)
            assert sprung.told() == pytest.approx(0.0, abs=1e-9)
            reached = step
        assert abs(sprung.value()) < 0.5 + 1e-9, "it comes to the limit, and not past it"
    assert reached == 22
    assert sprung.value() == pytest.approx(way * 0.5, abs=1e-6)


@every_limit
@ways
def test_it_never_pulls(name: str, way: int) -> None:
    sprung = limited(name, -0.2, 0.2)
    loaded(sprung, way * 12.0, 60)
    sprung.move(way * 0.2, -way * 0.5)  # away from it
    start = sprung.value()
    for step in range(1, 11):
        sprung.world.step(DT)
        assert sprung.value() == pytest.approx(start - way * 0.5 * step * DT, abs=1e-9)


@every_limit
def test_one_limit_alone_leaves_the_other_side_free(name: str) -> None:
    for lower, upper, way in ((None, 0.1, -1), (-0.1, None, 1)):
        sprung = limited(name, lower, upper)
        sprung.move(0.0, way * 1.0)
        run(sprung.world, 60)
        assert sprung.value() == pytest.approx(way * 1.0, abs=1e-9)
        assert [sprung.joint.lower is None, sprung.joint.upper is None] == [lower is None, upper is None]
        loaded(sprung, -way * 50.0, 240)
        give = 50.0 / sprung.inertia / joint_omega(sprung.world) ** 2
        assert sprung.value() == pytest.approx(-way * (0.1 + give), abs=1e-6)


@every_limit
def test_equal_limits_hold_it_where_they_are(name: str) -> None:
    for way in (1, -1):
        sprung = limited(name, 0.0, 0.0)
        loaded(sprung, way * 12.0, 120)
        assert sprung.value() == pytest.approx(way * 12.0 / sprung.inertia / joint_omega(sprung.world) ** 2, rel=1e-6)
        assert sprung.told() == pytest.approx(-way * 12.0, rel=1e-8)


@every_limit
def test_limits_are_set_and_taken_away_at_any_time(name: str) -> None:
    rest = 2.0 if name == "distance" else 0.0
    sprung = limited(name, -0.3, 0.2)
    sprung.joint.upper = rest + 0.1
    loaded(sprung, 12.0, 180)
    assert sprung.value() == pytest.approx(0.1, abs=2e-3)
    sprung.joint.upper = None
    assert sprung.joint.upper is None
    sprung.move(0.0, 1.0)
    run(sprung.world, 30)
    assert sprung.value() == pytest.approx(0.5, abs=1e-9)
    assert sprung.told() == pytest.approx(0.0, abs=1e-12)
    if name == "distance":
        return  # without limits it is a rod: test_distance.py
    sprung.joint.lower = None
    sprung.move(0.0, -1.0)
    run(sprung.world, 30)
    assert sprung.value() == pytest.approx(-0.5, abs=1e-9)
    sprung.joint.lower = rest - 0.2
    run(sprung.world, 120)
    assert sprung.value() == pytest.approx(-0.2, abs=2e-3), "what is beyond comes back"


@every_limit
def test_beyond_a_limit_it_comes_back_no_faster_than_joints_do(name: str) -> None:
    # implicit steps of an overdamped spring: from 0.4 beyond, without a bounce
    sprung = limited(name, -1.0, 0.1)
    sprung.move(0.5, 0.0)
    before = 0.5
    for _ in range(60):
        sprung.world.step(DT)
        assert 0.1 - 1e-9 <= sprung.value() <= before
        before = sprung.value()
    assert before == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_rope_is_slack_and_then_taut(precision: str) -> None:
    world = world_of_joints(gravity=(0, -GRAVITY), precision=precision)
    ground = world.create_body(kind="static")
    ball = world.create_body(Circle(0.1), position=(0.0, -0.5), mass=2)
    rope = world.create_joint_distance(ground, ball, anchor1=(0, 0), anchor2=(0, -0.5), upper=1.5)
    assert (rope.lower, rope.upper, rope.hertz) == (None, 1.5, None)
    h, n = DT / 4, 0
    while True:  # h^2 g n (n + 1) / 2 after n substeps
        fallen = h * h * GRAVITY * (n + 4) * (n + 5) / 2
        if fallen >= 1.0:
            break
        n += 4
        world.step(DT)
        assert ball.position.y == pytest.approx(-0.5 - h * h * GRAVITY * n * (n + 1) / 2, abs=1e-5)
        assert rope.force.y == 0.0
    lengths = []
    for _ in range(120):
        world.step(DT)
        lengths.append(rope.current_length)
    assert max(lengths) < 1.5 + 2e-3
    assert lengths[-1] == pytest.approx(1.5 + GRAVITY / joint_omega(world) ** 2, abs=1e-5)
    assert rope.force.y == pytest.approx(2 * GRAVITY, rel=1e-4)


def test_a_limit_of_an_angle_holds_an_arm_with_the_torque_of_its_weight() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    ground = world.create_body(kind="static")
    arm = world.create_body(Circle(0.1), position=(0.8, 0), mass=2)
    joint: Joint = world.create_joint_revolute(ground, arm, anchor=(0, 0), lower=-0.4, upper=1.0)
    run(world, 400)
    torque = 2 * GRAVITY * 0.8 * math.cos(arm.angle)
    assert joint.torque == pytest.approx(torque, rel=1e-7)
    assert tuple(joint.force) == pytest.approx((0.0, 2 * GRAVITY), abs=1e-6)
    # a turn is as stiff as the bodies' own inertia says, whatever hangs on its lever
    assert arm.angle == pytest.approx(-0.4 - torque / arm.inertia / joint_omega(world) ** 2, abs=1e-4)


def test_between_two_free_bodies_a_limit_keeps_momentum() -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Circle(0.4), position=(0, 0), mass=1, angular_velocity=1.0)
    b = world.create_body(Circle(0.3), position=(0, 0), mass=3, angular_velocity=-2.0)
    world.create_joint_revolute(a, b, anchor=(0, 0), lower=-0.5, upper=0.5, collide_connected=False)
    before = a.inertia - 2 * b.inertia
    run(world, 60)
    assert a.inertia * a.angular_velocity + b.inertia * b.angular_velocity == pytest.approx(before, rel=1e-12)
    assert a.angular_velocity == pytest.approx(before / (a.inertia + b.inertia), rel=1e-3), "they turn as one"
    assert b.angle - a.angle == pytest.approx(-0.5, abs=1e-5)


@pytest.mark.parametrize("settings", [{"warm_starting": False}, {"iterations": 3}, {"substeps": 8}, {"substeps": 1}])
@every_limit
def test_whatever_the_settings_it_holds(name: str, settings: dict) -> None:
    sprung = limited(name, -0.3, 0.2, **settings)
    loaded(sprung, 12.0, 240)
    give = 12.0 / sprung.inertia / joint_omega(sprung.world) ** 2
    assert sprung.value() == pytest.approx(0.2 + give, rel=1e-6)
    assert sprung.told() == pytest.approx(-12.0, rel=1e-6)


def test_worlds_of_their_own_programs_have_limits_too() -> None:
    # without the forced code of making.py
    forced, plain = limited("revolute", -0.3, 0.2), None
    world = World(precision="double", gravity=(0, 0))
    plain = one_freedom("revolute", world, lower=-0.3, upper=0.2)
    for sprung in (forced, plain):
        loaded(sprung, 12.0, 30)
    assert forced.world.state_hash() == plain.world.state_hash()
