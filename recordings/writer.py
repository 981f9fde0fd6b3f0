"""The viewer that writes a recording: `show` only hands the frame over, one thread builds and writes."""

from __future__ import annotations

import atexit
import threading
from pathlib import Path

from recordings.mailbox import Mailbox
from recordings.protocols import FrameLike, StartLike
from recordings.rrd_file import RrdFile
from recordings.schema import RecordingError
from recordings.shot import take

CLOSE_SECONDS = 60.0  # after which `close` gives up on the disk
ABANDON_SECONDS = 1.0  # the same after an error, when there is nothing more to save


class Writer:
    """Records every frame it is shown into one file, the start frame first.

    An error of the disk comes back as `RecordingError` at the next `show` or `close`. Its file is readable up to there.
    """

    def __init__(self, path: Path | str, start: StartLike) -> None:
        self.path = Path(path)
        self._next_step = start.step
        self._mailbox = Mailbox()
        self._failure: Exception | None = None
        self._closed = False
        self._reported = False
        self._file = RrdFile(self.path, start)
        self._thread = threading.Thread(target=self._write, name=f"recording {self.path.name}", daemon=True)
        self._thread.start()
        atexit.register(self.close)  # the thread is a daemon: without this, an exit would lose what waits

    @property
    def stalls(self) -> int:
        """How often the loop had to wait for the disk."""
        return self._mailbox.stalls

    def show(self, frame: FrameLike) -> None:
        """Takes one step's frame. Steps must come one after the other, beginning with the start's."""
        self._raise_failure()
        if self._closed:
            raise RecordingError(f"{self.path}: the recording is closed")
        if frame.step != self._next_step:
            raise RecordingError(f"{self.path}: step {frame.step} came where step {self._next_step} was expected")
        self._mailbox.put(take(frame))
        self._next_step += 1

    def close(self) -> None:
        """Writes what waits and finishes the file. An error that `show` already raised is not raised again."""
        if self._closed:
            return
        self._closed = True
        atexit.unregister(self.close)
        self._mailbox.close()
        self._thread.join(CLOSE_SECONDS if self._failure is None else ABANDON_SECONDS)
        if self._reported:
            return
        self._raise_failure()
        if self._thread.is_alive():
            raise RecordingError(f"cannot write {self.path}: not finished after {CLOSE_SECONDS:g} s")

    def _raise_failure(self) -> None:
        if self._failure is not None:
            self._reported = True
            raise RecordingError(str(self._failure)) from self._failure

    def _write(self) -> None:
        """The writing thread, from the first block to the footer."""
        try:
            while not self._mailbox.drained:
                block = self._mailbox.take()
                if block:
                    self._file.write(block)
            self._file.finish()
        except Exception as error:  # noqa: BLE001 - whatever it is, the loop must hear of it
            self._failure = error
            self._mailbox.close()  # a loop that waits for room goes on, and meets the failure at its next call
            self._file.abandon()
