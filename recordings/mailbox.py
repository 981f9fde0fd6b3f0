"""The bounded queue between the loop, which must not wait, and the one thread that writes."""

from __future__ import annotations

import threading
import time

from recordings.schema import RecordingError
from recordings.shot import Shot

BLOCK_BYTES = 2 << 20  # a block is written once this much waits; 60-step blocks of 5000 bodies cost 1.2 GB
BLOCK_SECONDS = 0.25  # or once this much time went by: what a kill can lose, with the time of writing
QUEUE_BYTES = 64 << 20  # the loop waits for the disk beyond this
STALL_SECONDS = 30.0  # and gives up after this


class Mailbox:
    """Shots on their way to the writing thread."""

    def __init__(self) -> None:
        self.stalls = 0  # how often the loop had to wait for the disk
        self._shots: list[Shot] = []
        self._bytes = 0  # of the shots that wait
        self._closed = False
        self._changed = threading.Condition()

    def put(self, shot: Shot) -> None:
        """Adds a shot; waits only while the queue is full."""
        size = shot.nbytes
        with self._changed:
            if self._bytes and self._bytes + size > QUEUE_BYTES:
                self._wait_for_room(size)
            self._shots.append(shot)
            self._bytes += size
            if self._bytes >= BLOCK_BYTES:
                self._changed.notify_all()

    def take(self) -> list[Shot]:
        """The next block: after a quarter second at most, possibly empty."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._bytes >= BLOCK_BYTES, BLOCK_SECONDS)
            count = size = 0
            while count < len(self._shots) and size < BLOCK_BYTES:
                size += self._shots[count].nbytes
                count += 1
            block, self._shots = self._shots[:count], self._shots[count:]
            self._bytes -= size
            self._changed.notify_all()
            return block

    def close(self) -> None:
        """No more shots come; `take` gives the rest without waiting."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    @property
    def drained(self) -> bool:
        """Whether it is closed and empty."""
        with self._changed:
            return self._closed and not self._shots

    def _wait_for_room(self, size: int) -> None:
        self.stalls += 1
        deadline = time.monotonic() + STALL_SECONDS
        while not self._closed and self._bytes and self._bytes + size > QUEUE_BYTES:
            if not self._changed.wait(deadline - time.monotonic()):
                raise RecordingError(f"the disk took nothing of the recording for {STALL_SECONDS:g} s")
