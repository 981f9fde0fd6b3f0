"""Recordings on disk: a file to look at in rerun, and to compute with bit for bit."""

from __future__ import annotations

from recordings.reader import read
from recordings.recording import Recording, State
from recordings.schema import RecordingError
from recordings.verify import Difference, compare
from recordings.writer import Writer

__all__ = ["Difference", "Recording", "RecordingError", "State", "Writer", "compare", "read"]
