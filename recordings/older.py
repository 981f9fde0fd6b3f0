"""Recordings of earlier versions, as if they had been written today."""

from __future__ import annotations

import numpy as np

from recordings import schema
from recordings.stored_table import StoredTable


def nobody_asleep(bodies: StoredTable) -> dict[str, StoredTable]:
    """The table SLEEP of a recording of version 1 or 2, in whose time no body slept. bodies: its table BODIES."""
    rows = np.zeros(len(bodies.rows), schema.SLEEP.dtype)
    rows.flags.writeable = False
    return {schema.SLEEP.path: StoredTable(bodies.steps, bodies.starts, rows)}


def pinned(joints: StoredTable) -> dict[str, StoredTable]:
    """The table JOINTS of a recording of version 1 or 2, in whose time all joints were revolute and none turned."""
    rows = np.zeros(len(joints.rows), schema.JOINTS.dtype)
    for name in schema.JOINTS_2.dtype.names or ():
        rows[name] = joints.rows[name]
    rows.flags.writeable = False
    return {schema.JOINTS.path: StoredTable(joints.steps, joints.starts, rows)}


def upgraded(roster: StoredTable) -> dict[str, StoredTable]:
    """The tables ON_CHANGE of a recording of version 1, where each body had one shape, at its origin."""
    bodies = np.empty(len(roster.rows), schema.ROSTER.dtype)
    for name in ("serial", "body_kind"):
        bodies[name] = roster.rows[name]
    pieces = np.zeros(len(roster.rows), schema.PIECES.dtype)
    pieces["owner"] = roster.rows["serial"]
    for name in ("serial", "shape_kind", "size1", "size2"):
        pieces[name] = roster.rows[name]
    corners = np.zeros(0, schema.CORNERS.dtype)
    for rows in (bodies, pieces, corners):
        rows.flags.writeable = False
    none = np.zeros(len(roster.steps) + 1, np.int64)
    return {
        schema.ROSTER.path: StoredTable(roster.steps, roster.starts, bodies),
        schema.PIECES.path: StoredTable(roster.steps, roster.starts, pieces),
        schema.CORNERS.path: StoredTable(roster.steps, none, corners),
    }
