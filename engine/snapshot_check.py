"""Whether a snapshot's tables can be a world's: one from a file may hold anything, and kernels trust their rows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine import validate
from engine.settings import Settings
from engine.shapes import SHAPES
from engine.state import State
from engine.tables import BODY_KINDS

MAY_BE_INFINITE = ("mass", "inertia")  # of static bodies


def check_tables(settings: Settings, tables: Mapping[str, np.ndarray]) -> None:
    """ValueError, naming the table, if a world of these settings cannot have such tables."""
    expected = State(settings).save()
    for name in tables:
        validate.choice("snapshot table", name, expected)
    for name, example in expected.items():
        table = tables.get(name)
        if table is None or table.dtype != example.dtype or table.ndim != example.ndim:
            raise refuse(name, f"there, of {example.ndim} dimensions and the fields of this version")
        check_finite(name, table)
    check_bodies(tables)
    check_joints(tables)
    check_arbiters(tables)
    for name in ("step_count", "time"):
        if tables[name] < 0:
            raise refuse(name, ">= 0")


def check_finite(name: str, table: np.ndarray) -> None:
    """No number may be NaN or infinite, but for what static bodies have."""
    columns = {field: table[field] for field in table.dtype.names} if table.dtype.names else {name: table}
    for field, values in columns.items():
        if np.isnan(values).any() or (field not in MAY_BE_INFINITE and not np.isfinite(values).all()):
            raise refuse(name, f"finite, {field} is not")


def check_bodies(tables: Mapping[str, np.ndarray]) -> None:
    """Bodies have serials of their own, kinds and shapes that there are, and a motion each."""
    bodies = tables["bodies.bodies"]
    check_serials("bodies", "bodies", tables)
    if len(tables["bodies.motions"]) != len(bodies):
        raise refuse("bodies.motions", "as long as bodies.bodies")
    living = bodies[bodies["serial"] >= 0]
    for field, count in (("kind", len(BODY_KINDS)), ("shape_kind", len(SHAPES))):
        if ((living[field] < 0) | (living[field] >= count)).any():
            raise refuse("bodies.bodies", f"of {field}s from 0 to {count - 1}")
    if (living["half_x"] <= 0).any() or (living["half_y"] < 0).any() or (living["friction"] < 0).any():
        raise refuse("bodies.bodies", "of positive sizes and no negative friction")


def check_joints(tables: Mapping[str, np.ndarray]) -> None:
    """Joints have serials of their own and two living bodies."""
    check_serials("joints", "joints", tables)
    joints = tables["joints.joints"]
    joints = joints[joints["serial"] >= 0]
    check_rows("joints.joints", tables, joints["body1"], joints["body2"])


def check_arbiters(tables: Mapping[str, np.ndarray]) -> None:
    """Arbiters stand in ascending order, between living bodies of those serials, with at most two contacts each."""
    arbiters = tables["arbiters"]
    if tables["contacts"].shape != (len(arbiters), 2):
        raise refuse("contacts", "two to each arbiter")
    if ((arbiters["count"] < 0) | (arbiters["count"] > 2)).any():
        raise refuse("arbiters", "of 0 to 2 contacts")
    check_rows("arbiters", tables, arbiters["body1"], arbiters["body2"])
    serials = tables["bodies.bodies"]["serial"]
    keys = np.stack([serials[arbiters["body1"]], serials[arbiters["body2"]]], axis=1)
    if not np.array_equal(keys, np.stack([arbiters["serial1"], arbiters["serial2"]], axis=1)):
        raise refuse("arbiters", "between the bodies of their serials")
    order = np.lexsort((keys[:, 1], keys[:, 0]))
    if (np.diff(order) != 1).any() or len(np.unique(keys, axis=0)) != len(keys) or (keys[:, 0] >= keys[:, 1]).any():
        raise refuse("arbiters", "in ascending order of their serials")


def check_serials(storage: str, main: str, tables: Mapping[str, np.ndarray]) -> None:
    """No serial twice, and none that is still to come."""
    serials = tables[f"{storage}.{main}"]["serial"]
    living = serials[serials >= 0]
    if len(np.unique(living)) != len(living) or (living >= tables[f"{storage}.next_serial"]).any():
        raise refuse(f"{storage}.{main}", "of serials given once, below next_serial")


def check_rows(name: str, tables: Mapping[str, np.ndarray], first: np.ndarray, second: np.ndarray) -> None:
    """Both are rows of living bodies, and never the same one."""
    serials = tables["bodies.bodies"]["serial"]
    for rows in (first, second):
        if ((rows < 0) | (rows >= len(serials))).any() or (serials[rows] < 0).any():
            raise refuse(name, "between living bodies")
    if (first == second).any():
        raise refuse(name, "between two different bodies")


def refuse(table: str, allowed: str) -> ValueError:
    return ValueError(f"snapshot: its table {table} must be {allowed}")
