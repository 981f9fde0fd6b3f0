"""A session without physics: it keeps what was submitted, applies the simplest of it, and shows synthetic frames."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from engine import BODY_KINDS, CONTACT_RECORD, JOINT_RECORD, SHAPE_KINDS, Diagnostics, EffectStatus, Settings
from sandbox.commands import (
    LoadScene,
    Pause,
    Play,
    Set,
    SetAll,
    SetSpeed,
    Spawn,
    StartRecording,
    StopRecording,
)
from sandbox.frame import Frame
from sandbox.scenes import SCENES
from sandbox.viewer import Viewer

BODY = tuple[str, str, float, float, float, float, float]  # kind, shape, size 1 and 2, x, y, angle
GROUND: BODY = ("static", "box", 40.0, 2.0, 0.0, -1.0, 0.0)
PENTAGON = np.column_stack([np.cos(np.arange(5) * 0.4 * np.pi), np.sin(np.arange(5) * 0.4 * np.pi)])
DT = 1.0 / 60.0
PATIENCE = 60.0  # for what must come, on however busy a machine [s]
EFFECTS = (
    EffectStatus("gravity", True, "gravity is (0, -10) m/s²"),
    EffectStatus("restitution", False, ""),
    EffectStatus("friction", True, "3 of 3 shapes have <friction>"),
)


def make_frame(bodies: list[BODY], corners: list[np.ndarray] | None = None, **changes: Any) -> Frame:
    """A frame with these bodies at rest, each of one piece, and nothing else in it.

    corners: of the polygons, one after another; pentagons of radius 1 if left out.
    """
    table = np.array([body[2:] for body in bodies], np.float64).reshape(len(bodies), 5)
    count = len(bodies)
    kinds = np.array([SHAPE_KINDS.index(body[1]) for body in bodies], np.uint8)
    is_polygon = kinds == SHAPE_KINDS.index("polygon")
    corners = [PENTAGON] * int(is_polygon.sum()) if corners is None else corners
    counts = np.zeros(count, np.uint8)
    counts[is_polygon] = [len(own) for own in corners]
    frame = Frame(
        scene=next(iter(SCENES)),
        step=0,
        time=0.0,
        dt=DT,
        serials=np.arange(count, dtype=np.int64),
        body_kinds=np.array([BODY_KINDS.index(body[0]) for body in bodies], np.uint8),
        positions=table[:, 2:4],
        angles=table[:, 4],
        velocities=np.zeros((count, 2)),
        angular_velocities=np.zeros(count),
        asleep=np.zeros(count, np.bool_),
        shape_serials=np.arange(count, dtype=np.int64),
        owners=np.arange(count),
        shape_kinds=kinds,
        sizes=table[:, :2],
        places=np.zeros((count, 3)),
        corner_counts=counts,
        corners=np.concatenate([np.zeros((0, 2)), *corners]),
        contacts=np.zeros(0, CONTACT_RECORD),
        joints=np.zeros(0, JOINT_RECORD),
        diagnostics=Diagnostics(0.0, 0.0, (0.0, 0.0), 0.0, 0.0, 0),
        settings=Settings(gravity=(0.0, -10.0)),
        effects=EFFECTS,
        stage_ms={"broad phase": 0.4, "narrow phase": 0.7, "solve": 1.1},
        content=count,
    )
    return replace(frame, **changes)


def pyramid(rows: int) -> list[BODY]:
    bodies = [GROUND]
    for row in range(rows):
        for place in range(rows - row):
            bodies.append(("dynamic", "box", 1.0, 1.0, 1.1 * (place - (rows - row - 1) / 2), 0.5 + row, 0.0))
    return bodies


class FakeSession:
    """What the page needs of a session. `submitted` is what the tests look at."""

    can_record = True

    def __init__(self, bodies: list[BODY], runs: bool = True, **changes: Any) -> None:
        self.submitted: list[Any] = []
        self.last_recording: Path | None = None
        self.frame = make_frame(bodies, **changes)
        self._bodies = list(bodies)
        self._viewers: list[Viewer] = []
        self._closed = threading.Event()
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._run, daemon=True)
        if runs:
            self._thread.start()

    def submit(self, command: Any) -> bool:
        self.submitted.append(command)
        with self._lock:
            self.frame = self._applied(command)
        self.publish()
        return True

    def add_viewer(self, viewer: Viewer) -> None:
        self._viewers.append(viewer)
        viewer.show(self.frame)

    def publish(self, **changes: Any) -> None:
        with self._lock:
            self.frame = replace(self.frame, **changes)
        for viewer in self._viewers:
            viewer.show(self.frame)

    def close(self) -> None:
        self._closed.set()

    def of(self, kind: type) -> list[Any]:
        return [command for command in self.submitted if isinstance(command, kind)]

    def wait_for(self, kind: type, count: int = 1, timeout: float = PATIENCE) -> list[Any]:
        return wait_until(lambda: self.of(kind) if len(self.of(kind)) >= count else None, timeout, kind.__name__)

    def _applied(self, command: Any) -> Frame:
        frame, settings, status = self.frame, self.frame.settings, self.frame.status
        if isinstance(command, Spawn):
            for place in range(command.count):
                size = (command.width / 2, 0.0) if command.shape == "circle" else (command.width, command.height)
                self._bodies.append(
                    (command.kind, command.shape, *size, command.x + place * command.width, command.y, 0.0)
                )
            kept = {"settings": settings, "status": status, "step": frame.step, "time": frame.time}
            return make_frame(self._bodies, scene=frame.scene, **kept)
        if isinstance(command, Set):
            settings = settings.changed({command.setting: command.value})
        elif isinstance(command, SetAll):
            settings = settings.changed(dict(command.settings))
        elif isinstance(command, SetSpeed):
            status = replace(status, speed=command.speed)
        elif isinstance(command, Pause | Play):
            status = replace(status, paused=isinstance(command, Pause))
        elif isinstance(command, StartRecording):
            status = replace(status, recording="fake.rrd")
        elif isinstance(command, StopRecording):
            status = replace(status, recording="")
        elif isinstance(command, LoadScene):
            return replace(frame, scene=command.scene, content=frame.content + 1)
        return replace(frame, settings=settings, status=status)

    def _run(self) -> None:
        while not self._closed.wait(DT):
            if not self.frame.status.paused:
                step = self.frame.step + 1
                status = replace(self.frame.status, steps_per_second=60.0)
                self.publish(step=step, time=step * DT, status=status)


def wait_until(look: Callable[[], Any], timeout: float = PATIENCE, what: str = "it") -> Any:
    """The first true thing that `look` finds."""
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        found = look()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError(f"{what} did not come within {timeout} s")
