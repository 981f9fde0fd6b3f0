"""What is changed of a joint, or of the time step, holds from the next step on, as in a world restored from then."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from engine import Box, World
from engine.solvers.soft_step.direct.work import STIFFNESS
from tests.engine.joints.making import GRAVITY, MAKERS, all_joints, two_free
from tests.engine.joints.test_chains import chain, solved_at_once, stretch
from tests.engine.worlds import DT, run


def cantilever(count: int = 20) -> World:
    """Welded bodies that stick out from a wall."""
    world = World(precision="double", gravity=(0, -GRAVITY), sleeping=False)
    last = world.create_body(kind="static")
    for k in range(count):
        body = world.create_body(Box(1, 0.5), position=(k + 0.5, 0))
        world.create_joint_weld(last, body, anchor=(k, 0), collide_connected=False)
        last = body
    return world


def heavy_chain() -> World:
    return chain(precision="double", sleeping=False)


CHANGES: dict[str, tuple[Callable[[], World], Callable[[World], object], int]] = {
    "softness": (heavy_chain, lambda world: setattr(world.joints[5], "softness", 0.01), 15),
    "bias_factor": (heavy_chain, lambda world: setattr(world.joints[5], "bias_factor", 0.05), 15),
    "linear_hertz": (cantilever, lambda world: setattr(world.joints[0], "linear_hertz", 1.0), 19),
    "angular_hertz": (cantilever, lambda world: setattr(world.joints[0], "angular_hertz", 1.0), 19),
    "gravity": (heavy_chain, lambda world: world.set(gravity=(0.0, 0.0)), 21),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_chain_follows_what_its_joints_are_made_of(change: str) -> None:
    make, apply, expected = CHANGES[change]
    world = run(make(), 10)
    assert solved_at_once(world) >= 20
    apply(world)
    again = World(precision="double")
    again.restore(world.snapshot())
    run(world, 10), run(again, 10)
    assert world.state_hash() == again.state_hash()
    assert solved_at_once(world) == expected


def test_a_chain_follows_the_time_step() -> None:
    """At a thousand steps a second the joints are stiff enough by themselves; at sixty they are not."""
    world = heavy_chain()
    world.run(10, 1 / 1000)
    assert world._state.chains is None
    assert solved_at_once(world) == 21
    again = World(precision="double")
    again.restore(world.snapshot())
    for step in (DT, 1.1 * DT, 0.8 * DT, DT / 4, DT):
        world.step(step), again.step(step)
        assert world.state_hash() == again.state_hash()
    assert stretch(run(world, 120)) < 1e-3


def test_a_time_step_that_wavers_calls_for_no_new_plan() -> None:
    world = heavy_chain()
    run(world, 1)
    plan = world._state.chains
    for factor in (1.2, 0.8, 1.3, 1.0):
        world.step(factor * DT)
        assert world._state.chains is plan


def driven_bar(torque: float, **settings) -> World:
    """A bar of 70 g, half a metre long, that a motor would turn, but that is hinged to the ground at both its ends."""
    world = World(precision="double", gravity=(0, 0), sleeping=False, **settings)
    ground = world.create_body(kind="static")
    bar = world.create_body(Box(0.5, 0.05), position=(0.25, 0), mass=0.07)
    world.create_joint_revolute(ground, bar, anchor=(0, 0), motor_speed=3.0, max_motor_torque=torque)
    world.create_joint_revolute(ground, bar, anchor=(0.5, 0))
    return world


def test_motors_are_loads() -> None:
    """5 N m over half a metre is 10 N at each end: visited one by one the hinges of so light a bar give way."""
    world = driven_bar(5.0)
    assert solved_at_once(world) == 2
    run(world, 60)
    ease = 1 / 0.07 + 0.25**2 / world.bodies[1].inertia  # what an impulse changes of a hinge's rate [1/kg]
    assert stretch(world) == pytest.approx(10.0 * ease / (STIFFNESS * 4 / DT) ** 2, rel=1e-3)
    assert [joint.force.y for joint in world.joints] == pytest.approx([10.0, -10.0], rel=1e-3)
    assert stretch(run(driven_bar(5.0, joint_solving="iterated"), 60)) > 1e-3


def test_a_chain_follows_the_strength_of_its_motors() -> None:
    world = driven_bar(0.01)
    assert solved_at_once(world) == 0
    for torque, expected in ((5.0, 2), (0.02, 0), (6.0, 2), (7.0, 2)):
        plan = world._state.chains
        world.joints[0].max_motor_torque = torque
        again = World(precision="double")
        again.restore(world.snapshot())
        assert solved_at_once(world) == solved_at_once(again) == expected
        run(world, 5), run(again, 5)
        assert world.state_hash() == again.state_hash()
    assert world._state.chains is plan, "a strength that hardly changes calls for no new plan"


def test_what_is_whirled_without_gravity_holds() -> None:
    """v^2 / r takes the place of gravity: 15^2 / 23 m, with 1000 times a link's mass at the end."""
    world = chain(precision="double", gravity=(0, 0), sleeping=False)
    for body in world.bodies[1:]:
        body.velocity = (-15.0 * body.position.y / 22.0, 0.0)
        body.angular_velocity = 15.0 / 22.0
    widest = 0.0
    for _ in range(120):
        world.step(DT)
        widest = max(widest, stretch(world))
    assert widest < 5e-3


