"""A file that rerun fills through a pipe, so that rerun never meets a disk's error.

When a write fails, rerun's own file sink prints a line and drops all that follows. Then now and then (1 of 180 full
disks) it hangs for ever: at disconnect, at a garbage collection or at the program's exit. Here the pipe goes on
taking bytes, and the reason is at hand.
"""

from __future__ import annotations

import array
import contextlib
import fcntl
import os
import select
import termios
import threading
import time
from pathlib import Path

_PIPE_BYTES = 1 << 20
_POLL_SECONDS = 0.05


class PipedFile:
    """Rerun opens `inlet` and writes there; a thread of its own carries the bytes into the file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._error: OSError | None = None
        self._file = path.open("wb", buffering=0)
        self._outlet, self._inlet = os.pipe()
        with contextlib.suppress(AttributeError, OSError):  # a larger pipe is only quicker
            fcntl.fcntl(self._inlet, fcntl.F_SETPIPE_SZ, _PIPE_BYTES)
        self.inlet = f"/dev/fd/{self._inlet}"
        self._moved = threading.Condition()  # held while bytes are neither in the pipe nor in the file
        self._thread = threading.Thread(target=self._carry, name=f"disk {path.name}", daemon=True)
        self._thread.start()

    def opened(self) -> None:
        """Rerun has opened the inlet: from now on, its closing ends the file."""
        os.close(self._inlet)

    def settle(self, seconds: float) -> None:
        """Waits until all that was put into the pipe is in the file, and the file where it was.

        Raises:
            OSError: it is not, for this reason.
        """
        deadline = time.monotonic() + seconds
        with self._moved:
            while self._thread.is_alive() and _waiting_bytes(self._outlet):
                if time.monotonic() > deadline:
                    raise OSError(f"the disk took nothing for {seconds:g} s")
                self._moved.wait(_POLL_SECONDS)
        if self._error is not None:
            raise self._error
        self._check_place()

    def close(self, seconds: float) -> None:
        """After rerun closed the inlet: the rest goes into the file, and the file on the disk.

        Raises:
            OSError: it does not, for this reason.
        """
        self._thread.join(seconds)
        if self._thread.is_alive():
            raise OSError(f"the disk took nothing for {seconds:g} s")
        try:
            if self._error is not None:
                raise self._error
            os.fsync(self._file.fileno())
            self._check_place()
            _sync_folder(self._path.parent)
        finally:
            self._file.close()

    def _carry(self) -> None:
        """The thread: from the pipe into the file, until the inlet is closed."""
        while True:
            select.select([self._outlet], [], [])
            with self._moved:
                data = os.read(self._outlet, _PIPE_BYTES)
                if data:
                    self._write(memoryview(data))
                self._moved.notify_all()
            if not data:
                os.close(self._outlet)
                return

    def _write(self, data: memoryview) -> None:
        """All bytes into the file; after an error none."""
        while len(data) and self._error is None:
            try:
                data = data[self._file.write(data) :]
            except OSError as error:
                self._error = error

    def _check_place(self) -> None:
        """A file that was deleted goes on taking data without complaint."""
        try:
            there = os.path.samestat(self._path.stat(), os.fstat(self._file.fileno()))
        except OSError:
            there = False
        if not there:
            raise OSError("the file or its folder was removed or replaced")


def _waiting_bytes(pipe: int) -> int:
    """How many bytes are in a pipe."""
    count = array.array("i", [0])
    fcntl.ioctl(pipe, termios.FIONREAD, count)
    return count[0]


def _sync_folder(folder: Path) -> None:
    """Makes the file's name as lasting as its content."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
