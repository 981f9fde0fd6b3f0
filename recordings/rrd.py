"""The rrd container: walks a file's messages and decodes those of its recording.

rerun's own reader aborts the whole process on some single flipped bits, and stops at a message cut in the middle.
So this page reads the container itself, which is small:

    "RRF2", version (4 bytes), options (4 bytes), then messages: kind (u64), length (u64), payload

An arrow message's payload is a protobuf message with the fields 1 store id, 2 compression, 3 size before compression,
5 an arrow IPC stream.
The message of kind 0 is the footer: it is missing after a kill.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import pyarrow as pa

from recordings.schema import RecordingError

MAGIC = b"RRF2"
_HEADER_SIZE = 12
_END, _ARROW = 0, 2  # kinds of messages; the others name stores and blueprints
_TRAILER_SIZE = 32  # after the footer
_FOOTER_MAGIC = b"FOOT"
_LZ4 = 2  # compression
_RECORDING = 1  # kind of store; a blueprint is 2
_EXPANSION_LIMIT = 300  # LZ4 cannot compress better than 255 to 1: a greater size is a damaged one


class Chunk(NamedTuple):
    """One entity's rows: `batch` has a list column for each component and a column for each timeline."""

    path: str
    batch: pa.RecordBatch


def read_chunks(path: Path, application: str, under: str = "/") -> Iterator[Chunk]:
    """The chunks of the file's recording whose path starts with `under`, up to the last whole message.

    Raises:
        RecordingError: the file is no rrd, belongs to another application, or is damaged.
    """
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise RecordingError(f"{path}: not a rerun recording (.rrd)")
        ended = False
        for kind, size in _messages(file):
            if kind == _ARROW:
                chunk = _decode(path, file.read(size), application, under)
                if chunk is not None:
                    yield chunk
            ended = kind == _END
        if not ended and _has_trailer(file):
            raise RecordingError(f"{path}: damaged: its messages do not lead to its end")


def is_finished(path: Path) -> bool:
    """Whether the file has its very last bytes, those of a file that was closed."""
    with path.open("rb") as file:
        return _has_trailer(file)


def _messages(file: BinaryIO) -> Iterator[tuple[int, int]]:
    """Kind and size of every whole message; each time, the file stands at the payload."""
    end = os.fstat(file.fileno()).st_size
    at = _HEADER_SIZE
    while at + 16 <= end:
        file.seek(at)
        header = file.read(16)
        kind, size = int.from_bytes(header[:8], "little"), int.from_bytes(header[8:], "little")
        at += 16 + size
        if at > end or (kind == _END and end - at > _TRAILER_SIZE):
            return
        yield kind, size
        if kind == _END:
            return


def _has_trailer(file: BinaryIO) -> bool:
    """Whether the file's last bytes are those of a finished file: the trailer ends in the magic and a count (u32)."""
    size = len(_FOOTER_MAGIC) + 4
    file.seek(-min(size, os.fstat(file.fileno()).st_size), os.SEEK_END)
    return file.read().startswith(_FOOTER_MAGIC)


def _decode(path: Path, payload: bytes, application: str, under: str) -> Chunk | None:
    try:
        fields = _protobuf(payload)
        store = _protobuf(_bytes(fields[1]))
        if store.get(1) != _RECORDING:
            return None
        owner = _bytes(_protobuf(_bytes(store[3])).get(1, b"")).decode()
        if owner == application:
            return _decode_arrow(fields, under)
    except (KeyError, IndexError, OverflowError, StopIteration) as error:
        raise RecordingError(f"{path}: damaged: a message cannot be decoded") from error
    except (ValueError, OSError, pa.ArrowException) as error:
        reason = " ".join(str(error).split())
        raise RecordingError(f"{path}: damaged: a message cannot be decoded ({reason})") from error
    raise RecordingError(f"{path}: a recording of {owner!r}, not of {application}")


def _decode_arrow(fields: dict[int, int | bytes], under: str) -> Chunk | None:
    """The chunk in an arrow message, or None if its path does not start with `under`."""
    stream = _bytes(fields[5])
    if fields.get(2) == _LZ4:
        size = fields[3]
        if not isinstance(size, int) or size > len(stream) * _EXPANSION_LIMIT:
            raise ValueError("a message's size is wrong")
        stream = pa.decompress(stream, decompressed_size=size, codec="lz4_raw", asbytes=True)
    with pa.ipc.open_stream(stream) as reader:
        path = (reader.schema.metadata or {})[b"rerun:entity_path"].decode()
        if not path.startswith(under):
            return None
        batch = reader.read_next_batch()
    batch.validate(full=True)
    return Chunk(path, batch)


def _protobuf(data: bytes) -> dict[int, int | bytes]:
    """The fields of a protobuf message by number; of a repeated one the last."""
    fields: dict[int, int | bytes] = {}
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        number, wire = key >> 3, key & 7
        value: int | bytes
        if wire == 0:
            value, at = _varint(data, at)
        elif wire == 2:
            length, at = _varint(data, at)
            value = data[at : at + length]
            if len(value) != length:
                raise ValueError("a message ends early")
            at += length
        else:
            raise ValueError(f"a message has a field of unknown type {wire}")
        fields[number] = value
    return fields


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """The variable-length integer at `at`, and where it ends."""
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 127) << shift
        at += 1
        if byte < 128:
            return value, at
        shift += 7


def _bytes(value: int | bytes) -> bytes:
    if isinstance(value, bytes):
        return value
    raise ValueError("a message has a number where bytes belong")
