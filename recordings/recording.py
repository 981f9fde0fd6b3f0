"""A recording in memory: what `read` gives."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from engine import Events, validate
from engine.events import DTYPES
from recordings import schema
from recordings.stored_table import StoredTable


@dataclass(frozen=True, slots=True)
class State:
    """One recorded step. N bodies, and S pieces of their shapes, in the order of creation; every array is read-only."""

    step: int
    time: float  # [s]
    dt: float  # [s]
    serials: np.ndarray  # (N,) int64
    body_kinds: np.ndarray  # (N,) uint8, index into engine.BODY_KINDS
    positions: np.ndarray  # (N, 2) float64 [m]
    angles: np.ndarray  # (N,) float64 [rad]
    velocities: np.ndarray  # (N, 2) float64 [m/s]
    angular_velocities: np.ndarray  # (N,) float64 [rad/s]
    asleep: np.ndarray  # (N,) bool
    shape_serials: np.ndarray  # (S,) int64
    owners: np.ndarray  # (S,) int64, index of its body in the arrays above
    shape_kinds: np.ndarray  # (S,) uint8, index into engine.SHAPE_KINDS
    sizes: np.ndarray  # (S, 2) float64, as sandbox.frame.Frame.sizes has them [m]
    places: np.ndarray  # (S, 3) float64, x, y [m] and angle [rad] in the body's frame
    corner_counts: np.ndarray  # (S,) uint8, of polygons
    corners: np.ndarray  # (sum of the counts, 2) float64, in the pieces' own frames [m]
    contacts: np.ndarray  # (C,) engine.CONTACT_RECORD
    joints: np.ndarray  # (J,) engine.JOINT_RECORD
    events: Events  # of this step; empty where the setting tell_events was off


@dataclass(frozen=True)
class Recording:
    """A recording in memory. K steps were computed after the start, numbered from `start_step + 1`."""

    path: Path
    whole: bool  # the writer closed it, and nothing is missing
    scene: str
    version: str  # of the tumble that wrote it
    schema: int  # version of the file's schema; of version 1 the world cannot be made again, but all of it be played
    dt: float  # [s], at the start
    start_step: int
    start_time: float  # [s]
    settings: dict[str, Any]  # at the start
    hands: dict[str, Any]  # at the start
    view: tuple[float, float, float]  # centre x, y and height of what the camera shows [m]
    snapshot: bytes  # the world at the start
    steps: np.ndarray  # (K,) int64
    times: np.ndarray  # (K,) float64 [s]
    diagnostics: np.ndarray  # (K,) the fields of schema.STEPS
    commands: dict[int, list[dict[str, Any]]]  # step -> what was applied just before it
    _tables: dict[str, StoredTable]  # by path

    def holds(self, step: int) -> bool:
        """Whether a step's state is there. A kill right at the beginning can leave not even that of the start."""
        held = self._tables[schema.STEPS.path].steps
        return bool(len(held) and held[0] <= step <= held[-1])

    def state(self, step: int) -> State:
        """The state after a step; that of the start too.

        Raises:
            ValueError: the step is not in the recording, or no whole number.
        """
        held = self._tables[schema.STEPS.path].steps
        if not len(held):
            raise ValueError(f"{self.path}: step = {step!r}: the recording holds no step")
        step = validate.whole(f"{self.path}: step", step, held[0], held[-1])
        numbers = self._tables[schema.STEPS.path].at(step)[0]
        bodies = self._tables[schema.BODIES.path].at(step).view(np.float64).reshape(-1, 6)
        roster, pieces, corners = (self._tables[table.path].at(step) for table in schema.ON_CHANGE)
        return State(
            step=step,
            time=float(numbers["time"]),
            dt=float(numbers["dt"]),
            serials=contiguous(roster["serial"]),
            body_kinds=contiguous(roster["body_kind"]),
            positions=contiguous(bodies[:, 0:2]),
            angles=contiguous(bodies[:, 2]),
            velocities=contiguous(bodies[:, 3:5]),
            angular_velocities=contiguous(bodies[:, 5]),
            asleep=contiguous(self._tables[schema.SLEEP.path].at(step)["asleep"] != 0),
            shape_serials=contiguous(pieces["serial"]),
            owners=contiguous(np.searchsorted(roster["serial"], pieces["owner"])),
            shape_kinds=contiguous(pieces["shape_kind"]),
            sizes=contiguous(np.column_stack([pieces["size1"], pieces["size2"]])),
            places=contiguous(np.column_stack([pieces["x"], pieces["y"], pieces["angle"]])),
            corner_counts=contiguous(pieces["corner_count"]),
            corners=contiguous(np.column_stack([corners["x"], corners["y"]])),
            contacts=self._tables[schema.CONTACTS.path].at(step),
            joints=self._tables[schema.JOINTS.path].at(step),
            events=self._events(step, roster["serial"], bodies),
        )

    def _events(self, step: int, serials: np.ndarray, bodies: np.ndarray) -> Events:
        """What happened in a step; where a body that moved is, `bodies` (N, 6) says."""
        found = {}
        for kind, table in schema.HAPPENINGS.items():
            stored = self._tables[table.path].exactly(step)
            rows = found[kind] = np.empty(len(stored), DTYPES[kind])
            rows["step"] = step
            for name in table.dtype.names or ():
                rows[name] = stored[name]
        moved = found["moved"]
        places = bodies[np.searchsorted(serials, moved["body"])]
        moved["x"], moved["y"], moved["angle"] = places[:, 0], places[:, 1], places[:, 2]
        return Events(**{kind: contiguous(rows) for kind, rows in found.items()})


def contiguous(array: np.ndarray) -> np.ndarray:
    """The array without gaps, and read-only."""
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array
