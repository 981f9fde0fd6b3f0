"""The world: what comes and goes, what it shows of itself, and what a step of nothing does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from engine import BROAD_PHASES, SOLVERS, STAGES, Box, Circle, Polygon, World
from tests.engine.worlds import DT, OF_ANY_SIZE, POINTS, PRECISIONS, busy, fingerprint, floor, gathering, run, tables_of

COLUMNS = {
    "positions": "position",
    "velocities": "velocity",
    "angles": "angle",
    "angular_velocities": "angular_velocity",
}


# --- a step of nothing, and nothing to step ---------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("zero", [0, 0.0, -0.0, np.float32(0)])
def test_a_step_of_zero_changes_nothing(precision: str, zero: float, solver: str) -> None:
    world = run(busy(precision, solver=solver), 50)
    body = world.bodies[1]
    body.force, body.torque = (1, 2), 3
    before, contacts = fingerprint(world), world.contact_records()
    world.step(zero)
    assert fingerprint(world) == before
    assert (body.force, body.torque) == ((1, 2), 3)
    assert np.array_equal(world.contact_records(), contacts)


def test_an_empty_world_steps() -> None:
    world = run(World(), 3)
    assert (world.step_count, world.body_count, world.joint_count) == (3, 0, 0)
    assert world.arbiters == world.bodies == world.joints == []
    assert world.positions.shape == world.velocities.shape == (0, 2)
    assert world.angles.shape == world.angular_velocities.shape == (0,)
    assert len(world.contact_records()) == len(world.joint_records()) == len(world.body_records()) == 0
    assert len(world.shape_records()) == 0
    assert (world.hull_records()["serial"] == -1).all()
    assert world.bounds.shape == (0, 4)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_body_without_shapes_moves_and_meets_nobody(solver: str) -> None:
    world = World(gravity=(0, 0), solver=solver)
    floor(world)
    bare = world.create_body(position=(0, 1), velocity=(0, -3), angular_velocity=1)
    run(world, 60)
    assert tuple(bare.position) == pytest.approx((0, -2), abs=1e-5)
    assert (bare.mass, bare.shapes, world.arbiters) == (0, [], [])
    assert repr(bare).startswith("<Body 1: dynamic without a shape at (0, -2")


def test_time_and_steps_are_counted() -> None:
    world = World()
    for dt in (0.1, 0.25, 1):
        world.step(dt)
    assert world.step_count == 3
    assert world.time == 0.1 + 0.25 + 1


def test_stages_are_timed() -> None:
    world = run(busy(), 1)
    assert list(world.stage_times) == [name for name, _ in STAGES]
    assert all(seconds > 0 for seconds in world.stage_times.values())


# --- columns ----------------------------------------------------------------------------------------------------------


def assert_columns(world: World) -> None:
    for columns, attribute in COLUMNS.items():
        values = getattr(world, columns)
        assert values.dtype == np.float64
        assert values.tolist() == [
            list(value) if isinstance(value, tuple) else value
            for value in (getattr(body, attribute) for body in world.bodies)
        ]
        assert len(values) == world.body_count
        with pytest.raises(ValueError, match="read-only"):
            values[...] = 0


@pytest.mark.parametrize("precision", PRECISIONS)
def test_columns_show_living_bodies_in_the_order_of_creation(precision: str) -> None:
    world = run(busy(precision), 20)
    assert_columns(world)
    world.bodies[2].destroy()
    assert_columns(world)
    world.create_body(Box(1, 1), position=(9, 9))
    assert_columns(world)
    run(world, 5)
    assert_columns(world)
    for _ in range(40):
        world.create_body(Circle(0.1), position=(20, 20))
    assert_columns(world)


def test_positions_are_a_view_until_something_goes() -> None:
    world = busy("double")
    positions, velocities = world.positions, world.velocities
    world.step(DT)
    assert np.array_equal(positions, world.positions)
    assert np.array_equal(velocities, world.velocities)
    world.bodies[2].destroy()
    positions = world.positions
    before = positions.copy()
    world.step(DT)
    assert np.array_equal(positions, before), "gathered, so a copy"


# --- creating and destroying ------------------------------------------------------------------------------------------


def test_a_destroyed_body_takes_its_contacts_and_joints_along() -> None:
    world = World(precision="double")
    ground = floor(world)
    boxes = [world.create_body(Box(1, 1), position=(0, 0.495 + 0.99 * k)) for k in range(3)]
    ball = world.create_body(Circle(0.5), position=(5, 0.495))
    joints = [
        world.create_joint_revolute(boxes[0], boxes[1], anchor=(0, 1)),
        world.create_joint_revolute(ball, ground, anchor=(5, 0)),
        world.create_joint_revolute(boxes[2], boxes[0], anchor=(0, 2)),
    ]
    run(world, 10)
    kept = world.contact_records()
    boxes[0].destroy()
    assert [joint.alive for joint in joints] == [False, True, False]
    assert world.joints == [joints[1]]
    assert world.bodies == [ground, boxes[1], boxes[2], ball]
    records = world.contact_records()
    assert 1 not in {*records["body1"].tolist(), *records["body2"].tolist()}
    kept = kept[(kept["body1"] != 1) & (kept["body2"] != 1)]
    assert np.array_equal(records, kept), "the others keep their impulses"
    assert kept["normal_impulse"].all()
    assert len(kept) > 0
    run(world, 30)
    assert boxes[1].position.y < 1.2, "nothing holds it up"


def test_a_destroyed_body_is_no_obstacle() -> None:
    world = World()
    shelf = world.create_body(Box(4, 0.5), kind="static")
    ball = world.create_body(Circle(0.2), position=(0, 0.44))
    run(world, 30)
    assert ball.position.y > 0.4
    shelf.destroy()
    run(world, 30)
    assert ball.position.y < -0.5


def test_rows_are_used_again_and_the_order_stays_that_of_creation() -> None:
    world = World()
    bodies = [world.create_body(Circle(0.1), position=(k, 0)) for k in range(3)]
    bodies[1].destroy()
    late = world.create_body(Circle(0.1), position=(3, 0))
    assert late._row == 1, "the place of the one that went"
    assert world.bodies == [bodies[0], bodies[2], late]
    assert world.positions[:, 0].tolist() == [0, 2, 3]
    assert [body.serial for body in world.bodies] == [0, 2, 3]
    assert world.body_records()["serial"].tolist() == [0, 2, 3]
    assert not bodies[1].alive
    assert bodies[1] != late
    assert world.find_body(3) == late
    assert world.find_body(1) is None
    assert world.find_body(-1) is None


@pytest.mark.parametrize("solver", OF_ANY_SIZE)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_world_that_lost_bodies_is_the_world_that_never_had_them(precision: str, solver: str) -> None:
    def fill(world: World, extra: bool) -> World:
        passing = []

        def maybe() -> None:
            if extra:
                shape = Polygon(POINTS) if len(passing) % 3 else Box(1, 1)
                passing.append(world.create_body(shape, position=(0.1 * len(passing), 0.5), restitution=restitution))

        maybe()
        ground = floor(world)
        maybe()
        a = world.create_body(Box(1, 1), position=(0, 0.6), angle=0.3)
        for _ in range(40):
            maybe()
        run(world, 5 if extra else 0)
        for body in passing:
            body.destroy()
        a.position, a.angle, a.velocity, a.angular_velocity = (0, 0.6), 0.3, (0, 0), 0
        b = world.create_body(Circle(0.5), position=(0.2, 1.8))
        world.create_joint_revolute(b, ground, anchor=(2, 3))
        c = world.create_body(Box(0.5, 2), position=(-1, 3))
        world.create_joint_revolute(a, c, anchor=(0, 2), collide_connected=False)
        world.create_body(Polygon(POINTS, 0.1), position=(2, 1))
        return world

    restitution = 0.5 if solver == "soft_step" else 0.0
    plain, reused = World(precision=precision, solver=solver), World(precision=precision, solver=solver)
    fill(plain, False)
    fill(reused, True)
    reused.warm_starting = plain.warm_starting = False  # the first step alone may not remember the ones before
    run(reused, 1)
    run(plain, 1)
    reused.warm_starting = plain.warm_starting = True
    assert plain.state_hash() == reused.state_hash()
    run(plain, 80)
    run(reused, 80)
    assert plain.state_hash() == reused.state_hash()
    assert np.array_equal(plain.positions, reused.positions)


class ComingAndGoing(RuleBasedStateMachine):
    """Bodies and joints come and go at random; the world must agree with two plain lists."""

    def __init__(self) -> None:
        super().__init__()
        self.world = World()
        self.bodies: list = []
        self.joints: list = []
        self.shapes: list = []
        self.gone: list = []

    @rule(x=st.floats(-3, 3), y=st.floats(-3, 3), circle=st.booleans(), static=st.booleans())
    def create(self, x: float, y: float, circle: bool, static: bool) -> None:
        body = self.world.create_body(
            Circle(0.5) if circle else Box(1, 1), position=(x, y), kind="static" if static else "dynamic"
        )
        self.bodies.append(body)
        self.shapes += body.shapes

    @precondition(lambda self: self.bodies)
    @rule(data=st.data(), polygon=st.booleans())
    def add_shape(self, data: st.DataObject, polygon: bool) -> None:
        body = data.draw(st.sampled_from(self.bodies))
        shape = Polygon(POINTS) if polygon else Box(0.5, 0.5)
        self.shapes.append(body.add_shape(shape, offset=(0.5, 0), angle=0.3))

    @precondition(lambda self: self.shapes)
    @rule(data=st.data())
    def remove_shape(self, data: st.DataObject) -> None:
        shape = self.shapes.pop(data.draw(st.integers(0, len(self.shapes) - 1)))
        shape.destroy()
        self.gone.append(shape)

    @precondition(lambda self: len(self.bodies) > 1)
    @rule(data=st.data(), collide=st.booleans())
    def join(self, data: st.DataObject, collide: bool) -> None:
        a, b = data.draw(st.permutations(self.bodies))[:2]
        if (a.kind, b.kind) != ("static", "static"):
            self.joints.append(
                self.world.create_joint_revolute(a, b, anchor=tuple(a.position), collide_connected=collide)
            )

    @precondition(lambda self: self.bodies)
    @rule(data=st.data())
    def destroy(self, data: st.DataObject) -> None:
        body = self.bodies.pop(data.draw(st.integers(0, len(self.bodies) - 1)))
        lost = [joint for joint in self.joints if body in (joint.body1, joint.body2)]
        lost_shapes = body.shapes
        self.shapes = [shape for shape in self.shapes if shape not in lost_shapes]
        self.joints = [joint for joint in self.joints if joint not in lost]
        body.destroy()
        self.gone += [body, *lost, *lost_shapes]

    @precondition(lambda self: self.joints)
    @rule(data=st.data())
    def unjoin(self, data: st.DataObject) -> None:
        joint = self.joints.pop(data.draw(st.integers(0, len(self.joints) - 1)))
        joint.destroy()
        self.gone.append(joint)

    @rule(steps=st.integers(1, 3))
    def step(self, steps: int) -> None:
        run(self.world, steps)

    @invariant()
    def agrees(self) -> None:
        world = self.world
        assert world.bodies == self.bodies
        assert world.joints == self.joints
        assert (world.body_count, world.joint_count) == (len(self.bodies), len(self.joints))
        assert all(thing.alive for thing in (*self.bodies, *self.joints, *self.shapes))
        assert {shape for body in self.bodies for shape in body.shapes} == set(self.shapes)
        assert len(world.shape_records()) == len(self.shapes)
        assert world._state.hulls.count == sum(shape.shape.name == "polygon" for shape in self.shapes)
        assert not any(thing.alive for thing in self.gone)
        assert [tuple(body.position) for body in self.bodies] == [tuple(row) for row in world.positions]
        ignored = {
            frozenset((joint.body1, joint.body2)) for joint in self.joints if not joint.collide_connected
        }  # fmt: skip
        for arbiter in world.arbiters:
            assert arbiter.body1.alive
            assert arbiter.body2.alive
            assert (arbiter.body1.kind, arbiter.body2.kind) != ("static", "static")
        if not world._state.stale:
            assert not any(frozenset((arbiter.body1, arbiter.body2)) in ignored for arbiter in world.arbiters)


ComingAndGoing.TestCase.settings = settings(max_examples=30, stateful_step_count=25, deadline=None)
TestComingAndGoing = ComingAndGoing.TestCase


def test_body_at() -> None:
    world = World()
    ground = floor(world)
    world.create_body(Box(2, 2), position=(0, 3))
    upper = world.create_body(Circle(1), position=(0.5, 3))
    assert world.body_at((0.9, 3)) == upper, "of several the one created last"
    assert world.body_at((0, -0.5)) is None
    assert world.body_at((0, -0.5), kind="static") == ground
    assert world.body_at((5, 5)) is None


# --- determinism ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_same_twice(precision: str, solver: str) -> None:
    first, second = (run(gathering(precision, solver=solver), 200) for _ in range(2))
    assert first.state_hash() == second.state_hash()
    assert tables_of(first) == tables_of(second)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("make", [busy, gathering])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_the_broad_phase_does_not_show(make, precision: str, solver: str) -> None:
    def play(names: list[str]) -> str:
        world = make(precision, solver=solver)
        for name in names:  # it may also change while the world runs
            world.broad_phase = name
            run(world, 40)
            world.bodies[1].position += (0.0, 0.05)
            world.create_body(Circle(0.3), position=(0.1, 3))
            run(world, 40)
        return world.state_hash()

    assert len({play(names) for names in ([a, b] for a in BROAD_PHASES for b in BROAD_PHASES)}) == 1


@pytest.mark.parametrize("solver", SOLVERS)
def test_worlds_do_not_know_each_other(solver: str) -> None:
    alone = run(busy(solver=solver), 60).state_hash()
    world, other = busy(solver=solver), busy(gravity=(3, 0))
    for _ in range(60):
        world.step(DT)
        other.step(0.01)
        other.create_body(Circle(0.2), position=(0, 5))
    assert world.state_hash() == alone
