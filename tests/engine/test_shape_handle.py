"""Shapes of a body: what comes and goes, and what its handle reads and writes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import SOLVERS, Box, Capsule, Chain, Circle, Polygon, Segment, ShapeHandle, World
from engine.effects.filters import ALL
from tests.engine.worlds import DT, POINTS, PRECISIONS, fingerprint, floor, gathering, run

pytestmark = pytest.mark.kernel

CHANGES = {
    "friction": 0.75, "restitution": 0.5, "rolling_resistance": 0.25, "tangent_speed": -2.0, "category": 6, "mask": 1,
    "group": -4,
}  # fmt: skip


def test_what_it_reads() -> None:
    world = World(precision="double")
    body = world.create_body(Box(2, 1), position=(3, 4), friction=0.4, density=3, restitution=0.25, group=2)
    (first,) = body.shapes
    assert (first.shape, first.body, first.mass, first.friction) == (Box(2, 1), body, 6.0, 0.4)
    assert (first.restitution, first.rolling_resistance, first.tangent_speed) == (0.25, 0.0, 0.0)
    assert (first.category, first.mask, first.group) == (1, ALL, 2)
    second = body.add_shape(Circle(0.5), offset=(1, 0), mass=2, category=8)
    assert body.shapes == [first, second]
    assert (second.mass, second.friction, second.category, second.group) == (2.0, 0.2, 8, 0)
    assert body.shape == Box(2, 1), "the first one's"
    assert body.friction == 0.4
    assert repr(first) == "<ShapeHandle 0: Box(width=2.0, height=1.0)>"


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("name", CHANGES)
def test_what_it_writes(name: str, precision: str) -> None:
    world = World(precision=precision)
    body = world.create_body(Box(1, 1))
    other, chain = (
        body.add_shape(Circle(1)),
        world.create_body(kind="static").add_shape(Chain(((0, 0), (1, 0), (2, 0)))),
    )
    default = getattr(other, name)
    for handle in (body.shapes[0], chain):
        setattr(handle, name, CHANGES[name])
        assert getattr(handle, name) == CHANGES[name]
        assert type(getattr(handle, name)) is type(default)
    assert getattr(other, name) == default, "no other shape's"
    assert getattr(chain, name) == CHANGES[name]
    if name == "friction":
        values = world.shape_records()["friction"]
    else:
        values = world._state.shapes.columns[name][world._state.shapes.order]
    assert values.tolist() == [CHANGES[name], default, CHANGES[name], CHANGES[name]], "all pieces of a chain"


def test_friction_of_a_body_is_that_of_all_its_shapes() -> None:
    world = World()
    body = world.create_body(Box(1, 1), friction=0.1)
    body.add_shape(Circle(1), friction=0.9)
    assert body.friction == 0.1
    body.friction = 0.5
    assert [shape.friction for shape in body.shapes] == [0.5, 0.5]


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_change_of_friction_reaches_contacts_that_are_there(solver: str) -> None:
    world = World(precision="double", solver=solver)
    ground = floor(world, friction=1.0)
    box = world.create_body(Box(2, 0.1), position=(0, 0.045), friction=1.0, velocity=(5, 0))
    run(world, 6)
    assert box.velocity.x < 4.5
    ground.shapes[0].friction = 0.0
    world.step(DT)
    speed = box.velocity.x
    assert world.arbiters[0].friction == 0.0
    run(world, 10)
    assert box.velocity.x == pytest.approx(speed, abs=1e-6)
    ground.friction = 0.25
    run(world, 1)
    assert world.arbiters[0].friction == 0.5
    run(world, 11)
    assert box.velocity.x == pytest.approx(speed - 12 * DT * 0.5 * 10, rel=0.02)


def test_handles_compare_by_what_they_stand_for() -> None:
    world = World()
    body = world.create_body(Box(1, 1))
    first, second = body.shapes[0], body.add_shape(Circle(1))
    assert first == body.shapes[0] != second
    assert first != body
    assert first != 0
    assert len({*body.shapes, first, second, World().create_body(Box(1, 1)).shapes[0]}) == 3
    assert isinstance(first, ShapeHandle)


def test_a_destroyed_shape_is_gone_and_refuses_everything() -> None:
    world = gathering()
    run(world, 30)
    hammer = next(body for body in world.bodies if len(body.shapes) == 2 and body.kind == "dynamic")
    handle, head = hammer.shapes
    head.destroy()
    assert hammer.shapes == [handle]
    assert not head.alive
    assert repr(head) == f"<ShapeHandle {head.serial}, destroyed>"
    before = fingerprint(world)
    for name in (*CHANGES, "shape", "body", "mass"):
        with pytest.raises(ValueError, match=rf"^shape = ShapeHandle {head.serial}: must be a living shape"):
            getattr(head, name)
    for name, value in CHANGES.items():
        with pytest.raises(ValueError, match="must be a living shape"):
            setattr(head, name, value)
    with pytest.raises(ValueError, match="must be a living shape"):
        head.destroy()
    assert fingerprint(world) == before
    hammer.destroy()
    assert not handle.alive
    late = world.create_body(Circle(0.1), position=(9, 9)).shapes[0]
    assert late.rows[0] in (head.rows[0], handle.rows[0]), "in the place of one that went"
    assert late.serial > max(head.serial, handle.serial)
    assert not head.alive
    assert not handle.alive


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_last_shape_may_go(solver: str) -> None:
    world = World(solver=solver)
    floor(world)
    body = world.create_body(Box(1, 1), position=(0, 0.5), velocity=(1, 0), fixed_rotation=True)
    run(world, 5)
    body.shapes[0].destroy()
    assert (body.mass, body.inertia, body.shapes) == (0, 0, [])
    with pytest.raises(ValueError, match=r"^body = Body 1: must have a shape"):
        _ = body.shape
    run(world, 5)
    assert len(world.arbiters) == 0
    body.add_shape(Circle(0.3), density=2)
    assert body.mass == pytest.approx(2 * math.pi * 0.09)
    run(world, 30)
    assert np.isfinite(world.positions).all()


def test_a_refused_shape_changes_nothing() -> None:
    world = gathering("single")
    run(world, 20)
    body = world.bodies[3]
    before = fingerprint(world)
    for arguments in (
        {"shape": Circle(1), "mass": 1e30}, {"shape": Circle(1), "restitution": 2},
        {"shape": Segment((0, 0), (1, 0)), "mass": 1}, {"shape": Box(1, 1), "color": 1},
    ):  # fmt: skip
        with pytest.raises(ValueError, match="must be"):
            body.add_shape(**arguments)
        assert fingerprint(world) == before


def test_a_compound_that_grows_too_heavy_is_refused() -> None:
    # each of its shapes may be in range where their sum, or its inertia about the common centre, is not
    world = World(precision="single")
    body = world.create_body(Circle(1), mass=5e18)
    before = fingerprint(world)
    with pytest.raises(ValueError, match=r"^(mass|inertia) = .* from .* to .* in single precision"):
        body.add_shape(Circle(1), mass=8e18)
    with pytest.raises(ValueError, match=r"^inertia = .* from .* to .* in single precision"):
        body.add_shape(Circle(1), mass=1e15, offset=(1e6, 0))
    assert fingerprint(world) == before
    assert len(body.shapes) == 1
    double = World(precision="double").create_body(Circle(1), mass=5e18)
    double.add_shape(Circle(1), mass=8e18)


def test_pieces_of_a_chain_are_one_shape() -> None:
    world = World()
    body = world.create_body(Chain(((0, 0), (1, 0), (2, 1), (3, 1))), kind="static")
    box = body.add_shape(Box(1, 1), offset=(9, 9))
    polygon = body.add_shape(Polygon(POINTS))
    capsule = body.add_shape(Capsule(1, 0.5))
    assert [len(shape.rows) for shape in body.shapes] == [3, 1, 1, 1]
    assert body.shapes[1:] == [box, polygon, capsule]
    assert world.shape_records()["part_of"].tolist() == [0, 0, 0, 3, 4, 5]
    assert [shape.serial for shape in body.shapes] == [0, 3, 4, 5]
