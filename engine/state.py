"""All that a world is: its tables, and what was read off them when their content last changed."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.broad_phase.all_pairs import WORD
from engine.narrow_phase import COLLIDERS
from engine.settings import Settings
from engine.shapes import BOUNDS
from engine.storage import Storage
from engine.tables import (
    BODY,
    STATIC,
    arbiter_dtype,
    contact_dtype,
    empty,
    motion_dtype,
    revolute_dtype,
    step_dtype,
)


class ArbiterTable:
    """Arbiters in ascending order of (serial1, serial2), with up to two contacts each."""

    def __init__(self, precision: str, capacity: int) -> None:
        self.rows = empty(capacity, arbiter_dtype(precision))
        self.contacts = empty((capacity, 2), contact_dtype(precision))
        self.count = 0


class State:
    """The tables of one world. A step refreshes what is `stale` before it looks at it."""

    def __init__(self, settings: Settings) -> None:
        precision = settings.precision
        self.bodies = Storage({"bodies": BODY, "motions": motion_dtype(precision)})
        self.joints = Storage({"joints": revolute_dtype(precision)})
        self.precision = precision
        self.arbiters = ArbiterTable(precision, 0)  # of the last step
        self.found = ArbiterTable(precision, 0)  # where the next step's grow
        self.pairs = np.empty((0, 2), np.int64)  # of ranks that may touch
        self.pair_count = 0
        self.steps = empty(1, step_dtype(precision))
        self.prepared_for: Settings | None = None  # what `steps` was written from
        self.prepared_dt = 0.0
        self.step_count = 0
        self.time = 0.0  # [s]
        self.stale = True  # bodies or joints came or went since the last refresh

    def refresh(self) -> None:
        """Reads off the content what the stages need: which shapes there are, who is fixed, who ignores whom."""
        order = self.bodies.order
        rows = self.bodies.tables["bodies"][order]
        padded = (len(order) + WORD - 1) // WORD * WORD
        self.fixed = (rows["kind"] == STATIC).astype(np.uint8)
        self.bounds = np.zeros((4, len(order)), np.float32)
        self.flags = np.zeros(padded, np.uint8)
        kinds = {int(kind) for kind in np.unique(rows["shape_kind"])}
        self.bounds_kernels = [BOUNDS[kind] for kind in sorted(kinds)]
        self.colliders = [collide for pair, collide in COLLIDERS.items() if kinds.issuperset(pair)]
        self.ignored = self._ignored_pairs()
        self.active_joints = self.joints.tables["joints"] if self.joints.count else None
        self.stale = False

    def _ignored_pairs(self) -> np.ndarray | None:
        """(P, 2) int64 serials of bodies joined without colliding, ascending; None if there are none."""
        joints = self.joints.tables["joints"][self.joints.order]
        joints = joints[joints["collide_connected"] == 0]
        if len(joints) == 0:
            return None
        serials = self.bodies.tables["bodies"]["serial"]
        pairs = np.sort(np.stack([serials[joints["body1"]], serials[joints["body2"]]], axis=1), axis=1)
        return np.unique(pairs, axis=0)

    def reserve_pairs(self, count: int) -> None:
        """Makes room for so many pairs, and as many arbiters in `found`."""
        capacity = max(16, count + count // 2)
        self.pairs = np.empty((capacity, 2), np.int64)

    def reserve_found(self) -> None:
        """Makes room in `found` for an arbiter for every pair."""
        if len(self.found.rows) < len(self.pairs):
            self.found = ArbiterTable(self.precision, len(self.pairs))

    def drop_arbiters_of(self, serial: int) -> None:
        """Forgets the contacts of a body that is going."""
        table = self.arbiters
        rows = table.rows[: table.count]
        kept = np.flatnonzero((rows["serial1"] != serial) & (rows["serial2"] != serial))
        table.rows[: len(kept)] = rows[kept]
        table.contacts[: len(kept)] = table.contacts[kept]
        table.count = len(kept)

    def save(self) -> dict[str, np.ndarray]:
        """Copies of every table that a later step depends on."""
        table = self.arbiters
        return {
            **{f"bodies.{name}": rows for name, rows in self.bodies.save().items()},
            **{f"joints.{name}": rows for name, rows in self.joints.save().items()},
            "arbiters": np.array(table.rows[: table.count]),
            "contacts": np.array(table.contacts[: table.count]),
            "step_count": np.array(self.step_count, np.int64),
            "time": np.array(self.time),
        }

    def load(self, saved: dict[str, Any]) -> None:
        """Takes back what `save` gave."""
        for name, storage in (("bodies", self.bodies), ("joints", self.joints)):
            prefix = name + "."
            storage.load({key.removeprefix(prefix): rows for key, rows in saved.items() if key.startswith(prefix)})
        count = len(saved["arbiters"])
        self.arbiters = ArbiterTable(self.precision, count)
        self.arbiters.rows[:] = saved["arbiters"]
        self.arbiters.contacts[:] = saved["contacts"]
        self.arbiters.count = count
        self.step_count = int(saved["step_count"])
        self.time = float(saved["time"])
        self.stale = True
