"""What a recording starts from: exact and with a checksum under `/state/start`, readable as properties of the file."""

from __future__ import annotations

import json
import platform
import zlib
from typing import Any

import numpy as np
import pyarrow as pa
import rerun as rr

from recordings import schema
from recordings.columns import batch
from recordings.protocols import StartLike
from recordings.rrd import Chunk
from recordings.schema import RecordingError


def start_batches(start: StartLike) -> list[rr.DescribedComponentBatch]:
    """The start as JSON, in which floats come back bit for bit, its snapshot as bytes, and a checksum over both."""
    fields = {
        "schema": schema.VERSION,
        "version": start.version,
        "scene": start.scene,
        "step": start.step,
        "time": start.time,
        "dt": start.dt,
        "settings": dict(start.settings),
        "hands": dict(start.hands),
        "view": list(start.view),
    }
    text = json.dumps(fields)
    return [
        batch(schema.START_TEXT, pa.array([text])),
        batch(schema.START_SNAPSHOT, pa.array([start.snapshot], pa.binary())),
        batch(schema.START_CHECKSUM, pa.array([_checksum(text, start.snapshot)], pa.uint32())),
    ]


def property_batches(start: StartLike) -> list[rr.DescribedComponentBatch]:
    """What the file tells about itself when it is selected in the viewer."""
    facts: dict[str, object] = {
        "scene": start.scene,
        "tumble": start.version,
        "schema": schema.VERSION,
        "dt": start.dt,
        "first_step": start.step,
        "numpy": np.__version__,
        "rerun": rr.__version__,
        "python": platform.python_version(),
        "machine": platform.machine(),
    }
    facts |= {f"settings_{name}": value for name, value in start.settings.items()}
    return [batch(f"tumble.Recording:{name}", pa.array([str(value)])) for name, value in facts.items()]


def parse_start(path: object, chunks: list[Chunk]) -> tuple[dict[str, Any], bytes]:
    """The start's fields and its snapshot; `path` names the file in errors."""
    if not chunks:
        raise RecordingError(f"{path}: no recording of tumble, or cut before its start")
    batch = chunks[0].batch
    try:
        text, snapshot, expected = (
            batch.column(name)[0][0].as_py()
            for name in (schema.START_TEXT, schema.START_SNAPSHOT, schema.START_CHECKSUM)
        )
        fields = json.loads(text)
        written_as = fields["schema"]
        intact = _checksum(text, snapshot) == expected
    except (KeyError, IndexError, TypeError, ValueError, pa.ArrowException) as error:
        raise RecordingError(f"{path}: damaged at its start") from error
    if not intact:
        raise RecordingError(f"{path}: damaged at its start")
    if written_as > schema.VERSION:
        newest = f"this one reads up to {schema.VERSION}"
        raise RecordingError(f"{path}: written by a newer tumble (recording schema {written_as}; {newest})")
    return fields, snapshot


def _checksum(text: str, snapshot: bytes) -> int:
    return zlib.crc32(snapshot, zlib.crc32(text.encode()))