@pytest.mark.parametrize("kind", ["revolute", "distance", "prismatic", "weld"])
def test_what_sleeps_tells_the_same_force_at_any_time_step(kind: str) -> None:
    """And does not break for it."""
    world = all_joints(World(gravity=(0, -GRAVITY)))
    ground = world.create_body(kind="static")
    weight = world.create_body(Box(0.5, 0.5), position=(0, -1), mass=1.0)
    world.create_body(Box(1, 1), position=(50, 0), gravity_scale=0.0, velocity=(1, 0))  # awake
    more = {"distance": {"anchor1": (0, 0), "anchor2": (0, -1)}, "prismatic": {"axis": (1, 0), "lower": 0, "upper": 0}}
    where = {} if kind == "distance" else {"anchor": (0, 0)}
    make = getattr(world, f"create_joint_{kind}")
    joint = make(ground, weight, **where, **more.get(kind, {}), break_force=1.5 * GRAVITY)
    run(world, 120)
    assert world.asleep.tolist() == [False, True, False]
    for dt in (DT / 4, 2 * DT, DT):
        world.step(dt)
        assert joint.alive
        assert world.asleep[1]
        assert joint.force.y == pytest.approx(GRAVITY, rel=1e-3)


@pytest.mark.parametrize("kind", ["weld", "motor", "revolute", "prismatic"])
@pytest.mark.parametrize("hertz", [60.0, 120.0, 1e4])
def test_springs_faster_than_the_substeps_stay_finite_and_lose_energy(kind: str, hertz: float) -> None:
    """Three bodies in a row, each held by such a spring, with and without a damper of its own."""
    for ratio in (0.0, 1.0):
        world = World(gravity=(0, -GRAVITY), sleeping=False)
        last = world.create_body(kind="static")
        spring = {"hertz": hertz, "damping_ratio": ratio}
        if kind in ("weld", "motor"):
            spring = {f"{part}_{name}": value for part in ("linear", "angular") for name, value in spring.items()}
        if kind == "prismatic":
            spring["axis"] = (0, 1)
        for k in range(3):
            body = world.create_body(Box(1, 0.2), position=(k + 0.5, 0), mass=1.0)
            where = {} if kind == "motor" else {"anchor": (k, 0)}
            getattr(world, f"create_joint_{kind}")(last, body, **where, **spring, collide_connected=False)
            last = body
        fastest = 0.0
        for _ in range(300):
            world.step(DT)
            fastest = max(fastest, float(np.abs(world.velocities).max()))
        assert fastest < 1.0
        assert np.abs(world.velocities).max() < 0.1
        assert np.abs(world.positions[1:, 1]).max() < 0.1


@pytest.mark.parametrize("kind", MAKERS)
def test_what_was_destroyed_is_not_told(kind: str) -> None:
    world = World()
    joint = MAKERS[kind](world, *two_free(world))
    joint.destroy()
    names = [
        name for name in ("force", "torque", "impulse", "motor_force", "motor_torque") if hasattr(type(joint), name)
    ]
    for name in names:
        with pytest.raises(ValueError, match="this one was destroyed"):
            getattr(joint, name)


def test_a_refused_limit_is_named_by_what_was_set() -> None:
    world = World()
    rope = MAKERS["distance"](world, *two_free(world), lower=1.0, upper=2.0)
    with pytest.raises(ValueError, match=r"^upper = 0\.5: must be at least lower, which is 1\.0"):
        rope.upper = 0.5
    with pytest.raises(ValueError, match=r"^lower = 3\.0: must be at most upper, which is 2\.0"):
        rope.lower = 3.0
