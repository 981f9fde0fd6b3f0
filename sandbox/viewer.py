"""What the session asks of anything that watches it."""

from __future__ import annotations

from typing import Protocol

from sandbox.frame import Frame


class Viewer(Protocol):
    """Shows frames: the page, a recording, a test. Called on the loop's thread, so it must be quick."""

    def show(self, frame: Frame) -> None: ...

    def close(self) -> None: ...


class NullViewer:
    """Shows nothing and counts: for headless runs and tests."""

    def __init__(self) -> None:
        self.frame_count = 0
        self.last: Frame | None = None

    def show(self, frame: Frame) -> None:
        self.frame_count += 1
        self.last = frame

    def close(self) -> None:
        pass
