"""Frames made up for the tests: no engine runs here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

import recordings
from engine import CONTACT_RECORD, JOINT_RECORD, Diagnostics

DT = 1 / 60  # [s]
DIAGNOSTICS = Diagnostics(1.5, 2.5, (0.25, -0.5), 0.75, 0.004, 3)


@dataclass(frozen=True)
class Start:
    """sandbox.recorder.RecordingStart, by structure."""

    scene: str = "Stacking/Test"
    step: int = 0
    time: float = 0.0
    dt: float = DT
    settings: dict[str, Any] = field(default_factory=lambda: {"gravity": [0.0, -10.0], "iterations": 10})
    snapshot: bytes = b"\x00snapshot\xff" * 7
    hands: dict[str, Any] = field(default_factory=lambda: {"grabs": {}, "bomb": None})
    view: tuple[float, float, float] = (0.0, 6.0, 16.0)
    version: str = "0.1.0"


@dataclass(frozen=True)
class Frame:
    """sandbox.frame.Frame, as far as a recording looks at it."""

    step: int
    serials: np.ndarray
    body_kinds: np.ndarray
    shape_kinds: np.ndarray
    sizes: np.ndarray
    positions: np.ndarray
    angles: np.ndarray
    velocities: np.ndarray
    angular_velocities: np.ndarray
    contacts: np.ndarray
    joints: np.ndarray
    time: float = 0.0
    dt: float = DT
    diagnostics: Diagnostics = DIAGNOSTICS
    stage_ms: dict[str, float] = field(default_factory=dict)
    commands: tuple[dict[str, Any], ...] = ()


def random_frame(rng: np.random.Generator, step: int, bodies: int = 5, contacts: int = 4, joints: int = 2) -> Frame:
    """A frame of random bits: any float at all, NaN, infinity and -0.0 among them."""
    return Frame(
        step=step,
        time=step * DT,
        serials=np.sort(rng.choice(1000, bodies, replace=False)).astype(np.int64),
        body_kinds=rng.integers(0, 2, bodies).astype(np.uint8),
        shape_kinds=rng.integers(0, 2, bodies).astype(np.uint8),
        sizes=rng.uniform(0.1, 2.0, (bodies, 2)),
        positions=_any_floats(rng, (bodies, 2)),
        angles=_any_floats(rng, (bodies,)),
        velocities=_any_floats(rng, (bodies, 2)),
        angular_velocities=_any_floats(rng, (bodies,)),
        contacts=_any_records(rng, CONTACT_RECORD, contacts),
        joints=_any_records(rng, JOINT_RECORD, joints),
        stage_ms={"narrow phase": 0.25, "solve": float(step)},
    )


def steady_frames(count: int, bodies: int = 3, contacts: int = 4, first_step: int = 0) -> list[Frame]:
    """Frames of random bits with the same bodies throughout."""
    rng = np.random.default_rng(7)
    first = random_frame(rng, first_step, bodies, contacts)
    frames = [first]
    for step in range(first_step + 1, first_step + count):
        frame = random_frame(rng, step, bodies, contacts)
        same = {name: getattr(first, name) for name in ("serials", "body_kinds", "shape_kinds", "sizes")}
        frames.append(replace(frame, **same))
    return frames


def start_of(frame: Frame) -> Start:
    """The start of a recording whose first frame this is."""
    return Start(step=frame.step, time=frame.time)


def write(path: Path, frames: list[Frame]) -> Path:
    """A whole recording of these frames."""
    writer = recordings.Writer(path, start_of(frames[0]))
    for frame in frames:
        writer.show(frame)
    writer.close()
    return path


def tumbling(count: int, bodies: int = 40) -> Iterator[Frame]:
    """Boxes and circles falling onto a ground, turning as they fall: something to look at."""
    rng = np.random.default_rng(3)
    size = rng.uniform(0.5, 1.3, (bodies, 2))
    shape = (np.arange(bodies) % 3 == 2).astype(np.uint8)
    size[shape == 1] = np.column_stack([size[shape == 1, 0] / 2, np.zeros((shape == 1).sum())])
    size[0] = (24.0, 1.0)
    shape[0] = 0
    place = np.column_stack([rng.uniform(-8, 8, bodies), rng.uniform(4, 22, bodies)])
    spin = rng.uniform(-3, 3, bodies)
    kinds = np.minimum(np.arange(bodies), 1).astype(np.uint8)
    for step in range(count):
        alive = np.arange(bodies) < (bodies if step >= 40 else bodies - 8)
        yield _falling(step, alive, kinds, shape, size, place, spin)


def _falling(
    step: int,
    alive: np.ndarray,
    kinds: np.ndarray,
    shape: np.ndarray,
    size: np.ndarray,
    place: np.ndarray,
    spin: np.ndarray,
) -> Frame:
    time = step * DT
    reach = np.where(shape == 1, size[:, 0], size.min(axis=1) / 2)
    height = np.maximum(place[:, 1] - 5 * time**2, 0.5 + reach)
    landing = np.sqrt(np.maximum(place[:, 1] - 0.5 - reach, 0) / 5)
    positions = np.column_stack([place[:, 0], height])
    angles = spin * np.minimum(time, landing)
    positions[0], angles[0] = (0.0, 0.0), 0.0
    down = np.flatnonzero(alive & (time > landing) & (np.arange(len(alive)) > 0))
    contacts = np.zeros(len(down), CONTACT_RECORD)
    contacts["body2"], contacts["x"], contacts["y"] = down, positions[down, 0], 0.5
    contacts["ny"], contacts["normal_impulse"] = 1.0, 10 * size[down, 0]
    contacts["tangent_impulse"] = spin[down]
    joints = np.zeros(1, JOINT_RECORD)
    joints["body1"], joints["body2"] = 1, 4
    joints["x1"], joints["y1"] = positions[1]
    joints["x2"], joints["y2"] = positions[4]
    kinetic = float(10 * time * len(down)) + 40
    return Frame(
        step=step,
        time=time,
        serials=np.flatnonzero(alive).astype(np.int64),
        body_kinds=kinds[alive],
        shape_kinds=shape[alive],
        sizes=size[alive],
        positions=positions[alive],
        angles=angles[alive],
        velocities=np.zeros((int(alive.sum()), 2)),
        angular_velocities=spin[alive],
        contacts=contacts,
        joints=joints,
        diagnostics=Diagnostics(kinetic, 400 - kinetic, (0.0, 0.0), 0.0, 0.005 * abs(np.sin(time * 9)), len(down)),
        stage_ms={"broad phase": 0.05 + 0.01 * np.sin(time), "narrow phase": 0.2, "solve": 0.5 + 0.004 * len(down)},
        commands=({"command": "spawn", "shape": "box", "count": 8, "x": 1.0, "y": 12.0},) if step == 40 else (),
    )


def _any_floats(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    return rng.integers(0, 2**64, shape, np.uint64).view(np.float64)


def _any_records(rng: np.random.Generator, dtype: np.dtype, count: int) -> np.ndarray:
    return np.frombuffer(rng.bytes(dtype.itemsize * count), dtype).copy()
