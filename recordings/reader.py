"""Gives a recording back bit for bit, also one that a kill left behind."""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path

import numpy as np
import pyarrow as pa

from recordings import schema
from recordings.checks import check_steps, whole_content
from recordings.older import nobody_asleep, pinned, upgraded
from recordings.recording import Recording, contiguous
from recordings.rrd import Chunk, is_finished, read_chunks
from recordings.schema import RecordingError
from recordings.start import parse_start
from recordings.stored_table import StoredTable, gather


def read(path: Path | str) -> Recording:
    """Reads a recording and checks every step of it.

    A file cut short, by a kill or a full disk, gives the steps up to the last whole block, and is not `whole`.

    Raises:
        RecordingError: the file is missing, no recording of tumble, too new, or damaged. The message is one line.
    """
    path = Path(path)
    chunks, finished = _content(path)
    start, snapshot = parse_start(path, chunks[schema.START])
    commands = _commands(path, chunks[schema.COMMANDS])
    on_change = (schema.ROSTER_1,) if start["schema"] == 1 else schema.ON_CHANGE
    every_step = schema.EVERY_STEP_2 if start["schema"] < 3 else schema.EVERY_STEP
    every = (*every_step, *on_change, *schema.HAPPENINGS.values())
    tables = {table.path: gather(path, table, chunks[table.path]) for table in every}
    stored_steps = _whole_steps(path, tables, every_step, start["step"])
    closed = _is_closed(path, chunks[schema.END], stored_steps)
    if start["schema"] == 1:
        check_steps(path, tables, every_step, commands, tables[schema.ROSTER.path])
        tables |= upgraded(tables[schema.ROSTER.path])
    else:
        check_steps(path, tables, every_step, commands, whole_content(path, tables))
    if start["schema"] < 3:
        tables |= nobody_asleep(tables[schema.BODIES.path])
        tables |= pinned(tables[schema.JOINTS.path])
    numbers = tables[schema.STEPS.path].rows[1:]
    return Recording(
        path=path,
        whole=closed and finished,
        scene=start["scene"],
        version=start["version"],
        schema=start["schema"],
        dt=start["dt"],
        start_step=start["step"],
        start_time=start["time"],
        settings=start["settings"],
        hands=start["hands"],
        view=tuple(start["view"]),
        snapshot=snapshot,
        steps=contiguous(stored_steps[1:]),
        times=contiguous(numbers["time"]),
        diagnostics=numbers,
        commands={step: [json.loads(text) for text in texts] for step, texts in commands.items()},
        _tables=tables,
    )


def _content(path: Path) -> tuple[dict[str, list[Chunk]], bool]:
    """The chunks under /state by their paths, and whether the file has its end."""
    chunks: dict[str, list[Chunk]] = defaultdict(list)
    try:
        for chunk in read_chunks(path, schema.APPLICATION, under="/state/"):
            chunks[chunk.path].append(chunk)
        return chunks, is_finished(path)
    except FileNotFoundError:
        raise RecordingError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise RecordingError(f"{path}: a folder, not a recording") from None
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read: {error.strerror}") from error


def _commands(path: Path, chunks: list[Chunk]) -> dict[int, list[str]]:
    """The JSON texts of each step that has some."""
    commands: dict[int, list[str]] = {}
    try:
        for chunk in chunks:
            steps = chunk.batch.column(schema.STEP_TIMELINE).to_pylist()
            commands.update(zip(steps, chunk.batch.column(schema.COMMANDS_TEXT).to_pylist(), strict=True))
    except (KeyError, ValueError, pa.ArrowException) as error:
        raise RecordingError(f"{path}: damaged in its commands") from error
    return commands


def _whole_steps(
    path: Path, tables: dict[str, StoredTable], every_step: tuple[schema.Table, ...], start_step: int
) -> np.ndarray:
    """The steps that every table has; the rest, which a kill cut off, is dropped from all tables."""
    counts = []
    for table in every_step:
        steps = tables[table.path].steps
        if not np.array_equal(steps, np.arange(start_step, start_step + len(steps))):
            raise RecordingError(f"{path}: damaged: steps are missing in {table.path}")
        counts.append(len(steps))
    for table in every_step:
        tables[table.path] = tables[table.path].first(min(counts))
    steps = tables[schema.STEPS.path].steps
    for table in (*schema.ON_CHANGE, *schema.HAPPENINGS.values()):
        if table.path in tables:
            begun = tables[table.path]
            tables[table.path] = begun.first(int(np.searchsorted(begun.steps, steps[-1], "right")) if len(steps) else 0)
    return steps


def _is_closed(path: Path, chunks: list[Chunk], steps: np.ndarray) -> bool:
    """Whether the writer closed the recording, which then knows its last step."""
    for chunk in chunks:
        try:
            last = chunk.batch.column(schema.END_STEP)[0][0].as_py()
        except (KeyError, IndexError, TypeError, pa.ArrowException) as error:
            raise RecordingError(f"{path}: damaged at its end") from error
        if not len(steps) or steps[-1] != last:
            raise RecordingError(f"{path}: damaged: its last steps are missing")
    return bool(chunks)
