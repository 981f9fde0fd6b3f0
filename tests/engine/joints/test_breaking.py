"""Joints break for good beyond a force or a torque, in the step that brought it, and not below."""

from __future__ import annotations

import pytest

from engine import SOLVERS, Box, Circle, Snapshot, World
from tests.engine.joints.making import GRAVITY, HOLDING, MAKERS, all_joints, world_of_joints
from tests.engine.worlds import DT, run

MASS = 2.0


def hanging(kind: str, **more):
    """A ball at rest below what holds it: its weight is the force."""
    world = world_of_joints(gravity=(0, -GRAVITY))
    top = world.create_body(kind="static")
    ball = world.create_body(Circle(0.2), position=(0, -1), mass=MASS)
    places = {
        "distance": {"anchor1": (0, 0), "anchor2": (0, -1)},
        "mouse": {"target": (0, -1), "anchor": None, "hertz": None},
        "motor": {"max_force": None, "max_torque": None},
        "wheel": {"axis": (1, 0)},
        "prismatic": {"axis": (1, 0), "anchor": (0, -1)},
    }.get(kind, {"anchor": (0, -1)})
    return MAKERS[kind](world, top, ball, **places, **more)


@pytest.mark.parametrize("kind", HOLDING)
def test_it_bears_the_weight_and_breaks_under_more(kind: str) -> None:
    joint = hanging(kind, break_force=1.05 * MASS * GRAVITY)
    assert joint.break_force == pytest.approx(1.05 * MASS * GRAVITY)
    world, ball = joint.world, joint.body2
    run(world, 60)
    assert joint.alive
    assert joint.force.y == pytest.approx(MASS * GRAVITY, rel=1e-3)
    joint.break_force = 0.95 * MASS * GRAVITY
    world.step(DT)
    assert not joint.alive
    assert world.joint_count == 0
    height, speed = ball.position.y, ball.velocity.y
    run(world, 30)
    assert ball.velocity.y == pytest.approx(speed - GRAVITY * 30 * DT, rel=1e-9), "it falls"
    assert ball.position.y < height


@pytest.mark.parametrize("kind", ["weld", "prismatic", "motor"])
def test_a_torque_breaks_it(kind: str) -> None:
    for most, breaks in ((6.3, False), (5.7, True)):
        world = world_of_joints(gravity=(0, 0))
        wall = world.create_body(kind="static")
        beam = world.create_body(Box(1, 0.5), mass=2)
        places = {"max_force": None, "max_torque": None} if kind == "motor" else {"anchor": (0, 0)}
        joint = MAKERS[kind](world, wall, beam, **places, break_torque=most)
        for _ in range(30):
            beam.torque = 6.0
            world.step(DT)
        assert joint.alive is not breaks
        if not breaks:
            assert joint.torque == pytest.approx(-6.0, rel=1e-3)
            assert (joint.break_torque, joint.break_force) == (most, None)


@pytest.mark.parametrize(("part", "sign"), [("motor", 1), ("lower", 1), ("upper", -1), ("hertz", -1)])
def test_torques_of_motor_limits_and_spring_break_it(part: str, sign: int) -> None:
    more = {
        "motor": {"motor_speed": 100.0, "max_motor_torque": 6.0},
        "lower": {"lower": 0.0},
        "upper": {"upper": 0.0},
        "hertz": {"hertz": 5.0},
    }[part]
    for most, breaks in ((6.6, False), (5.4, True)):
        world = world_of_joints(gravity=(0, 0))
        wall = world.create_body(kind="static")
        disc = world.create_body(Circle(0.5), mass=2)
        joint = world.create_joint_revolute(wall, disc, anchor=(0, 0), break_torque=most, **more)
        for k in range(20 if part == "motor" else 90):
            if part != "motor":
                disc.torque = -sign * min(6.0, 0.1 * k)
            world.step(DT)
        assert joint.alive is not breaks


def test_a_torque_does_not_break_what_has_a_largest_force_only() -> None:
    world = world_of_joints(gravity=(0, 0))
    wall = world.create_body(kind="static")
    beam = world.create_body(Box(1, 0.5), mass=2)
    joint = world.create_joint_weld(wall, beam, anchor=(0, 0), break_force=1.0)
    for _ in range(30):
        beam.torque = 50.0
        world.step(DT)
    assert joint.alive


