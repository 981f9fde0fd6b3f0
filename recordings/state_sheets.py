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
from recordings.shot import Shot, body_rows, checksum, contact_rows, joint_rows, roster_rows, step_rows


class StateSheets:
    """Turns blocks into sheets; remembers which bodies there are."""

    def __init__(self) -> None:
        self._roster = np.empty(0, schema.ROSTER.dtype)

    def sheets(self, shots: list[Shot], every_run: list[Run]) -> Iterator[Sheet]:
        """Rosters and commands first, where there are new ones; the checksums last."""
        rosters: list[np.ndarray] = []
        for run in every_run:
            if run.changed:
                self._roster = roster_rows(run.shots[0])
            rosters.extend([self._roster] * len(run.shots))
        firsts = [run.first for run in every_run if run.changed]
        if firsts:
            new = [rosters[i] for i in firsts]
            yield _table_sheet(schema.ROSTER, [shots[i] for i in firsts], np.concatenate(new), [len(r) for r in new])
        commanded = [shot for shot in shots if shot.commands]
        if commanded:
            yield _commands_sheet(commanded)
        yield from _every_step_sheets(shots, rosters)


def _every_step_sheets(shots: list[Shot], rosters: list[np.ndarray]) -> Iterator[Sheet]:
    """The tables that have a row for each step."""
    tables = [body_rows(shots), contact_rows(shots), joint_rows(shots), step_rows(shots)]
    lengths = [
        [len(shot.serials) for shot in shots],
        [len(shot.contacts) for shot in shots],
        [len(shot.joints) for shot in shots],
        [1] * len(shots),
    ]
    ends = [np.cumsum(of_table) for of_table in lengths]
    for i, shot in enumerate(shots):
        parts = [rows[end[i] - count[i] : end[i]] for rows, end, count in zip(tables, ends, lengths, strict=True)]
        tables[-1]["checksum"][i] = checksum(shot.step, [*parts, rosters[i]], shot.commands)
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
