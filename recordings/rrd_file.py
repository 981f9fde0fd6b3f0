"""The file being written: opens it, sends blocks of shots to it, and makes sure that they arrived."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pyarrow as pa
import rerun as rr
from rerun_bindings import flush_and_cleanup_orphaned_recordings

from recordings import schema
from recordings.blueprint import layout, stage_lines, static_entities
from recordings.bodies_view import BodiesView
from recordings.columns import Sheet, batch
from recordings.diagnostics_view import MarksView, PlotsView, event_sheets
from recordings.events_view import HitsView, happened_sheets
from recordings.piped_file import PipedFile
from recordings.protocols import StartLike
from recordings.roster import Run, runs
from recordings.schema import RecordingError
from recordings.shot import Shot
from recordings.start import property_batches, start_batches
from recordings.state_sheets import StateSheets

_FLUSH_SECONDS = 30.0  # a disk that takes longer counts as failed


class RrdFile:
    """One rrd file. All but the constructor runs on the writing thread."""

    def __init__(self, path: Path, start: StartLike) -> None:
        self._path = path
        self._previous: Shot | None = None
        self._state = StateSheets()
        self._bodies = BodiesView(start.view[2])
        self._marks = MarksView(start.view[2])
        self._plots = PlotsView()
        self._hits = HitsView(start.view[2])
        self._stage_count = 0
        try:
            self._disk = PipedFile(path)
        except FileNotFoundError:
            raise RecordingError(f"cannot write {path}: its folder does not exist") from None
        except OSError as error:
            raise _refusal(path, error) from error
        self._stream = rr.RecordingStream(schema.APPLICATION)
        self._stream.save(self._disk.inlet)
        self._disk.opened()
        self._send_start(start)
        self._flush()

    def write(self, shots: list[Shot]) -> None:
        """Sends a block and waits until the system has it: a kill cannot take it back."""
        every_run = list(runs(self._previous, shots))
        self._send_sheets(self._state.sheets(shots, every_run))
        with np.errstate(all="ignore"):  # numbers too large for the picture are still in the state
            self._send_picture(shots, every_run)
        self._previous = shots[-1]
        self._flush()

    def finish(self) -> None:
        """Writes the footer and waits until the disk has everything."""
        if self._previous is not None:
            self._log_static(schema.END, [batch(schema.END_STEP, pa.array([self._previous.step]))])
        self._flush()
        self._end()

    def abandon(self) -> None:
        """Lets go of the file after an error."""
        with contextlib.suppress(RecordingError):
            self._end()

    def _end(self) -> None:
        self._stream.disconnect()
        del self._stream
        flush_and_cleanup_orphaned_recordings()  # as rr.init does: without it, two of rerun's threads stay for ever
        try:
            self._disk.close(_FLUSH_SECONDS)
        except OSError as error:
            raise _refusal(self._path, error) from error

    def _send_start(self, start: StartLike) -> None:
        self._stream.send_recording_name(start.scene)
        self._stream.send_blueprint(layout(), make_active=True, make_default=True)
        self._log_static(schema.START, start_batches(start))
        self._stream.send_property("tumble", property_batches(start))
        for path, archetype in static_entities(start.view):
            self._log_static(path, archetype)

    def _send_picture(self, shots: list[Shot], every_run: list[Run]) -> None:
        """The part to look at."""
        for run in every_run:
            self._send_sheets(self._bodies.sheets(run))
        for sheets in (self._marks.sheets(shots), self._plots.sheets(shots), event_sheets(shots)):
            self._send_sheets(sheets)
        for sheets in (self._hits.sheets(shots), happened_sheets(shots)):
            self._send_sheets(sheets)
        if len(self._plots.stages) != self._stage_count:
            self._stage_count = len(self._plots.stages)
            self._log_static(schema.STAGE_TIMES, stage_lines(self._plots.stages))

    def _send_sheets(self, sheets: Iterable[Sheet]) -> None:
        for sheet in sheets:
            rr.send_columns(sheet.path, sheet.times, sheet.columns, recording=self._stream, strict=True)

    def _log_static(self, path: str, components: rr.AsComponents | Iterable[rr.DescribedComponentBatch]) -> None:
        rr.log(path, components, static=True, recording=self._stream, strict=True)

    def _flush(self) -> None:
        """Waits until the system has everything, in the file that the user sees."""
        try:
            self._stream.flush(timeout_sec=_FLUSH_SECONDS)
            self._disk.settle(_FLUSH_SECONDS)
        except Exception as error:  # rerun has no narrower class for a flush that takes too long
            raise _refusal(self._path, error) from error


def _refusal(path: Path, error: Exception) -> RecordingError:
    """One line with the system's own words, such as `No space left on device`."""
    reason = (isinstance(error, OSError) and error.strerror) or " ".join(str(error).split()) or type(error).__name__
    return RecordingError(f"cannot write {path}: {reason}")
