"""A snapshot that cannot be a world's is refused before anything changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from engine import Box, Circle, Snapshot, StepError, World

Tables = dict[str, np.ndarray]


def busy_world() -> World:
    """Contacts, a joint, a destroyed body whose row is free."""
    world = World()
    ground = world.create_body(Box(10, 1), kind="static")
    gone = world.create_body(Box(1, 1), position=(5, 5))
    box = world.create_body(Box(1, 1), position=(0, 0.95))
    world.create_body(Circle(0.5), position=(0, 1.9))
    world.create_joint_revolute(ground, box, anchor=(0, 0.5))
    gone.destroy()
    for _ in range(3):
        world.step(1 / 60)
    return world


def put(table: str, field: str, row: int, value: float) -> Callable[[Tables], None]:
    def change(tables: Tables) -> None:
        tables[table][field][row] = value

    return change


def drop(table: str) -> Callable[[Tables], None]:
    return lambda tables: tables.pop(table)  # type: ignore[return-value]


def exchange(table: str, value: np.ndarray) -> Callable[[Tables], None]:
    return lambda tables: tables.update({table: value})


FAULTS = {
    "a joint of a body that is not there": put("joints.joints", "body1", 0, 100_000_000),
    "a joint of a body with itself": put("joints.joints", "body1", 0, 2),
    "a joint of a destroyed body": put("joints.joints", "body2", 0, 1),
    "a negative row": put("joints.joints", "body2", 0, -1),
    "an arbiter of a body that is not there": put("arbiters", "body2", 0, 77),
    "an arbiter of another serial": put("arbiters", "serial2", 0, 1),
    "three contacts": put("arbiters", "count", 0, 3),
    "a shape that is not there": put("bodies.bodies", "shape_kind", 0, 9),
    "a kind that is not there": put("bodies.bodies", "kind", 0, -1),
    "no size": put("bodies.bodies", "half_x", 0, 0.0),
    "NaN": put("bodies.bodies", "x", 2, np.nan),
    "an infinite velocity": put("bodies.motions", "vx", 2, np.inf),
    "a serial twice": put("bodies.bodies", "serial", 2, 0),
    "a serial that is to come": put("bodies.bodies", "serial", 3, 50),
    "no next serial": drop("joints.next_serial"),
    "no contacts": drop("contacts"),
    "a table too many": exchange("windmills", np.zeros(3)),
    "other fields": exchange("bodies.motions", np.zeros(4)),
    "contacts of other arbiters": lambda tables: tables.update(contacts=tables["contacts"][:1]),
    "arbiters in another order": lambda tables: tables.update(
        arbiters=tables["arbiters"][::-1].copy(), contacts=tables["contacts"][::-1].copy()
    ),
    "fewer motions": lambda tables: tables.update({"bodies.motions": tables["bodies.motions"][:2]}),
    "negative time": exchange("time", np.array(-1.0)),
}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS.keys())
def test_what_cannot_be_is_refused_and_changes_nothing(fault: Callable[[Tables], None]) -> None:
    good = busy_world().snapshot()
    tables = {name: table.copy() for name, table in good.tables.items()}
    fault(tables)
    bad = Snapshot.from_bytes(replace(good, tables=tables).to_bytes())
    world = World(gravity=(0, -3))
    world.create_body(Box(2, 2))
    before = world.snapshot().to_bytes()
    with pytest.raises(ValueError, match="snapshot"):
        world.restore(bad)
    assert world.snapshot().to_bytes() == before


def test_what_can_be_is_taken() -> None:
    source, world = busy_world(), World()
    world.restore(Snapshot.from_bytes(source.snapshot().to_bytes()))
    for _ in range(30):
        source.step(1 / 60)
        world.step(1 / 60)
    assert world.state_hash() == source.state_hash()


@pytest.mark.parametrize("precision", ["single", "double"])
def test_what_flew_off_and_was_destroyed_does_not_spoil_a_snapshot(precision: str) -> None:
    world = World(precision=precision)
    lost = world.create_body(Box(1, 1))
    world.create_body(Box(1, 1), position=(5, 0))
    lost.force = (3e38, 0)
    with pytest.raises(StepError):
        world.step(1e30 if precision == "single" else 1e300)
    lost.destroy()
    world.step(1 / 60)
    world.restore(world.snapshot())
