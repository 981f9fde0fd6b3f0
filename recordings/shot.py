"""What of a frame goes on disk: its tables, and a checksum over them."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from engine import Events
from recordings.protocols import FrameLike
from recordings.schema import BODIES, CONTACTS, CORNERS, HAPPENINGS, JOINTS, PIECES, ROSTER, SLEEP, STEPS

_OVERHEAD = 1024  # bytes a shot takes beside its arrays, roughly


@dataclass(frozen=True, slots=True)
class Shot:
    """A frame as the writer's thread gets it: nothing in it can change any more. N bodies of S pieces."""

    step: int
    time: float  # [s]
    dt: float  # [s]
    serials: np.ndarray  # (N,) int64
    body_kinds: np.ndarray  # (N,) uint8
    positions: np.ndarray  # (N, 2) [m]
    angles: np.ndarray  # (N,) [rad]
    velocities: np.ndarray  # (N, 2) [m/s]
    angular_velocities: np.ndarray  # (N,) [rad/s]
    asleep: np.ndarray  # (N,) bool
    shape_serials: np.ndarray  # (S,) int64
    owners: np.ndarray  # (S,) int64, index of its body
    shape_kinds: np.ndarray  # (S,) uint8
    sizes: np.ndarray  # (S, 2) [m]
    places: np.ndarray  # (S, 3) [m, m, rad]
    corner_counts: np.ndarray  # (S,) uint8
    corners: np.ndarray  # (sum of the counts, 2) [m]
    contacts: np.ndarray  # (C,)
    joints: np.ndarray  # (J,)
    events: Events
    diagnostics: tuple[float, float, float, float, float, float, int]  # in the order of STEPS
    stage_ms: dict[str, float]  # [ms]
    commands: tuple[str, ...]  # one JSON text each

    @property
    def nbytes(self) -> int:
        """Memory that this shot holds, roughly [bytes]."""
        bodies, pieces = 58 * len(self.serials), 58 * len(self.shape_serials)
        events = sum(rows.nbytes for rows in self.events)
        return _OVERHEAD + bodies + pieces + events + self.corners.nbytes + self.contacts.nbytes + self.joints.nbytes


def take(frame: FrameLike) -> Shot:
    """The frame's shot. Arrays that nobody can write to are taken as they are, others are copied."""
    d = frame.diagnostics
    return Shot(
        step=int(frame.step),
        time=float(frame.time),
        dt=float(frame.dt),
        serials=_settled(frame.serials),
        body_kinds=_settled(frame.body_kinds),
        positions=_settled(frame.positions),
        angles=_settled(frame.angles),
        velocities=_settled(frame.velocities),
        angular_velocities=_settled(frame.angular_velocities),
        asleep=_settled(frame.asleep),
        shape_serials=_settled(frame.shape_serials),
        owners=_settled(frame.owners),
        shape_kinds=_settled(frame.shape_kinds),
        sizes=_settled(frame.sizes),
        places=_settled(frame.places),
        corner_counts=_settled(frame.corner_counts),
        corners=_settled(frame.corners),
        contacts=_settled(frame.contacts),
        joints=_settled(frame.joints),
        events=Events(*map(_settled, frame.events)),
        diagnostics=(
            d.kinetic_energy,
            d.potential_energy,
            d.momentum[0],
            d.momentum[1],
            d.angular_momentum,
            d.max_penetration,
            d.contact_count,
        ),
        stage_ms=dict(frame.stage_ms),
        commands=tuple(json.dumps(command) for command in frame.commands) if frame.commands else (),
    )


def _settled(array: np.ndarray) -> np.ndarray:
    """The array itself if it and what it looks into are read-only, else a copy."""
    base = array.base
    frozen = not array.flags.writeable and (base is None or (isinstance(base, np.ndarray) and not base.flags.writeable))
    return array if frozen else array.copy()


