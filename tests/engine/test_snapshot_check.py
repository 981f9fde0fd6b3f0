"""A snapshot that cannot be a world's is refused before anything changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import SOLVERS, Box, Capsule, Chain, Circle, Polygon, Segment, Snapshot, StepError, World
from tests.engine.worlds import POINTS, gathering

Tables = dict[str, np.ndarray]


def busy_world(**settings: Any) -> World:
    """Contacts, a joint, a destroyed body whose row is free; far away one of every shape, with and without columns."""
    world = World(**settings)
    ground = world.create_body(Box(10, 1), kind="static")
    gone = world.create_body(Box(1, 1), position=(5, 5))
    box = world.create_body(Box(1, 1), position=(0, 0.95))
    world.create_body(Circle(0.5), position=(0, 1.9))
    world.create_joint_revolute(ground, box, anchor=(0, 0.5))
    far = world.create_body(kind="static", position=(50, 0))
    far.add_shape(Chain(((0, 0), (1, 0), (2, 1))))
    far.add_shape(Segment((0, 5), (1, 5)))
    world.create_body(Polygon(POINTS, 0.1), position=(60, 0), linear_damping=0.5, category=4)
    world.create_body(Capsule(1, 0.5), position=(70, 0))
    gone.destroy()
    for _ in range(3):
        world.step(1 / 60)
    return world


def put(table: str, field: str, row: int, value: float) -> Callable[[Tables], None]:
    def change(tables: Tables) -> None:
        tables[table][field][row] = value

    return change


def put_in(table: str, row: int, value: float) -> Callable[[Tables], None]:
    """Into a table without fields."""

    def change(tables: Tables) -> None:
        tables[table][row] = value

    return change


def column(name: str, value: float, table: str = "shapes.shapes") -> Callable[[Tables], None]:
    """A column that was not there, with one value."""
    return lambda tables: tables.update({name: np.full(len(tables[table]), value)})


def drop(table: str) -> Callable[[Tables], None]:
    return lambda tables: tables.pop(table)  # type: ignore[return-value]


def exchange(table: str, value: np.ndarray) -> Callable[[Tables], None]:
    return lambda tables: tables.update({table: value})


# rows of shapes: 0 box, 1 that of the destroyed box, 2 box, 3 circle, 4 and 5 chain, 6 segment, 7 polygon, 8 capsule
FAULTS = {
    "a joint of a body that is not there": put("joints.joints", "body1", 0, 100_000_000),
    "a joint of a body with itself": put("joints.joints", "body1", 0, 2),
    "a joint of a destroyed body": put("joints.joints", "body2", 0, 1),
    "a negative row": put("joints.joints", "body2", 0, -1),
    "a motor neither there nor not": put("joints.turns", "motored", 0, 2),
    "a negative torque": put("joints.turns", "max_motor", 0, -1.0),
    "a motor that is no number": put("joints.turns", "motor_speed", 0, np.nan),
    "a joint of a kind that is not there": put("joints.joints", "kind", 0, 8),
    "limits the wrong way round": put("joints.slides", "lower", 0, 1.0),
    "a joint that is along nothing there is": put("joints.slides", "along", 0, 3),
    "an arbiter of a body that is not there": put("arbiters", "body2", 0, 77),
    "an arbiter of another body than its shape's": put("arbiters", "body2", 0, 3),
    "an arbiter of a shape that is not there": put("arbiters", "shape2", 0, 77),
    "an arbiter of a negative shape": put("arbiters", "shape1", 0, -1),
    "an arbiter of a destroyed shape": put("arbiters", "shape2", 0, 1),
    "an arbiter of another serial": put("arbiters", "serial2", 0, 1),
    "an arbiter with another collider": put("arbiters", "collider", 0, 3),
    "an arbiter with a collider that is not there": put("arbiters", "collider", 0, 999),
    "three contacts": put("arbiters", "count", 0, 3),
    "contacts less than none": put("arbiters", "count", 0, -1),
    "a NaN contact": lambda tables: tables["contacts"]["separation"].__setitem__((0, 0), np.nan),
    "a shape that is not there": put("shapes.shapes", "kind", 0, 9),
    "a shape of no kind": put("shapes.shapes", "kind", 0, -1),
    "a shape of a body that is not there": put("shapes.shapes", "body", 0, 44),
    "a shape of a destroyed body": put("shapes.shapes", "body", 3, 1),
    "a shape of a negative body": put("shapes.shapes", "body", 3, -2),
    "a shape's serial twice": put("shapes.shapes", "serial", 3, 0),
    "a shape's serial that is to come": put("shapes.shapes", "serial", 3, 50),
    "a polygon without a hull": put("shapes.shapes", "hull", 7, -1),
    "a polygon with a hull that is not there": put("shapes.shapes", "hull", 7, 5),
    "another shape become a polygon": put("shapes.shapes", "kind", 2, 3),
    "a piece of a chain that is not there": put("shapes.shapes", "part_of", 5, 40),
    "a piece of another shape": put("shapes.shapes", "part_of", 5, 2),
    "a piece of a later one": put("shapes.shapes", "part_of", 4, 5),
    "a box in two pieces": put("shapes.shapes", "part_of", 2, 0),
    "a negative mass": put("shapes.shapes", "mass", 2, -1.0),
    "a negative friction": put("shapes.shapes", "friction", 2, -0.1),
    "an infinite friction": put("shapes.shapes", "friction", 2, np.inf),
    "a hull of two corners": put("hulls.hulls", "count", 0, 2),
    "a hull of nine corners": put("hulls.hulls", "count", 0, 9),
    "a hull of NaN": lambda tables: tables["hulls.hulls"]["x"].__setitem__((0, 2), np.nan),
    "a kind that is not there": put("bodies.bodies", "kind", 0, -1),
    "rotation neither fixed nor free": put("bodies.bodies", "fixed_rotation", 0, 2),
    "no width": put("shapes.shapes", "half_x", 0, 0.0),
    "no height": put("shapes.shapes", "half_y", 0, 0.0),
    "a circle without radius": put("shapes.shapes", "radius", 3, 0.0),
    "a capsule without radius": put("shapes.shapes", "radius", 8, 0.0),
    "a capsule without length": put("shapes.shapes", "half_x", 8, 0.0),
    "a segment without length": put("shapes.shapes", "half_x", 6, 0.0),
    "a piece without length": put("shapes.shapes", "half_x", 4, 0.0),
    "a polygon less than sharp": put("shapes.shapes", "radius", 7, -0.1),
    "NaN": put("bodies.bodies", "x", 2, np.nan),
    "an infinite velocity": put("bodies.motions", "vx", 2, np.inf),
    "a serial twice": put("bodies.bodies", "serial", 2, 0),
    "a serial that is to come": put("bodies.bodies", "serial", 3, 50),
    "no next serial": drop("joints.next_serial"),
    "no contacts": drop("contacts"),
    "no hulls": drop("hulls.hulls"),
    "no shapes": drop("shapes.shapes"),
    "a table too many": exchange("windmills", np.zeros(3)),
    "other fields": exchange("bodies.motions", np.zeros(4)),
    "other dimensions": lambda tables: tables.update(arbiters=tables["arbiters"][:, None]),
    "contacts of other arbiters": lambda tables: tables.update(contacts=tables["contacts"][:1]),
    "arbiters in another order": lambda tables: tables.update(
        arbiters=tables["arbiters"][::-1].copy(), contacts=tables["contacts"][::-1].copy()
    ),
    "an arbiter twice": lambda tables: tables.update(
        arbiters=np.repeat(tables["arbiters"], 2), contacts=np.repeat(tables["contacts"], 2, axis=0)
    ),
    "fewer motions": lambda tables: tables.update({"bodies.motions": tables["bodies.motions"][:2]}),
    "negative time": exchange("time", np.array(-1.0)),
    "a column of another length": exchange("shapes.restitution", np.zeros(3)),
    "a column of another type": column("shapes.category", 1.0),
    "a column that is not there": column("shapes.color", 1.0),
    "a body's column of a shape": column("shapes.linear_damping", 1.0),
    "a column of NaN": column("shapes.restitution", np.nan),
    "a column out of range": column("shapes.restitution", 1.5),
    "a touch of a shape that is to come": put("touching", "shape2", 1, 50),
    "a touch of a body that is not there": put("touching", "body1", 0, -1),
    "touches in another order": lambda tables: tables.update(touching=tables["touching"][::-1].copy()),
    "a touch of a shape with itself": put("touching", "shape2", 0, 0),
    "touches without fields": exchange("touching", np.zeros(3)),
    "a property out of range": put_in("bodies.linear_damping", 5, -1.0),
}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS.keys())
def test_what_cannot_be_is_refused_and_changes_nothing(fault: Callable[[Tables], None]) -> None:
    good = busy_world(tell_events=True).snapshot()
    tables = {name: table.copy() for name, table in good.tables.items()}
    fault(tables)
    bad = Snapshot.from_bytes(replace(good, tables=tables).to_bytes())
    world = World(gravity=(0, -3))
    world.create_body(Box(2, 2))
    before = world.snapshot().to_bytes()
    with pytest.raises(ValueError, match="snapshot"):
        world.restore(bad)
    assert world.snapshot().to_bytes() == before


def test_a_fault_is_what_is_refused() -> None:
    good = busy_world(tell_events=True).snapshot()
    assert good.tables["touching"].tolist() == [(0, 2, 0, 2), (2, 3, 2, 3)]
    assert good.tables["shapes.shapes"]["kind"].tolist() == [0, 0, 0, 1, 5, 5, 4, 3, 2]
    assert good.tables["shapes.shapes"]["serial"].tolist() == [0, -1, 2, 3, 4, 5, 6, 7, 8]
    assert len(good.tables["arbiters"]) == 2
    World().restore(good)


def test_columns_in_range_are_taken() -> None:
    good = busy_world().snapshot()
    tables = {name: table.copy() for name, table in good.tables.items()}
    tables["shapes.restitution"] = np.full(len(tables["shapes.shapes"]), 0.5)
    world = World()
    world.restore(replace(good, tables=tables))
    assert {shape.restitution for body in world.bodies for shape in body.shapes} == {0.5}


def test_an_effect_that_the_solver_lacks() -> None:
    good = busy_world(solver="sequential_impulses").snapshot()
    tables = {**good.tables, "shapes.restitution": np.full(len(good.tables["shapes.shapes"]), 0.5)}
    with pytest.raises(ValueError, match=r"^snapshot: solver = 'sequential_impulses': must be one that knows restit"):
        World().restore(replace(good, tables=tables))


@pytest.mark.parametrize("make", [busy_world, gathering])
@pytest.mark.parametrize("solver", SOLVERS)
def test_what_can_be_is_taken(solver: str, make: Callable[..., World]) -> None:
    source = make(solver=solver)
    world = World(precision=source.precision)
    world.restore(Snapshot.from_bytes(source.snapshot().to_bytes()))
    for _ in range(30):
        source.step(1 / 60)
        world.step(1 / 60)
    assert world.state_hash() == source.state_hash()


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("precision", ["single", "double"])
def test_what_flew_off_and_was_destroyed_does_not_spoil_a_snapshot(precision: str, solver: str) -> None:
    world = World(precision=precision, solver=solver)
    lost = world.create_body(Box(1, 1), mass=1e-3)
    world.create_body(Box(1, 1), position=(0.9, 0))
    world.create_body(Box(1, 1), position=(5, 0))
    lost.force = (3e38 if precision == "single" else 1e308, 0)
    with pytest.raises(StepError):
        world.step(1 / 60)
    world.bodies[1].destroy()
    lost.destroy()
    world.step(1 / 60)
    world.restore(world.snapshot())