def test_a_bridge_breaks_where_the_load_is() -> None:
    # two pins carry a plank; the heavier loaded one breaks, the other holds and the plank swings on it
    world = world_of_joints(gravity=(0, -GRAVITY))
    wall = world.create_body(kind="static")
    plank = world.create_body(Box(2, 0.1), mass=1)
    pins = [world.create_joint_revolute(wall, plank, anchor=(x, 0), break_force=20.0) for x in (-1.0, 1.0)]
    load = world.create_body(Circle(0.2), position=(0.8, 0.25), mass=2)
    world.create_joint_weld(plank, load, anchor=(0.8, 0.1))
    run(world, 60)
    # moments about the left pin: 5 + 20 * 1.8 / 2 = 23 N on the right one, 7 N on the left
    assert [pin.alive for pin in pins] == [True, False]


def test_several_break_in_the_same_step_and_others_stay() -> None:
    world = world_of_joints(gravity=(0, -GRAVITY))
    top = world.create_body(kind="static")
    joints = []
    for k in range(6):
        ball = world.create_body(Circle(0.2), position=(k, -1), mass=2)
        joints.append(world.create_joint_revolute(top, ball, anchor=(k, -1), break_force=19.0 if k % 2 else None))
    run(world, 30)
    assert [joint.alive for joint in joints] == [True, False] * 3
    assert world.joints == joints[::2]


def test_in_a_run_it_breaks_in_the_same_step() -> None:
    def swinging() -> World:
        world = world_of_joints(gravity=(0, -GRAVITY))
        top = world.create_body(kind="static")
        ball = world.create_body(Circle(0.2), position=(1, 0), mass=2)
        world.create_joint_distance(top, ball, anchor1=(0, 0), anchor2=(1, 0), break_force=50.0)  # 3 m g below
        return world

    stepped, ran = swinging(), swinging()
    run(stepped, 60)
    ran.run(60, DT)
    assert stepped.joint_count == 0
    assert stepped.state_hash() == ran.state_hash()


def test_it_does_not_break_in_a_step_of_no_time() -> None:
    joint = hanging("revolute", break_force=0.0)
    joint.world.step(0.0)
    assert joint.alive
    joint.world.step(DT)
    assert not joint.alive, "a largest force of 0 is none"


def test_a_snapshot_holds_how_much_it_bears() -> None:
    joint = hanging("weld", break_force=21.0, break_torque=5.0)
    run(joint.world, 10)
    other = all_joints(World(precision="double"))
    other.restore(Snapshot.from_bytes(joint.world.snapshot().to_bytes()))
    again = other.joints[0]
    assert (again.break_force, again.break_torque) == (21.0, 5.0)
    again.break_force = None
    assert again.break_force is None


def test_taken_back_a_broken_joint_holds_again() -> None:
    joint = hanging("revolute", break_force=25.0)
    world = joint.world
    run(world, 20)
    kept = world.snapshot()
    world.joints[0].break_force = 1.0
    world.step(DT)
    assert world.joint_count == 0
    world.restore(kept)
    assert world.joint_count == 1
    run(world, 20)
    assert world.joint_count == 1


@pytest.mark.parametrize("solver", SOLVERS)
def test_with_either_solver(solver: str) -> None:
    for most, breaks in ((21.0, False), (19.0, True)):
        world = World(solver=solver, precision="double")
        top = world.create_body(kind="static")
        ball = world.create_body(Circle(0.2), position=(0, -1), mass=2)
        joint = world.create_joint_revolute(top, ball, anchor=(0, -1), break_force=most)
        run(world, 20)
        assert joint.alive is not breaks


def test_the_effect_is_called_for_only_by_what_may_break() -> None:
    joint = hanging("revolute")
    assert "breaking joints" not in {effect.name for effect in joint.world.effects if effect.called_for}
    joint.break_torque = 3.0
    assert "breaking joints" in {effect.name for effect in joint.world.effects if effect.called_for}
    joint.break_torque = None
    assert "breaking joints" not in {effect.name for effect in joint.world.effects if effect.called_for}
