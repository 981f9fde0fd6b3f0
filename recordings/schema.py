"""What a recording holds and where: entity paths, tables with their columns, versions.

A table is one entity of the file with one component a field; each step has one row of it, which holds one value a body
(or contact, or joint). The tables `ON_CHANGE`, `COMMANDS`, and those in `HAPPENINGS` have a row only where something
changed or happened. Everything that is not under `/state` is there to look at.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine import CONTACT_RECORD, JOINT_RECORD
from engine.events import DTYPES

APPLICATION = "tumble"  # rerun's application id: which program a file belongs to
VERSION = 3  # of this schema; a reader refuses newer ones and knows all older ones. 1: every body had one shape;
# 2: no events, one kind of joint, and not told who sleeps

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
HIT_POINTS = "/world/hits"

ENERGY = "/diagnostics/energy"
PENETRATION = "/diagnostics/penetration"
COUNTS = "/diagnostics/counts"
STAGE_TIMES = "/diagnostics/time_ms"
EVENTS = "/events"  # the log of commands
HAPPENED = "/happened"  # the log of what begins, hits, breaks ...


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
SLEEP = Table("/state/sleep", "tumble.Sleep", np.dtype([("asleep", "u1")]))  # 1: the body sleeps
ROSTER = Table(
    "/state/roster",
    "tumble.Roster",
    np.dtype(
        [
            ("serial", "i8"),
            ("body_kind", "u1"),  # index into engine.BODY_KINDS
        ]
    ),
)
PIECES = Table(
    "/state/pieces",
    "tumble.Pieces",
    np.dtype(
        [
            ("serial", "i8"),
            ("owner", "i8"),  # serial of its body
            ("shape_kind", "u1"),  # index into engine.SHAPE_KINDS
            ("size1", "f8"),  # as sandbox.frame.Frame.sizes has them [m]
            ("size2", "f8"),
            ("x", "f8"),  # place of its own frame in that of its body [m]
            ("y", "f8"),
            ("angle", "f8"),  # [rad]
            ("corner_count", "u1"),  # of a polygon
        ]
    ),
)
CORNERS = Table(
    "/state/corners",
    "tumble.Corners",
    np.dtype(
        [
            ("x", "f8"),  # in the piece's own frame; one polygon's after another's, in the order of the pieces [m]
            ("y", "f8"),
        ]
    ),
)
ROSTER_1 = Table(  # of version 1
    ROSTER.path,
    ROSTER.archetype,
    np.dtype([("serial", "i8"), ("body_kind", "u1"), ("shape_kind", "u1"), ("size1", "f8"), ("size2", "f8")]),
)
CONTACTS = Table("/state/contacts", "tumble.Contacts", _packed(CONTACT_RECORD))
JOINTS = Table("/state/joints", "tumble.Joints", _packed(JOINT_RECORD))
JOINTS_2 = Table(  # of versions 1 and 2
    JOINTS.path,
    JOINTS.archetype,
    np.dtype([(name, JOINTS.dtype[name]) for name in JOINTS.dtype.names or () if name not in ("turn_impulse", "kind")]),
)
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
EVERY_STEP = (BODIES, SLEEP, CONTACTS, JOINTS, STEPS)  # tables with a row for each step
EVERY_STEP_2 = (BODIES, CONTACTS, JOINTS_2, STEPS)  # of versions 1 and 2
ON_CHANGE = (ROSTER, PIECES, CORNERS)  # tables with a row where bodies or shapes came or went, all of them then


def _stored(kind: str, dtype: np.dtype) -> Table:
    """Events of a kind without what the step says already: its number, and where bodies are after it."""
    known = ("step", "x", "y", "angle") if kind == "moved" else ("step",)
    names = [name for name in dtype.names or () if name not in known]
    return Table(f"/state/events/{kind}", f"tumble.Events.{kind}", np.dtype([(name, dtype[name]) for name in names]))


HAPPENINGS = {kind: _stored(kind, dtype) for kind, dtype in DTYPES.items()}  # a row where some happened in a step
