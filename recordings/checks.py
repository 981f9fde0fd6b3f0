"""Whether what came out of a file is what went in: every step's checksum, and pieces that belong to bodies."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recordings import schema
from recordings.schema import RecordingError
from recordings.shot import checksum, content_checksum, happened_parts
from recordings.stored_table import StoredTable


def whole_content(path: Path, tables: dict[str, StoredTable]) -> StoredTable:
    """What takes part in the checksums of the steps that have it: one number for each entry of the content's tables.

    Raises:
        RecordingError: the tables do not fit together.
    """
    roster, pieces, corners = (tables[table.path] for table in schema.ON_CHANGE)
    if not (np.array_equal(roster.steps, pieces.steps) and np.array_equal(roster.steps, corners.steps)):
        raise RecordingError(f"{path}: damaged: what bodies look like is missing")
    sums = [np.zeros(0, np.uint32)]
    for step in map(int, roster.steps):
        bodies, own, points = roster.at(step), pieces.at(step), corners.at(step)
        in_order = np.all(np.diff(bodies["serial"]) > 0) and np.isin(own["owner"], bodies["serial"]).all()
        if not in_order or own["corner_count"].sum(dtype=np.int64) != len(points):
            raise RecordingError(f"{path}: damaged at step {step}")
        sums.append(content_checksum([bodies, own, points]))
    return StoredTable(roster.steps, np.arange(len(roster.steps) + 1), np.concatenate(sums))


def check_steps(
    path: Path,
    tables: dict[str, StoredTable],
    every_step: tuple[schema.Table, ...],
    commands: dict[int, list[str]],
    content: StoredTable,
) -> None:
    """Compares each step's checksum with its content, and drops the commands of steps that were cut off.

    every_step: the tables that have a row for each step, bodies first and the steps' own last.

    Raises:
        RecordingError: they differ.
    """
    steps = tables[schema.STEPS.path].steps
    for step in [step for step in commands if not len(steps) or step > steps[-1]]:
        del commands[step]
    for step in map(int, steps):
        parts = [tables[table.path].at(step) for table in every_step]
        numbers = parts[-1].copy()
        bodies = len(tables[schema.ROSTER.path].at(step))
        of_bodies = [
            len(rows) for rows, table in zip(parts, every_step, strict=True) if table in (schema.BODIES, schema.SLEEP)
        ]
        if len(numbers) != 1 or any(number != bodies for number in of_bodies):
            raise RecordingError(f"{path}: damaged at step {step}")
        expected = int(numbers["checksum"][0])
        numbers["checksum"] = 0
        happened = {kind: tables[table.path].exactly(step) for kind, table in schema.HAPPENINGS.items()}
        if not np.isin(happened["moved"]["body"], tables[schema.ROSTER.path].at(step)["serial"]).all():
            raise RecordingError(f"{path}: damaged at step {step}")
        own = [*parts[:-1], numbers, content.at(step), *happened_parts(happened)]
        if checksum(step, own, commands.get(step, [])) != expected:
            raise RecordingError(f"{path}: damaged at step {step}")
