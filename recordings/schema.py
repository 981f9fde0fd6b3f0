"""What a recording holds and where: entity paths, tables with their columns, versions, and what is asked of a frame.

A table is one entity of the file with one component a field; each step has one row of it, which holds one value a body
(or contact, or joint). `ROSTER` and `COMMANDS` have a row only where something changed. Everything that is not under
`/state` is there to look at.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np

from engine import CONTACT_RECORD, JOINT_RECORD

APPLICATION = "tumble"  # rerun's application id: which program a file belongs to
VERSION = 1  # of this schema; a reader refuses newer ones and knows all older ones

STEP_TIMELINE = "step"  # steps since the scene began
TIME_TIMELINE = "sim_time"  # simulated time, rounded to ns: to look at (STEPS.time is exact)

START = "/state/start"  # static: what the recording started from
START_TEXT = "tumble.Start:json"
START_SNAPSHOT = "tumble.Start:snapshot"
START_CHECKSUM = "tumble.Start:checksum"  # CRC-32 of the text, then the snapshot

END = "/state/end"  # static: written when the recording was closed
END_STEP = "tumble.End:last_step"

COMMANDS = "/state/commands"  # the commands applied just before a step, one JSON text each
COMMANDS_TEXT = "tumble.Commands:json"

CAMERA = "/world/camera"
CONTACT_POINTS = "/world/contacts"
IMPULSE_ARROWS = "/world/impulses"
JOINT_LINES = "/world/joints"

ENERGY = "/diagnostics/energy"
PENETRATION = "/diagnostics/penetration"
COUNTS = "/diagnostics/counts"
STAGE_TIMES = "/diagnostics/time_ms"
EVENTS = "/events"


class RecordingError(Exception):
    """A recording that cannot be written or read; the message is one line for the user."""


class Table(NamedTuple):
    """One entity of exact numbers: `dtype` is packed, one field a component."""

    path: str
    archetype: str
    dtype: np.dtype

    def component(self, field: str) -> str:
        """The component's name in the file, such as `tumble.Bodies:x`."""
        return f"{self.archetype}:{field}"


def _packed(dtype: np.dtype) -> np.dtype:
    """The same fields without padding, whose bytes would be random and spoil the checksum."""
    names: tuple[str, ...] = dtype.names or ()
    return np.dtype([(name, dtype[name]) for name in names])


BODIES = Table(
    "/state/bodies",
    "tumble.Bodies",
    np.dtype(
        [
            ("x", "f8"),  # [m]
            ("y", "f8"),
            ("angle", "f8"),  # unwrapped [rad]
            ("vx", "f8"),  # [m/s]
            ("vy", "f8"),
            ("w", "f8"),  # [rad/s]
        ]
    ),
)
ROSTER = Table(
    "/state/roster",
    "tumble.Roster",
    np.dtype(
        [
            ("serial", "i8"),
            ("body_kind", "u1"),  # index into engine.BODY_KINDS
            ("shape_kind", "u1"),  # index into engine.SHAPE_KINDS
            ("size1", "f8"),  # box: full width, circle: radius [m]
            ("size2", "f8"),  # box: full height, circle: 0 [m]
        ]
    ),
)
CONTACTS = Table("/state/contacts", "tumble.Contacts", _packed(CONTACT_RECORD))
JOINTS = Table("/state/joints", "tumble.Joints", _packed(JOINT_RECORD))
STEPS = Table(
    "/state/steps",
    "tumble.Steps",
    np.dtype(
        [
            ("time", "f8"),  # [s]
            ("dt", "f8"),  # [s]
            ("kinetic_energy", "f8"),  # [J]
            ("potential_energy", "f8"),  # [J]
            ("momentum_x", "f8"),  # [kg m/s]
            ("momentum_y", "f8"),
            ("angular_momentum", "f8"),  # [kg m^2/s]
            ("max_penetration", "f8"),  # [m]
            ("contact_count", "i8"),
            ("checksum", "u4"),  # CRC-32 of everything recorded of the step: rrd files have none of their own
        ]
    ),
)
EVERY_STEP = (BODIES, CONTACTS, JOINTS, STEPS)  # tables with a row for each step
TABLES = (*EVERY_STEP, ROSTER)


class DiagnosticsLike(Protocol):
    """engine.Diagnostics, by structure."""

    @property
    def kinetic_energy(self) -> float: ...
    @property
    def potential_energy(self) -> float: ...
    @property
    def momentum(self) -> tuple[float, float]: ...
    @property
    def angular_momentum(self) -> float: ...
    @property
    def max_penetration(self) -> float: ...
    @property
    def contact_count(self) -> int: ...


class StateLike(Protocol):
    """One step's state, recorded or computed again: what `compare` looks at. N bodies in the order of creation."""

    @property
    def step(self) -> int: ...
    @property
    def serials(self) -> np.ndarray: ...  # (N,) int64
    @property
    def positions(self) -> np.ndarray: ...  # (N, 2) [m]
    @property
    def angles(self) -> np.ndarray: ...  # (N,) [rad]
    @property
    def velocities(self) -> np.ndarray: ...  # (N, 2) [m/s]
    @property
    def angular_velocities(self) -> np.ndarray: ...  # (N,) [rad/s]
    @property
    def contacts(self) -> np.ndarray: ...  # (C,) CONTACT_RECORD
    @property
    def joints(self) -> np.ndarray: ...  # (J,) JOINT_RECORD


class FrameLike(StateLike, Protocol):
    """sandbox.frame.Frame, by structure: this package does not import the sandbox."""

    @property
    def time(self) -> float: ...  # [s]
    @property
    def dt(self) -> float: ...  # [s]
    @property
    def body_kinds(self) -> np.ndarray: ...  # (N,) uint8
    @property
    def shape_kinds(self) -> np.ndarray: ...  # (N,) uint8
    @property
    def sizes(self) -> np.ndarray: ...  # (N, 2) [m]
    @property
    def diagnostics(self) -> DiagnosticsLike: ...
    @property
    def stage_ms(self) -> Mapping[str, float]: ...
    @property
    def commands(self) -> tuple[dict[str, Any], ...]: ...


class StartLike(Protocol):
    """sandbox.recorder.RecordingStart, by structure: what a recording starts from."""

    @property
    def scene(self) -> str: ...
    @property
    def step(self) -> int: ...
    @property
    def time(self) -> float: ...  # [s]
    @property
    def dt(self) -> float: ...  # [s]
    @property
    def settings(self) -> Mapping[str, Any]: ...  # JSON-ready
    @property
    def snapshot(self) -> bytes: ...
    @property
    def hands(self) -> Mapping[str, Any]: ...  # JSON-ready
    @property
    def view(self) -> tuple[float, float, float]: ...  # centre x, y and height of what the camera shows [m]
    @property
    def version(self) -> str: ...
