"""Falling asleep and waking: who, when, and that nothing else does."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Body, Box, Circle, Segment, World
from tests.engine.worlds import DT, floor, run, tables_of
from tests.naive import islands

FAR = 30.0  # where the other stack stands [m]


def stacks(**settings: Any) -> World:
    """Floor, kinematic shelf; a stack of three boxes on a static block, and another, far away, on the floor."""
    world = World(**settings)
    floor(world)
    world.create_body(Box(3, 1), position=(0, 0.5), kind="static", friction=0.6)
    for x, y in ((0.0, 1.5), (FAR, 0.5)):
        for k in range(3):
            world.create_body(Box(1, 1), position=(x, y + k), friction=0.6)
    world.create_body(Box(2, 0.5), position=(-20, 3), kind="kinematic")
    return world


NEAR, OTHER = slice(2, 5), slice(5, 8)
BLOCK, LOWEST, MIDDLE, TOP, SHELF = 1, 2, 3, 4, 8


def asleep(**settings: Any) -> World:
    """The same, when all of it sleeps."""
    world = run(stacks(**settings), 120)
    assert world.asleep.tolist() == [False, False] + [True] * 6 + [False]
    assert world.awake_count == 0
    return world


# --- falling asleep -------------------------------------------------------------------------------------------------


def test_a_body_falls_asleep_when_it_has_been_still_long_enough() -> None:
    world = World(gravity=(0, 0), sleep_time=0.5, sleep_speed=0.05)
    still = world.create_body(Circle(0.5), velocity=(0.049, 0))
    faster = world.create_body(Circle(0.5), position=(5, 0), velocity=(0.051, 0))
    run(world, 31, 1 / 64)  # 32 steps are 0.5 s, and the next one finds it so
    assert still.velocity.x > 0
    run(world, 1, 1 / 64)
    assert still.awake
    run(world, 1, 1 / 64)
    assert not still.awake
    assert still.velocity == (0, 0)
    assert still.position.x == pytest.approx(0.049 * 0.5, rel=1e-5)
    assert faster.awake
    run(world, 200)
    assert faster.awake


@pytest.mark.parametrize(("spin", "sleeps"), [(0.98, True), (1.02, False)])
def test_spin_counts_as_the_mean_square_of_what_it_moves(spin: float, sleeps: bool) -> None:
    world = World(gravity=(0, 0))
    rod = world.create_body(Box(6, 0.2))
    reach = math.sqrt(rod.inertia / rod.mass)  # radius of gyration
    rod.angular_velocity = spin * world.sleep_speed / reach
    run(world, 60)
    assert rod.awake != sleeps


def test_what_is_pushed_out_of_another_has_no_speed_but_is_not_still() -> None:
    world = World(gravity=(0, 0), push_out_speed=0.2)
    floor(world)
    ball = world.create_body(Circle(1.0), position=(0, 0.2))
    for _ in range(120):
        world.step(DT)
        assert ball.awake
        assert abs(ball.velocity.y) < 1e-5
    run(world, 400)
    assert not ball.awake
    assert ball.position.y > 0.98


def test_sleeping_can_be_switched_off_and_a_body_excused() -> None:
    world = run(stacks(sleeping=False), 120)
    assert not world.asleep.any()
    world = stacks()
    world.bodies[TOP].can_sleep = False
    run(world, 120)
    assert not world.asleep[NEAR].any(), "what hangs together sleeps together"
    assert world.asleep[OTHER].all()
    world.bodies[TOP].can_sleep = True
    run(world, 60)
    assert world.asleep[NEAR].all()
    world.bodies[TOP].can_sleep = False
    assert not world.asleep[NEAR].any(), "at once"
    assert world.asleep[OTHER].all()


def test_the_other_solver_knows_no_sleep() -> None:
    world = run(stacks(solver="sequential_impulses"), 120)
    assert not world.asleep.any()
    world = asleep()
    world.solver = "sequential_impulses"
    assert not world.asleep.any()
    run(world, 120)
    assert not world.asleep.any()


def drag_in_wind(world: World) -> None:
    world.bodies[TOP].drag = 0.01
    world.wind = (0.01, 0)


def magnet(world: World) -> None:
    world.bodies[TOP].magnet = 1e-3
    world.bodies[0].magnet = 1e-3


def attraction(world: World) -> None:
    world.bodies[0].attraction = 1e-6


def belt(world: World) -> None:
    world.bodies[BLOCK].shapes[0].tangent_speed = 1e-4


def fluid(world: World) -> None:
    world.create_fluid((-1, 3), (1, 5), density=0.001)


def motor(world: World) -> None:
    world.create_joint_revolute(
        world.bodies[SHELF], world.bodies[TOP], anchor=(0, 3.5), motor_speed=1e-4, max_motor_torque=1.0
    )


def turning_table(world: World) -> None:
    shelf = world.create_body(Box(2, 1), position=(0.0, 5.0), kind="kinematic", velocity=(0, -0.005))
    shelf.position = (0.0, 4.503)


def joined_to_what_moves(world: World) -> None:
    world.create_joint_revolute(world.bodies[SHELF], world.bodies[TOP], anchor=(0, 3.5), softness=10.0)
    world.bodies[SHELF].velocity = (1e-4, 0)


@pytest.mark.parametrize(
    "act", [drag_in_wind, magnet, attraction, belt, fluid, motor, turning_table, joined_to_what_moves]
)
def test_what_something_acts_on_does_not_sleep(act: Callable[[World], None]) -> None:
    world = stacks()
    act(world)
    run(world, 150)
    assert not world.asleep[NEAR].any()
    assert world.asleep[OTHER].all() == (act is not attraction), "that acts on all"


@pytest.mark.parametrize("act", [drag_in_wind, magnet, attraction, belt, fluid, motor, turning_table])
def test_what_sleeps_wakes_when_something_begins_to_act(act: Callable[[World], None]) -> None:
    world = asleep()
    act(world)
    run(world, 3)
    assert not world.asleep[NEAR].any()
    assert world.asleep[OTHER].all() == (act not in (attraction, drag_in_wind)), "wind is a setting: all wake"


def test_support_that_goes_away_is_no_sleep() -> None:
    # the moment before it would fall asleep
    for away in (lambda body: body.destroy(), lambda body: setattr(body, "position", (50, 50))):
        for steps in range(29, 33):
            world = World()
            shelf = world.create_body(Box(4, 0.5), kind="static")
            carrier = world.create_body(Box(1, 1), position=(0, 0.75))
            ball = world.create_body(Circle(0.2), position=(0, 1.445))
            run(world, steps)
            away(carrier if steps % 2 else shelf)
            run(world, 20)
            assert ball.velocity.y < -1.0, f"after {steps} steps"


def test_what_parts_has_not_been_still() -> None:
    for steps in range(28, 32):
        world = World(gravity=(0, 0))
        one, other = (world.create_body(Box(1, 1), position=(0, y)) for y in (0.0, 1.005))
        run(world, steps)
        one.velocity = (0, -1)  # no more than 17 mm: they are still a pair, which nobody looks at from outside
        run(world, 3)
        assert not islands.links(world)
        assert other.awake
        run(world, 24)
        assert other.awake
        run(world, 5)
        assert not other.awake


# --- nothing moves, nothing is done ---------------------------------------------------------------------------------


def test_what_sleeps_does_not_creep() -> None:
    # on a slope, which friction alone holds
    world = World()
    world.create_body(Segment((-20, -6), (20, 6)), kind="static", friction=0.8)
    for k in range(4):
        x = 3 * k - 5
        world.create_body(Box(1, 0.5), position=(x, 0.3 * x + 0.28), angle=math.atan(0.3), friction=0.8)
    while world.awake_count:
        assert world.step_count < 300
        world.step(DT)
    before, contacts = tables_of(world), world.contact_records().tobytes()
    world.run(10_000, DT)
    run(world, 100)
    after = tables_of(world)
    for name in ("bodies.bodies", "bodies.motions", "contacts"):
        assert after[name] == before[name]
    assert world.contact_records().tobytes() == contacts, "they still tell the weight that they carry"
    assert world.step_count == 10_100 + int(np.frombuffer(before["step_count"], np.int64)[0])
    assert not world.velocities.any()


def test_a_step_walks_along_nothing_that_sleeps() -> None:
    world = stacks()
    world.create_joint_revolute(world.bodies[TOP], world.bodies[MIDDLE], anchor=(0, 3))
    run(world, 120)
    state = world._state
    assert state.dormant
    assert state.joint_layout.stages == 0
    ball = world.create_body(Circle(0.5), position=(10, 0.5))
    run(world, 3)
    assert not state.dormant
    rows = {int(row) for row in np.flatnonzero(state.bodies.columns["asleep"])}
    assert rows == {2, 3, 4, 5, 6, 7}
    nobody = len(state.bodies.tables["bodies"]) - 1
    for lanes in (state.awake_order, state.moving, state.dynamic, state.body_lanes):
        assert not rows & set(lanes.tolist())
    assert state.dynamic.tolist() == [ball._row]
    assert set(state.dynamic_lanes.tolist()) == {ball._row, nobody}
    assert len(state.watched) == 1, "ball and floor"
    assert [number for _, _, number in state.meetings] == [1]
    slots = state.layout.slots
    assert slots[slots != state.arbiters.nothing].tolist() == state.watched.tolist()
    shapes = {int(rank) for _, group in state.awake_plan for rank in group["rank"].ravel()}
    assert shapes == {0, 1, 8, 9}


def test_energy_does_not_grow_by_it() -> None:
    world = stacks()
    world.create_body(Box(1, 1), position=(0.3, 4.6), friction=0.6)  # it lands on the near stack
    highest = math.inf
    for step in range(200):
        world.step(DT)
        if step > 40:
            energy = world.diagnostics().energy
            assert energy <= highest + 1e-6
            highest = min(highest, energy)
        if step % 50 == 49:
            for body in world.bodies:
                body.awake = True


# --- waking, one by one ---------------------------------------------------------------------------------------------


def set_to(name: str, value: Any, index: int = TOP) -> Callable[[World], None]:
    return lambda world: setattr(world.bodies[index], name, value)


def moved_by(index: int, way: float) -> Callable[[World], None]:
    def act(world: World) -> None:
        x, y = world.bodies[index].position
        world.bodies[index].position = (x + way, y)

    return act


AT_ONCE: dict[str, Callable[[World], None]] = {
    "awake": set_to("awake", True),
    "a force": lambda world: world.bodies[TOP].apply_force((1, 0)),
    "a force set": set_to("force", (1, 0)),
    "a torque": set_to("torque", 1.0),
    "an impulse": lambda world: world.bodies[TOP].apply_impulse((0.01, 0)),
    "a velocity": set_to("velocity", (0.01, 0)),
    "a spin": set_to("angular_velocity", 0.01),
    "a position": moved_by(TOP, 0.01),
    "an angle": set_to("angle", 0.01),
    "fixed rotation": set_to("fixed_rotation", True),
    "friction": set_to("friction", 0.1),
    "a property of a shape": lambda world: setattr(world.bodies[TOP].shapes[0], "restitution", 0.1),
    "a property of the body": set_to("linear_damping", 0.1),
    "filters": lambda world: setattr(world.bodies[TOP].shapes[0], "mask", 1),
    "a shape more": lambda world: world.bodies[TOP].add_shape(Circle(0.2), offset=(0, 0.6)) and None,
    "a joint": lambda world: world.create_joint_revolute(world.bodies[0], world.bodies[TOP], anchor=(0, 4)) and None,
    "an explosion": lambda world: world.explode((1.5, 3.5), radius=1.2, impulse=0.5),
    "a fluid": lambda world: world.create_fluid((-1, 3), (1, 5), density=0.1) and None,
    "a neighbour destroyed": lambda world: world.bodies[TOP].destroy(),
    "a neighbour's shape destroyed": lambda world: world.bodies[TOP].shapes[0].destroy(),
    "support destroyed": lambda world: world.bodies[BLOCK].destroy(),
    "support moved": moved_by(BLOCK, 0.001),
    "support turned": set_to("angle", 1e-3, BLOCK),
    "support smoother": set_to("friction", 0.1, BLOCK),
    "support with a shape less": lambda world: world.bodies[BLOCK].shapes[0].destroy(),
}


@pytest.mark.parametrize("name", AT_ONCE)
def test_what_is_done_from_outside_wakes_the_island_at_once_and_no_other(name: str) -> None:
    world = asleep()
    near = world.bodies[NEAR]
    AT_ONCE[name](world)
    assert all(body.awake for body in near if body.alive)
    assert world.asleep.sum() == 3
    assert world.asleep[np.isin([body.serial for body in world.bodies], (5, 6, 7))].all()
    world.step(DT)
    assert all(body.awake for body in near if body.alive)
    assert world.asleep.sum() == 3, "far away all sleeps on"
    assert world._state.bodies.tables["motions"]["still"][near[0]._row] <= 2 * DT, "its time begins anew"


def test_a_joint_that_goes_wakes_its_bodies() -> None:
    for end in ("joint", "body"):
        world = stacks()
        shelf = world.bodies[SHELF]
        joint = world.create_joint_revolute(shelf, world.bodies[TOP], anchor=(0, 4), softness=1.0)
        run(world, 150)
        assert world.asleep[2:8].all()
        (joint if end == "joint" else shelf).destroy()
        assert not world.asleep[NEAR].any()
        assert world.asleep[OTHER].all()


def test_touch_wakes_in_the_same_step() -> None:
    world = asleep()
    ball = world.create_body(Circle(0.25), position=(-2.0, 3.4), velocity=(6, 0))
    number = world.bodies.index(ball)
    met = False
    while not met:
        assert world.asleep[2:8].all()
        before = world.positions[TOP].copy()
        world.step(DT)
        met = any(number in pair for pair in islands.links(world))
        assert world.step_count < 200
    assert not world.asleep[NEAR].any(), "not only what it touches"
    assert world.asleep[OTHER].all()
    run(world, 3)
    assert world.positions[TOP][0] > before[0]
    assert world.bodies[TOP].velocity.x > 0.1


@pytest.mark.parametrize("kind", ["static", "kinematic", "dynamic"])
def test_what_is_created_on_it_wakes_it(kind: str) -> None:
    world = asleep()
    world.create_body(Box(0.5, 0.5), position=(0.5, 4.0), kind=kind)
    world.step(DT)
    assert not world.asleep[NEAR].any()
    assert world.asleep[OTHER].all()


@pytest.mark.parametrize("index", [BLOCK, SHELF])
def test_what_is_put_on_it_wakes_it(index: int) -> None:
    world = asleep()
    world.bodies[index].position = (FAR + 1.4, 0.5)
    world.step(DT)
    assert not world.asleep[OTHER].any()
    assert world.asleep[NEAR].all() == (index == SHELF), "the block has gone"


def test_a_kinematic_body_wakes_what_it_comes_to() -> None:
    world = asleep()
    shelf = world.bodies[SHELF]
    shelf.velocity = (10, 0)
    for _ in range(120):
        world.step(DT)
        if not world.asleep[NEAR].any():
            break
        assert shelf.position.x + 1 < -0.4, "not before"
    assert not world.asleep[NEAR].any()
    assert shelf.position.x + 1 > -0.8
    assert world.asleep[OTHER].all()


@pytest.mark.parametrize(
    "change", [{"gravity": (0, -9)}, {"substeps": 8}, {"wind": (1, 0)}, {"sleep_time": 1.0}, {"sleeping": False}]
)
def test_a_changed_setting_wakes_all(change: dict[str, Any]) -> None:
    world = asleep()
    world.set(**{name: getattr(world, name) for name in change})
    assert world.awake_count == 0, "unless it stays as it was"
    world.broad_phase = "all_pairs"
    assert world.awake_count == 0, "nor does what finds pairs matter"
    world.set(**change)
    assert world.awake_count == 6


def test_awake_can_be_set() -> None:
    world = stacks()
    run(world, 5)
    world.bodies[MIDDLE].awake = False
    assert world.bodies[MIDDLE].awake
    world.step(DT)
    assert world.asleep[NEAR].all()
    assert not world.asleep[OTHER].any()
    for index in (0, SHELF):
        assert world.bodies[index].awake
        with pytest.raises(ValueError, match="awake = False: must be True: only a dynamic body"):
            world.bodies[index].awake = False
    with pytest.raises(ValueError, match="awake = 1: must be True or False"):
        world.bodies[TOP].awake = 1  # type: ignore[assignment]
    world.sleeping = False
    with pytest.raises(ValueError, match="awake = False: must be True where sleeping is off"):
        world.bodies[TOP].awake = False


def test_what_wakes_goes_on_as_if_it_had_never_slept() -> None:
    # a ball hits a stack that sleeps, and one that does not, with the same impulses: the same but for what stillness
    # took away
    def hit(sleeping: bool) -> tuple[np.ndarray, float]:
        world = run(stacks(sleeping=sleeping), 240)
        world.create_body(Circle(0.4), position=(-3.0, 2.6), velocity=(8, 0), density=2)
        run(world, 40)
        return world.positions[:8], float(np.abs(world.velocities).max())

    (slept, fast), (awake, _) = hit(True), hit(False)
    assert fast > 0.5
    assert np.abs(slept - awake).max() < 1e-3


def test_another_time_step_while_it_sleeps() -> None:
    # kept impulses are of a whole step: they follow, so that the stack wakes as heavy as it was
    world = asleep(stiffness="fixed")
    run(world, 10, DT / 4)
    world.bodies[TOP].awake = True
    for _ in range(10):
        world.step(DT / 4)
        print(np.abs(world.velocities).max())
        assert np.abs(world.velocities).max() < 2e-3


# --- the same bits, whatever the way --------------------------------------------------------------------------------


def story(world: World, go: Callable[[World, int], None]) -> list[str]:
    """Boxes fall in heaps, sleep, are hit, sleep again; hashes on the way."""
    rng = np.random.default_rng(7)
    floor(world)
    for k in range(18):
        shape = Circle(0.3) if k % 4 == 0 else Box(0.6, 0.4)
        world.create_body(shape, position=(8 * (k % 3) + rng.uniform(-0.4, 0.4), 0.4 + 0.5 * (k // 3)), friction=0.7)
    world.create_joint_revolute(world.bodies[1], world.bodies[4], anchor=(0, 1))
    hashes = []
    for part in range(6):
        go(world, 60)
        hashes.append(world.state_hash() + str(world.asleep.sum()))
        if part == 3:
            world.create_body(Circle(0.4), position=(4, 1.2), velocity=(9, 0), density=4)
    return hashes


def test_run_is_step_and_threads_and_lanes_do_not_show() -> None:
    expected = story(World(), lambda world, steps: run(world, steps) and None)
    assert any(text[64:] not in ("0", "18") for text in expected), "some sleep and some do not"
    assert story(World(), lambda world, steps: world.run(steps, DT)) == expected
    assert story(World(broad_phase="all_pairs"), lambda world, steps: world.run(steps, DT)) == expected
    single = World()
    single._state.lanes = 1
    assert story(single, lambda world, steps: world.run(steps, DT)) == expected


def test_threads_do_not_show() -> None:
    def heaps(threads: int) -> list[str]:
        world = World(threads=threads)
        floor(world)
        where = np.arange(600)
        places = np.column_stack([1.5 * (where % 200) - 150, 0.4 + 0.5 * (where // 200)])
        world.create_bodies(Box(0.6, 0.5), positions=places, friction=0.7)
        world.create_body(Circle(1.0), position=(-170, 1.0), velocity=(15, 0), density=3, friction=0.5)
        found = []
        for _ in range(4):
            run(world, 20)
            found.append(world.state_hash())
        assert 0 < world.awake_count < 600
        return found

    assert heaps(1) == heaps(2)


def test_a_restored_snapshot_goes_on_with_who_sleeps() -> None:
    world = asleep()
    world.create_body(Circle(0.25), position=(-2.0, 3.4), velocity=(6, 0))
    run(world, 3)
    assert world.asleep.sum() == 6
    world.bodies[BLOCK].position = (FAR + 1.5, 0.5)  # nobody has looked yet what it touches
    for _ in range(2):
        snapshot = type(world.snapshot()).from_bytes(world.snapshot().to_bytes())
        other = World()
        other.restore(snapshot)
        assert other.asleep.tolist() == world.asleep.tolist()
        for _ in range(60):
            assert other.state_hash() == world.state_hash()
            assert other.asleep.tolist() == world.asleep.tolist()
            run(world, 1)
            run(other, 1)
        run(world, 60)


def test_the_hash_tells_who_sleeps() -> None:
    world, other = asleep(), asleep()
    assert world.state_hash() == other.state_hash()
    other.bodies[TOP].awake = True
    assert world.state_hash() != other.state_hash()


# --- islands --------------------------------------------------------------------------------------------------------


def test_an_island_is_split_when_a_part_of_it_may_sleep() -> None:
    world = World()
    floor(world)
    left, right = (world.create_body(Box(1, 1), position=(x, 0.5), friction=0.6) for x in (-1.2, 1.2))
    plank = world.create_body(Box(3.4, 0.2), position=(0, 1.1), friction=0.6)
    run(world, 20)
    assert world.islands.tolist() == [0, 1, 1, 1]
    plank.apply_impulse((0, 8 * plank.mass))  # up, and down again
    run(world, 36)  # they have not been still before it left them
    assert [body.awake for body in (left, right, plank)] == [False, False, True]
    run(world, 200)
    assert world.islands.tolist() == [0, 1, 1, 1], "it lies on both again"
    assert world.awake_count == 0


@st.composite
def scenes(draw: st.DrawFn) -> World:
    """Bodies on a floor, near enough to touch, some joined, some heavy."""
    world = World(sleep_time=draw(st.sampled_from([0.1, 0.3])), sleep_speed=draw(st.sampled_from([0.05, 0.5])))
    floor(world)
    for k in range(draw(st.integers(2, 9))):
        shape = draw(st.sampled_from([Box(1, 1), Box(2, 0.4), Circle(0.5)]))
        x, y = draw(st.integers(-3, 3)), draw(st.sampled_from([0.5, 1.0, 1.5, 3.0]))
        kind = draw(st.sampled_from(["dynamic"] * 6 + ["static", "kinematic"]))
        world.create_body(shape, position=(1.02 * x + 0.01 * k, y), kind=kind, friction=0.6)
    moving = [body for body in world.bodies if body.kind == "dynamic"]
    for one, other in zip(moving, moving[2:], strict=False):
        if draw(st.integers(0, 3)) == 0:
            world.create_joint_revolute(one, other, anchor=one.position)
    return world


def disturb(world: World, draw: Callable[[st.SearchStrategy[Any]], Any]) -> None:
    """Does something to some body."""
    body: Body = draw(st.sampled_from(world.bodies[1:] or world.bodies))
    what = draw(st.integers(0, 6))
    if what == 0 and world.body_count > 2:
        body.destroy()
    elif what == 1 and body.kind == "dynamic":
        body.apply_impulse((0.5 * body.mass, 1.0 * body.mass))
    elif what == 2:
        body.position = (body.position.x + 0.5, body.position.y)
    elif what == 3:
        world.create_body(Circle(0.3), position=(draw(st.integers(-3, 3)), 2.5))
    elif what == 4 and body.kind == "kinematic":
        body.velocity = draw(st.sampled_from([(0.3, 0), (0, 0)]))
    elif what == 5:
        body.awake = True


@settings(max_examples=40)
@given(data=st.data())
def test_what_touches_sleeps_together_and_islands_are_what_hangs_together(data: st.DataObject) -> None:
    world = data.draw(scenes())
    for _ in range(4):
        for _ in range(12):
            world.step(DT)
            sleeping = world.asleep
            assert not world.velocities[sleeping].any()
            for a, b in islands.links(world):
                assert sleeping[a] == sleeping[b], f"step {world.step_count}: {a} and {b}"
        if data.draw(st.booleans()):
            assert world.islands.tolist() == islands.names(world)
        disturb(world, data.draw)
    restored = World()
    restored.restore(world.snapshot())
    run(restored, 10)
    world.run(10, DT)
    assert restored.state_hash() == world.state_hash()
    assert world.islands.tolist() == islands.names(world) == restored.islands.tolist()
