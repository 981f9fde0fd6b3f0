"""What every kind of joint must do: keep momentum, let go, part its bodies or not, and the same bits in every way."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from engine import Box, Snapshot, World
from tests.engine.joints.making import HOLDING, MAKERS, all_joints, two_free, world_of_joints
from tests.engine.worlds import DT, PRECISIONS, floor, run, tables_of

every_kind = pytest.mark.parametrize("kind", MAKERS)
every_holding = pytest.mark.parametrize("kind", HOLDING)
SETTINGS = [
    {}, {"warm_starting": False}, {"position_correction": False}, {"substeps": 8, "iterations": 2}, {"substeps": 1},
    {"stiffness": "fixed"}, {"joint_solving": "direct"}, {"joint_solving": "iterated"},
]  # fmt: skip

PARTS: dict[str, dict] = {
    "revolute": {"motor_speed": 2.0, "max_motor_torque": 3.0, "lower": -0.4, "upper": 0.5, "hertz": 2.0},
    "distance": {"motor_speed": 0.5, "max_motor_force": 3.0, "lower": 1.0, "upper": 1.6, "hertz": 2.0},
    "prismatic": {"motor_speed": 0.5, "max_motor_force": 3.0, "lower": -0.2, "upper": 0.3, "hertz": 2.0},
    "weld": {"linear_hertz": 3.0, "angular_hertz": 2.0},
    "wheel": {"motor_speed": 3.0, "max_motor_torque": 3.0, "lower": -0.2, "upper": 0.3},
    "motor": {"linear_hertz": 2.0, "angular_hertz": 1.0},
    "mouse": {"max_force": 8.0},
    "filter": {},
}
"""Everything that may act in them."""

CASES = [(kind, False) for kind in MAKERS] + [(kind, True) for kind in HOLDING]
plain_and_full = pytest.mark.parametrize(("kind", "full"), CASES, ids=lambda case: str(case))


def pair(kind: str, full: bool = False, **settings):
    """Two bodies that drift and spin, joined, and nothing else."""
    world = world_of_joints(**{"gravity": (0, 0), **settings})
    a, b = two_free(world)
    more = PARTS[kind] if full else {}
    return MAKERS[kind](world, a, b, **more, **({} if kind == "filter" else {"collide_connected": False}))


def fair(world: World, full: bool = True) -> None:
    """One of every kind, hanging from above a floor, a chain of some, and bodies that fall among them."""
    floor(world)
    top = world.create_body(kind="static", position=(0, 3))
    for k, kind in enumerate(MAKERS):
        a = world.create_body(Box(0.4, 0.3), position=(1.3 * k - 4, 2.2), angle=0.1 * k, mass=1 + 0.3 * k)
        b = world.create_body(Box(0.3, 0.5), position=(1.3 * k - 3.5, 2.0), angle=-0.2 * k, fixed_rotation=k == 3)
        world.create_joint_revolute(top, a, anchor=(1.3 * k - 4, 2.6))
        MAKERS[kind](world, a, b, **(PARTS[kind] if full else {}))
    plate = world.create_body(Box(1, 0.2), position=(7.5, 1), kind="kinematic", velocity=(0.1, 0), angular_velocity=0.3)
    rider = world.create_body(Box(0.3, 0.3), position=(7.9, 1.4))
    world.create_joint_prismatic(plate, rider, anchor=(7.9, 1.4), axis=(1, 0), hertz=1.0)
    links = [world.create_body(Box(0.3, 0.1), position=(0.3 * k - 6, 4)) for k in range(5)]
    for k, (a, b) in enumerate(pairwise(links)):
        world.create_joint_revolute(a, b, anchor=(0.3 * k - 5.85, 4), collide_connected=False)
    world.create_joint_weld(top, links[0], anchor=(-6, 4))


@plain_and_full
@pytest.mark.parametrize("solving", ["iterated", "direct"])
def test_momentum_and_angular_momentum_are_kept(kind: str, full: bool, solving: str) -> None:
    joint = pair(kind, full, joint_solving=solving)
    before = joint.world.diagnostics()
    for _ in range(3):
        run(joint.world, 10)
        after = joint.world.diagnostics()
        assert tuple(after.momentum) == pytest.approx(tuple(before.momentum), rel=1e-13)
        assert abs(joint.body1.velocity.x - 1) > 1e-6 or kind == "filter", "it acts"
    assert after.angular_momentum == pytest.approx(before.angular_momentum, rel=1e-12)


@every_holding
@pytest.mark.parametrize("precision", PRECISIONS)
def test_it_holds_together_what_it_joins(kind: str, precision: str) -> None:
    joint = pair(kind, precision=precision)
    angle = joint.body2.angle - joint.body1.angle
    length = joint.current_length if kind == "distance" else 0.0
    for _ in range(120):
        joint.world.step(DT)
        a, b = joint.anchors
        way = (b.x - a.x, b.y - a.y)
        if kind in ("revolute", "weld"):
            assert math.hypot(*way) < 2e-3
        if kind == "distance":
            assert joint.current_length == pytest.approx(length, abs=2e-3)
        if kind in ("prismatic", "wheel"):
            assert abs(way[1] * joint.axis.x - way[0] * joint.axis.y) < 3e-3
        if kind in ("weld", "prismatic"):
            assert joint.body2.angle - joint.body1.angle == pytest.approx(angle, abs=3e-3)


@every_kind
def test_destroyed_it_lets_go(kind: str) -> None:
    joint = pair(kind, full=True)
    world, a, b = joint.world, joint.body1, joint.body2
    run(world, 5)
    joint.destroy()
    assert (world.joint_count, joint.alive) == (0, False)
    speeds = (tuple(a.velocity), tuple(b.velocity), a.angular_velocity, b.angular_velocity)
    run(world, 10)
    assert (tuple(a.velocity), tuple(b.velocity), a.angular_velocity, b.angular_velocity) == speeds
    for name in ("force", "torque", "anchors", "body1", "break_force", "collide_connected", "impulse"):
        with pytest.raises(ValueError, match="living"):
            getattr(joint, name)
    with pytest.raises(ValueError, match="living"):
        joint.break_force = 1.0
    assert "destroyed" in repr(joint)


@every_kind
def test_a_body_takes_its_joints_with_it(kind: str) -> None:
    joint = pair(kind)
    joint.body2.destroy()
    assert not joint.alive
    assert joint.world.joint_count == 0
    joint.world.step(DT)


@every_holding
@pytest.mark.parametrize("collide", [True, False])
def test_collide_connected(kind: str, collide: bool) -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Box(1, 1))
    b = world.create_body(Box(1, 1), position=(0.6, 0.1))
    joint = MAKERS[kind](world, a, b, collide_connected=collide)
    world.step(DT)
    assert joint.collide_connected is collide
    assert len(world.arbiters) == int(collide)
    joint.destroy()
    world.step(1e-6)
    assert len(world.arbiters) == 1


@plain_and_full
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_snapshot_continues_with_the_same_bits(kind: str, full: bool, precision: str) -> None:
    world = pair(kind, full, precision=precision, gravity=(0, -10)).world
    world.step(DT)
    run(world, 6)
    other = all_joints(World(precision=precision))
    other.restore(Snapshot.from_bytes(world.snapshot().to_bytes()))
    assert type(other.joints[0]) is type(world.joints[0])
    for _ in range(8):
        world.step(DT)
        other.step(DT)
        assert other.state_hash() == world.state_hash()
    assert tables_of(other) == tables_of(world)
    assert np.array_equal(other.joint_records(), world.joint_records())


@plain_and_full
def test_a_snapshot_taken_back_repeats_itself(kind: str, full: bool) -> None:
    world = pair(kind, full, gravity=(0, -10)).world
    run(world, 5)
    kept = world.snapshot()
    hashes = [run(world, 1).state_hash() for _ in range(5)]
    world.restore(kept)
    assert [run(world, 1).state_hash() for _ in range(5)] == hashes


@plain_and_full
def test_run_is_step_by_step(kind: str, full: bool) -> None:
    worlds = [pair(kind, full, gravity=(0, -10)).world for _ in range(2)]
    run(worlds[0], 25)
    worlds[1].run(25, DT)
    assert worlds[0].state_hash() == worlds[1].state_hash()
    assert tables_of(worlds[0]) == tables_of(worlds[1])


def many(change: Callable[[World], None] | None = None, full: bool = True, **settings) -> World:
    world = world_of_joints(**settings)
    fair(world, full)
    if change is not None:
        change(world)
    return world


def one_lane(world: World) -> None:
    world._state.lanes = 1
    world._state.stale = True


def two_threads(world: World) -> None:
    world.threads = 2
    world._state.threads_from = 0


@pytest.mark.parametrize("settings", [{}, {"precision": "single"}, *SETTINGS[1:]], ids=str)
def test_one_lane_and_eight_give_the_same_bits(settings: dict) -> None:
    eight, one = many(**settings), many(one_lane, **settings)
    for step in range(40):
        eight.step(DT)
        one.step(DT)
        if step % 8 == 7:
            assert eight.state_hash() == one.state_hash(), step
    assert tables_of(eight) == tables_of(one)


@pytest.mark.parametrize("full", [False, True])
def test_without_forced_code_the_same_bits(full: bool) -> None:
    plain, forced = World(precision="double"), many(full=full)
    fair(plain, full)
    for world in (plain, forced):
        run(world, 25)
    assert plain.state_hash() == forced.state_hash()


def test_two_threads_give_the_bits_of_one() -> None:
    def crowd(world: World) -> None:  # fewer than 256 bodies are stepped by one thread
        for k in range(30):
            last = world.create_body(kind="static", position=(2.0 * k, 12))
            for n in range(9):
                body = world.create_body(Box(0.2, 0.5), position=(2.0 * k + 0.5 * n + 0.25, 12 - 0.05 * n))
                anchor = (2.0 * k + 0.5 * n, 12 - 0.05 * n)
                if n % 3 == 1:
                    world.create_joint_weld(last, body, anchor=anchor, angular_hertz=3.0)
                elif n % 3 == 2:
                    world.create_joint_prismatic(last, body, anchor=anchor, axis=(1, 1), lower=-0.1, upper=0.1)
                else:
                    world.create_joint_revolute(last, body, anchor=anchor, motor_speed=1.0, max_motor_torque=0.5)
                last = body

    for settings in ({}, {"joint_solving": "direct"}):
        one, two = many(crowd, **settings), many(crowd, **settings)
        two.threads = 2
        for _ in range(12):
            one.step(DT)
            two.step(DT)
        assert one.state_hash() == two.state_hash()
        assert tables_of(one) == tables_of(two)


@pytest.mark.parametrize("settings", SETTINGS, ids=str)
@every_holding
def test_whatever_the_settings_it_stays_finite_and_holds(kind: str, settings: dict) -> None:
    joint = pair(kind, full=True, gravity=(0, -10), **settings)
    before = joint.world.diagnostics().momentum
    run(joint.world, 60)
    assert np.isfinite(joint.world.positions).all()
    after = joint.world.diagnostics().momentum  # only the weight changed it
    assert after.x == pytest.approx(before.x, rel=1e-9)
    assert after.y - before.y == pytest.approx(-10 * 5.5 * 60 * DT, rel=1e-9)


@every_holding
@pytest.mark.parametrize("which", ["static", "kinematic", "fixed"])
@pytest.mark.parametrize("first", [True, False])
def test_with_bodies_that_no_impulse_moves_or_turns(kind: str, which: str, first: bool) -> None:
    world = world_of_joints(gravity=(0, -10))
    settled = {"fixed_rotation": True} if which == "fixed" else {"kind": which}
    velocity = {"velocity": (0.1, 0.2), "angular_velocity": 0.3} if which == "kinematic" else {}
    other = world.create_body(Box(0.5, 0.5), **settled, **velocity)
    free = world.create_body(Box(0.5, 0.4), position=(0.6, 0.3), mass=2, angle=0.4)
    bodies = (other, free) if first else (free, other)
    MAKERS[kind](world, *bodies, **PARTS[kind], collide_connected=False)
    run(world, 60)
    assert np.isfinite(world.positions).all()
    if which == "static":
        assert tuple(other.position) == (0, 0)
    if which == "kinematic":
        assert tuple(other.velocity) == pytest.approx((0.1, 0.2), rel=1e-12)
        assert other.angle == pytest.approx(0.3 * 60 * DT, rel=1e-9)
    if which == "fixed":
        assert (other.angle, other.angular_velocity) == (0, 0)


@every_holding
def test_two_bodies_that_do_not_turn(kind: str) -> None:
    world = world_of_joints(gravity=(0, 0))
    a = world.create_body(Box(0.5, 0.5), fixed_rotation=True, mass=2, velocity=(1, 0))
    b = world.create_body(Box(0.5, 0.5), fixed_rotation=True, mass=3, position=(1, 0.3))
    MAKERS[kind](world, a, b, **PARTS[kind], collide_connected=False)
    run(world, 60)
    assert 2 * a.velocity.x + 3 * b.velocity.x == pytest.approx(2.0, rel=1e-12)
    assert (a.angle, b.angle) == (0, 0)


@every_kind
def test_between_bodies_of_very_different_mass_it_stays_finite(kind: str) -> None:
    for ratio in (1e-6, 1e6):
        world = world_of_joints(precision="single", gravity=(0, -10))
        a = world.create_body(Box(1, 1), mass=1)
        b = world.create_body(Box(1, 1), mass=ratio, position=(0.8, 0.3))
        MAKERS[kind](world, a, b, **PARTS[kind], **({} if kind == "filter" else {"collide_connected": False}))
        run(world, 60)
        assert np.isfinite(world.positions).all()


@pytest.mark.parametrize("kind", HOLDING)
def test_what_it_tells_is_what_the_bodies_got(kind: str) -> None:
    # change of momentum of body2 over a step, and of its spin: force, and torque with the force's moment
    joint = pair(kind, full=True)
    b = joint.body2
    for _ in range(20):
        before, spin = (b.velocity.x, b.velocity.y), b.angular_velocity
        first = joint.anchors[1] - b.position
        joint.world.step(DT)
        second = joint.anchors[1] - b.position
        gained = (b.mass * (b.velocity.x - before[0]), b.mass * (b.velocity.y - before[1]))
        size = math.hypot(*gained) + 1e-9
        # along an axis that turned within the step the sum is told along where it ends
        assert tuple(joint.impulse) == pytest.approx(gained, abs=0.03 * size)
        arm = ((first.x + second.x) / 2, (first.y + second.y) / 2)
        moment = arm[0] * gained[1] - arm[1] * gained[0]
        turned = b.inertia * (b.angular_velocity - spin)
        assert joint.torque * DT + moment == pytest.approx(turned, abs=0.05 * (abs(turned) + size))


@pytest.mark.parametrize("kind", ["revolute", "weld", "motor", "mouse"])
def test_a_point_tells_exactly_what_it_gave(kind: str) -> None:
    joint = pair(kind, full=True)
    b = joint.body2
    for _ in range(20):
        before = (b.velocity.x, b.velocity.y)
        joint.world.step(DT)
        gained = (b.mass * (b.velocity.x - before[0]), b.mass * (b.velocity.y - before[1]))
        assert tuple(joint.impulse) == pytest.approx(gained, abs=1e-12)
        assert tuple(joint.force) == pytest.approx((gained[0] / DT, gained[1] / DT), abs=1e-10)


def test_joints_of_all_kinds_are_listed_in_the_order_of_creation() -> None:
    world = world_of_joints()
    a, b = two_free(world)
    joints = [MAKERS[kind](world, a, b) for kind in MAKERS]
    assert world.joints == joints
    assert [joint.kind for joint in world.joints] == list(MAKERS)
    joints[2].destroy()
    late = MAKERS["weld"](world, a, b)
    assert world.joints == [*joints[:2], *joints[3:], late]
    assert [type(joint) for joint in world.joints] == [type(joint) for joint in [*joints[:2], *joints[3:], late]]