def body_rows(shots: list[Shot]) -> np.ndarray:
    """The BODIES table of all shots, one after the other."""
    rows = np.empty(sum(len(shot.serials) for shot in shots), BODIES.dtype)
    numbers = rows.view(np.float64).reshape(-1, 6)
    np.concatenate([shot.positions for shot in shots], out=numbers[:, 0:2])
    np.concatenate([shot.angles for shot in shots], out=numbers[:, 2])
    np.concatenate([shot.velocities for shot in shots], out=numbers[:, 3:5])
    np.concatenate([shot.angular_velocities for shot in shots], out=numbers[:, 5])
    return rows


def sleep_rows(shots: list[Shot]) -> np.ndarray:
    """The SLEEP table of all shots, one after the other."""
    return np.concatenate([shot.asleep for shot in shots]).astype(np.uint8).view(SLEEP.dtype)


def contact_rows(shots: list[Shot]) -> np.ndarray:
    """The CONTACTS table of all shots, one after the other."""
    return np.concatenate([shot.contacts for shot in shots]).astype(CONTACTS.dtype, copy=False)


def joint_rows(shots: list[Shot]) -> np.ndarray:
    """The JOINTS table of all shots, one after the other."""
    return np.concatenate([shot.joints for shot in shots]).astype(JOINTS.dtype, copy=False)


def roster_rows(shot: Shot) -> np.ndarray:
    """The ROSTER table of one shot, (N,)."""
    rows = np.empty(len(shot.serials), ROSTER.dtype)
    rows["serial"], rows["body_kind"] = shot.serials, shot.body_kinds
    return rows


def piece_rows(shot: Shot) -> np.ndarray:
    """The PIECES table of one shot, (S,)."""
    rows = np.empty(len(shot.shape_serials), PIECES.dtype)
    rows["serial"], rows["owner"] = shot.shape_serials, shot.serials[shot.owners]
    rows["shape_kind"], rows["corner_count"] = shot.shape_kinds, shot.corner_counts
    rows["size1"], rows["size2"] = shot.sizes.T
    rows["x"], rows["y"], rows["angle"] = shot.places.T
    return rows


def corner_rows(shot: Shot) -> np.ndarray:
    """The CORNERS table of one shot."""
    rows = np.empty(len(shot.corners), CORNERS.dtype)
    rows["x"], rows["y"] = shot.corners.T
    return rows


def event_rows(events: Events) -> dict[str, np.ndarray]:
    """The rows of one step for every table in HAPPENINGS."""
    found = {}
    for kind, table in HAPPENINGS.items():
        found[kind] = np.empty(len(getattr(events, kind)), table.dtype)
        for name in table.dtype.names or ():
            found[kind][name] = getattr(events, kind)[name]
    return found


def happened_parts(rows: dict[str, np.ndarray]) -> list[np.ndarray]:
    """What takes part in the checksum of a step: nothing where nothing happened, as before there were events."""
    return list(rows.values()) if any(map(len, rows.values())) else []


def step_rows(shots: list[Shot]) -> np.ndarray:
    """The STEPS table of all shots, (K,), its checksums still zero."""
    return np.array([(shot.time, shot.dt, *shot.diagnostics, 0) for shot in shots], STEPS.dtype)


def checksum(step: int, parts: Iterable[np.ndarray], commands: Iterable[str]) -> int:
    """CRC-32 of one step: its number, its rows of every table in EVERY_STEP, its content, its events, its commands.

    The STEPS row takes part with its checksum set to zero. The content is what `content_checksum` gives; in version 1
    it was the roster itself.
    """
    value = zlib.crc32(step.to_bytes(8, "little", signed=True))
    for part in parts:
        value = _more(value, part)
    for text in commands:
        value = zlib.crc32(text.encode(), value)
    return value


def content_checksum(parts: Iterable[np.ndarray]) -> np.ndarray:
    """(1,) uint32: CRC-32 of the rows of every table in ON_CHANGE, made once for all steps that have them."""
    value = 0
    for part in parts:
        value = _more(value, part)
    return np.array([value], np.uint32)


def _more(value: int, part: np.ndarray) -> int:
    value = zlib.crc32(len(part).to_bytes(8, "little"), value)
    return zlib.crc32(part.view(np.uint8).data, value)
