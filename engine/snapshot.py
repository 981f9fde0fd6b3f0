"""Snapshots: a copy of all tables, as an object and as bytes. And the hash of what physics means."""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from dataclasses import dataclass

import numpy as np

from engine.settings import Settings
from engine.state import State
from engine.tables import ALONG_NOTHING

MAGIC = b"tumble snapshot 3\n"


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Everything a later step depends on: tables and settings. World.restore takes it back, in any world."""

    settings: Settings
    tables: dict[str, np.ndarray]

    def to_bytes(self) -> bytes:
        """A self-contained file: a line of magic, a checksum, then numpy's own format."""
        stream = io.BytesIO()
        settings = np.frombuffer(json.dumps(self.settings.to_dict()).encode(), np.uint8)
        np.savez(stream, allow_pickle=False, settings=settings, **self.tables)
        body = stream.getvalue()
        return MAGIC + hashlib.sha256(body).digest() + body

    @classmethod
    def from_bytes(cls, data: bytes) -> Snapshot:
        """What `to_bytes` gave. ValueError if it is something else or damaged."""
        start = len(MAGIC) + hashlib.sha256().digest_size
        if not isinstance(data, (bytes, bytearray)) or data[: len(MAGIC)] != MAGIC:
            raise ValueError("snapshot: must be one that tumble wrote")
        if hashlib.sha256(data[start:]).digest() != data[len(MAGIC) : start]:
            raise ValueError("snapshot: must be whole, this one is damaged")
        try:
            with np.load(io.BytesIO(data[start:]), allow_pickle=False) as stored:
                tables = {name: stored[name] for name in stored.files}
            settings = Settings.from_dict(json.loads(tables.pop("settings").tobytes()))
        except (KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
            raise ValueError(f"snapshot: must be one of this version of tumble ({error})") from None
        return cls(settings, tables)


def state_hash(state: State) -> str:
    """64 hex digits over what physics means; equal for equal futures, whatever the capacity, padding or serials.

    In the order of creation: bodies' position, angle, velocity and sleep state, then the accumulated impulses of
    contacts and of joints, with their keys. -0.0 counts as 0.0.
    """
    order = state.bodies.order
    bodies = state.bodies.tables["bodies"][order]
    motions = state.bodies.tables["motions"][order]
    serials = bodies["serial"]
    digest = hashlib.sha256()

    def add(values: np.ndarray, dtype: str) -> None:
        # adding zero turns -0.0 into 0.0; little-endian whatever the machine
        digest.update(np.ascontiguousarray(values + np.zeros((), values.dtype), dtype).tobytes())

    add(np.array([len(order)]), "<i8")
    for table, names in ((bodies, ("x", "y", "angle")), (motions, ("vx", "vy", "w"))):
        for name in names:
            add(table[name], "<f8")
    asleep = state.bodies.columns.get("asleep")
    add(np.zeros(len(order)) if asleep is None else asleep[order], "<f8")
    table = state.arbiters
    touching = np.flatnonzero(table.rows["count"][: table.count])
    arbiters, contacts = table.rows[touching], table.contacts[touching]
    shapes = state.shapes.tables["shapes"]["serial"][state.shapes.order]
    for name in ("serial1", "serial2"):
        add(np.searchsorted(shapes, arbiters[name]), "<i8")
    add(arbiters["count"], "<i8")
    add(arbiters["rolling_impulse"], "<f8")
    for k in range(2):
        there = contacts[arbiters["count"] > k, k]
        add(there["feature"], "<i8")
        for name in ("normal_impulse", "tangent_impulse"):
            add(there[name], "<f8")
    joints = state.joints.tables["joints"][state.joints.order]
    for name in ("body1", "body2"):
        add(np.searchsorted(serials, state.bodies.tables["bodies"]["serial"][joints[name]]), "<i8")
    for name in ("impulse_x", "impulse_y"):
        add(joints[name], "<f8")
    for part in ("turns", "slides"):
        rows = state.joints.tables[part][state.joints.order]
        rows = rows[rows["along"] != ALONG_NOTHING]  # so that joints without any are hashed as they always were
        for name in ("spring_impulse", "motor_impulse", "lower_impulse", "upper_impulse"):
            add(rows[name], "<f8")
    return digest.hexdigest()
