"""Recording a session: what a recording begins with, and the file that is renamed only when it is whole."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import metadata
from pathlib import Path
from typing import Any

from engine.events import NOTHING
from sandbox.frame import Frame
from sandbox.simulation import Simulation
from sandbox.viewer import Viewer


@dataclass(frozen=True)
class RecordingStart:
    """Everything that a recording's first step depends on."""

    scene: str
    step: int  # of the world, when recording began
    time: float  # simulated [s]
    dt: float  # [s]
    settings: dict[str, Any]  # JSON-ready
    snapshot: bytes  # engine.Snapshot.to_bytes()
    hands: dict[str, Any]  # Simulation.extras(), JSON-ready
    view: tuple[float, float, float]  # what to look at: centre x, centre y, height [m]
    version: str  # of tumble


OpenRecorder = Callable[[Path, RecordingStart], Viewer]


def recording_start(simulation: Simulation) -> RecordingStart:
    """What a recording of this simulation, from now on, begins with."""
    world = simulation.world
    return RecordingStart(
        scene=simulation.scene.name,
        step=world.step_count,
        time=world.time,
        dt=simulation.dt,
        settings=world.settings.to_dict(),
        snapshot=world.snapshot().to_bytes(),
        hands=simulation.extras(),
        view=simulation.scene.view,
        version=metadata.version("tumble"),
    )


class PartFile:
    """A recording under way in PATH.part; `finish` renames it to PATH."""

    def __init__(self, path: Path, open_recorder: OpenRecorder, simulation: Simulation) -> None:
        self.path = path
        self.part = path.with_name(path.name + ".part")
        self._viewer = open_recorder(self.part, recording_start(simulation))
        try:
            self._viewer.show(replace(simulation.frame(), events=NOTHING))  # what led here is not recorded
        except Exception:
            with suppress(Exception):  # the first error says more
                self._viewer.close()
            raise

    def show(self, frame: Frame) -> None:
        self._viewer.show(frame)

    def abandon(self) -> None:
        """Closes what was written and leaves it as PATH.part."""
        self._viewer.close()

    def finish(self) -> Path:
        """Closes and renames."""
        self._viewer.close()
        return self.part.replace(self.path)


class Recorder:
    """Starts and stops recordings into a folder, one at a time."""

    def __init__(self, open_recorder: OpenRecorder | None, folder: Path) -> None:
        self._open = open_recorder
        self._folder = folder
        self._current: PartFile | None = None
        self.last: Path | None = None

    @property
    def available(self) -> bool:
        """Whether recordings can be made here at all."""
        return self._open is not None

    @property
    def name(self) -> str:
        """Of the file that is being written, empty if none."""
        return self._current.path.name if self._current else ""

    def start(self, simulation: Simulation) -> None:
        """Begins a recording; one that is under way is finished first. ValueError if that cannot be."""
        if self._open is None:
            raise ValueError("recording: must be asked of a session that can record")
        self.stop()
        slug = re.sub(r"[^a-z0-9]+", "-", simulation.scene.name.lower()).strip("-")
        stamp = time.strftime("%Y%m%d-%H%M%S")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._current = PartFile(self._free_path(f"{slug}-{stamp}"), self._open, simulation)
        except Exception as error:  # of the disk, or of whatever writes the file
            raise ValueError(f"recording: must be in a folder that can be written ({error})") from error

    def show(self, frame: Frame) -> None:
        """Writes a frame; if that fails the recording ends, what was written is kept, and the error goes on."""
        if self._current is None:
            return
        try:
            self._current.show(frame)
        except Exception:
            current, self._current = self._current, None
            with suppress(Exception):  # the first error says more
                current.abandon()
            raise

    def stop(self) -> Path | None:
        """Finishes the recording; its path, or None if there was none."""
        if self._current is None:
            return None
        current, self._current = self._current, None
        self.last = current.finish()
        return self.last

    def _free_path(self, stem: str) -> Path:
        path = self._folder / f"{stem}.rrd"
        number = 2
        while path.exists() or path.with_name(path.name + ".part").exists():
            path = self._folder / f"{stem}-{number}.rrd"
            number += 1
        return path
