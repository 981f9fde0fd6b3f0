"""The exact part of a recording: blocks of shots as sheets under `/state`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pyarrow as pa
import rerun as rr

from recordings import schema
from recordings.columns import Sheet, column, table_columns, time_columns
from recordings.roster import Run
from recordings.schema import Table
from recordings.shot import (
    Shot,
    body_rows,
    checksum,
    contact_rows,
    content_checksum,
    corner_rows,
    event_rows,
    happened_parts,
    joint_rows,
    piece_rows,
    roster_rows,
    sleep_rows,
    step_rows,
)


class StateSheets:
    """Turns blocks into sheets; remembers what there is."""

    def __init__(self) -> None:
        self._content = content_checksum(())

    def sheets(self, shots: list[Shot], every_run: list[Run]) -> Iterator[Sheet]:
        """Content and commands first, where there is something new; the checksums last."""
        contents: list[np.ndarray] = []
        new: list[tuple[Shot, list[np.ndarray]]] = []
        for run in every_run:
            if run.changed:
                new.append((run.shots[0], content_rows(run.shots[0])))
                self._content = content_checksum(new[-1][1])
            contents.extend([self._content] * len(run.shots))
        if new:
            firsts = [shot for shot, _ in new]
            for table, *every in zip(schema.ON_CHANGE, *(rows for _, rows in new), strict=True):
                yield _table_sheet(table, firsts, np.concatenate(every), [len(rows) for rows in every])
        commanded = [shot for shot in shots if shot.commands]
        if commanded:
            yield _commands_sheet(commanded)
        happened = [event_rows(shot.events) for shot in shots]
        yield from _happening_sheets(shots, happened)
        yield from _every_step_sheets(shots, contents, happened)


def content_rows(shot: Shot) -> list[np.ndarray]:
    """The rows of every table in ON_CHANGE."""
    return [roster_rows(shot), piece_rows(shot), corner_rows(shot)]


def _happening_sheets(shots: list[Shot], happened: list[dict[str, np.ndarray]]) -> Iterator[Sheet]:
    """The tables of events, where there are some."""
    for kind, table in schema.HAPPENINGS.items():
        found = [(shot, rows[kind]) for shot, rows in zip(shots, happened, strict=True) if len(rows[kind])]
        if found:
            own, rows = zip(*found, strict=True)
            yield _table_sheet(table, list(own), np.concatenate(rows), [len(part) for part in rows])


def _every_step_sheets(
    shots: list[Shot], contents: list[np.ndarray], happened: list[dict[str, np.ndarray]]
) -> Iterator[Sheet]:
    """The tables that have a row for each step."""
    tables = [body_rows(shots), sleep_rows(shots), contact_rows(shots), joint_rows(shots), step_rows(shots)]
    lengths = [
        [len(shot.serials) for shot in shots],
        [len(shot.asleep) for shot in shots],
        [len(shot.contacts) for shot in shots],
        [len(shot.joints) for shot in shots],
        [1] * len(shots),
    ]
    ends = [np.cumsum(of_table) for of_table in lengths]
    for i, shot in enumerate(shots):
        parts = [rows[end[i] - count[i] : end[i]] for rows, end, count in zip(tables, ends, lengths, strict=True)]
        tables[-1]["checksum"][i] = checksum(
            shot.step, [*parts, contents[i], *happened_parts(happened[i])], shot.commands
        )
    for table, rows, of_table in zip(schema.EVERY_STEP, tables, lengths, strict=True):
        yield _table_sheet(table, shots, rows, of_table)


def _commands_sheet(shots: list[Shot]) -> Sheet:
    texts = pa.array([text for shot in shots for text in shot.commands])
    lengths = np.array([len(shot.commands) for shot in shots])
    return Sheet(schema.COMMANDS, _times(shots), [column(schema.COMMANDS_TEXT, texts, lengths)])


def _table_sheet(table: Table, shots: list[Shot], rows: np.ndarray, lengths: list[int]) -> Sheet:
    return Sheet(table.path, _times(shots), table_columns(table, rows, np.array(lengths)))


def _times(shots: list[Shot]) -> list[rr.TimeColumn]:
    return time_columns([shot.step for shot in shots], [shot.time for shot in shots])
