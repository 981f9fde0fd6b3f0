"""Frames made up for the tests: no engine runs here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

import recordings
from engine import CONTACT_RECORD, JOINT_RECORD, SHAPE_KINDS, Diagnostics, Events
from engine.events import NOTHING

DT = 1 / 60  # [s]
BOX, CIRCLE, CAPSULE, POLYGON, SEGMENT, CHAIN = range(6)
CONTENT = (
    "serials", "body_kinds", "shape_serials", "owners", "shape_kinds", "sizes", "places", "corner_counts", "corners",
)  # fmt: skip
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
    positions: np.ndarray
    angles: np.ndarray
    velocities: np.ndarray
    angular_velocities: np.ndarray
    asleep: np.ndarray
    shape_serials: np.ndarray
    owners: np.ndarray
    shape_kinds: np.ndarray
    sizes: np.ndarray
    places: np.ndarray
    corner_counts: np.ndarray
    corners: np.ndarray
    contacts: np.ndarray
    joints: np.ndarray
    time: float = 0.0
    dt: float = DT
    diagnostics: Diagnostics = DIAGNOSTICS
    stage_ms: dict[str, float] = field(default_factory=dict)
    commands: tuple[dict[str, Any], ...] = ()
    events: Events = NOTHING


def random_frame(rng: np.random.Generator, step: int, bodies: int = 5, contacts: int = 4, joints: int = 2) -> Frame:
    """A frame of random bits: any float at all, NaN, infinity and -0.0 among them. Bodies have any number of pieces."""
    pieces = int(rng.integers(0, 3 * bodies)) if bodies else 0
    kinds = rng.integers(0, len(SHAPE_KINDS), pieces).astype(np.uint8)
    counts = np.where(kinds == POLYGON, rng.integers(3, 9, pieces), 0).astype(np.uint8)
    return Frame(
        step=step,
        time=step * DT,
        serials=np.sort(rng.choice(1000, bodies, replace=False)).astype(np.int64),
        body_kinds=rng.integers(0, 3, bodies).astype(np.uint8),
        positions=_any_floats(rng, (bodies, 2)),
        angles=_any_floats(rng, (bodies,)),
        velocities=_any_floats(rng, (bodies, 2)),
        angular_velocities=_any_floats(rng, (bodies,)),
        asleep=rng.integers(0, 2, bodies) != 0,
        shape_serials=np.sort(rng.choice(1000, pieces, replace=False)).astype(np.int64),
        owners=rng.integers(0, max(bodies, 1), pieces),
        shape_kinds=kinds,
        sizes=_any_floats(rng, (pieces, 2)),
        places=_any_floats(rng, (pieces, 3)),
        corner_counts=counts,
        corners=_any_floats(rng, (int(counts.sum()), 2)),
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
        frames.append(replace(frame, **{name: getattr(first, name) for name in CONTENT}))
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
    """Shapes of all kinds falling onto a ground and a chain, turning as they fall: something to look at."""
    rng = np.random.default_rng(3)
    place = np.column_stack([rng.uniform(-8, 8, bodies), rng.uniform(4, 22, bodies)])
    spin = rng.uniform(-3, 3, bodies)
    pieces = _pieces(rng, bodies)
    for step in range(count):
        yield _falling(step, bodies if step >= 40 else bodies - 8, place, spin, pieces)


def _pieces(rng: np.random.Generator, bodies: int) -> dict[str, np.ndarray]:
    """The ground, then a piece for each body, two for each fifth; last the ground's segment and its chain of four."""
    owners = [0, *(body for body in range(1, bodies) for _ in range(2 if body % 5 == 0 else 1)), 0, 0, 0, 0, 0]
    count = len(owners)
    kinds = np.array([BOX, *((np.arange(count - 6) + 1) % 4), SEGMENT, CHAIN, CHAIN, CHAIN, CHAIN], np.uint8)
    sizes = rng.uniform(0.5, 1.3, (count, 2))
    sizes[kinds == CIRCLE] *= (0.5, 0.0)
    sizes[kinds == CAPSULE] *= (1.0, 0.3)
    sizes[kinds == POLYGON] = rng.choice([0.0, 0.15], (int((kinds == POLYGON).sum()), 1)) * (1.0, 0.0)
    sizes[0], sizes[-5:] = (24.0, 1.0), (5.0, 0.0)
    places = np.zeros((count, 3))
    places[1:-5][np.diff(owners[:-5]) == 0] = (0.6, 0.2, 0.3)
    places[-5] = (-9.0, 4.0, -0.5)
    places[-4:] = [(6.0 + 4.8 * k, 1.5 + (k % 2), 0.4 - 0.8 * (k % 2)) for k in range(4)]
    counts = np.where(kinds == POLYGON, 3 + np.arange(count) % 5, 0).astype(np.uint8)
    corners = [0.6 * np.exp(2j * np.pi * np.arange(n) / n) for n in counts]
    flat = np.concatenate(corners)
    return {"shape_serials": np.arange(count), "owners": np.array(owners), "shape_kinds": kinds, "sizes": sizes,
            "places": places, "corner_counts": counts, "corners": np.column_stack([flat.real, flat.imag])}  # fmt: skip


def _falling(step: int, alive: int, place: np.ndarray, spin: np.ndarray, pieces: dict[str, np.ndarray]) -> Frame:
    time = step * DT
    reach = np.where(np.arange(len(place)) % 5 == 0, 1.0, 0.5)
    height = np.maximum(place[:, 1] - 5 * time**2, 0.5 + reach)
    landing = np.sqrt(np.maximum(place[:, 1] - 0.5 - reach, 0) / 5)
    positions = np.column_stack([place[:, 0], height])[:alive]
    angles = (spin * np.minimum(time, landing))[:alive]
    positions[0], angles[0] = (0.0, 0.0), 0.0
    down = np.flatnonzero((time > landing[:alive]) & (np.arange(alive) > 0))
    contacts = np.zeros(len(down), CONTACT_RECORD)
    contacts["body2"], contacts["x"], contacts["y"] = down, positions[down, 0], 0.5
    contacts["ny"], contacts["normal_impulse"] = 1.0, 10 * reach[down]
    contacts["tangent_impulse"] = spin[down]
    joints = np.zeros(1, JOINT_RECORD)
    joints["body1"], joints["body2"] = 1, 4
    joints["x1"], joints["y1"] = positions[1]
    joints["x2"], joints["y2"] = positions[4]
    kinetic = float(10 * time * len(down)) + 40
    return Frame(
        step=step,
        time=time,
        serials=np.arange(alive),
        body_kinds=np.minimum(np.arange(alive), 1).astype(np.uint8),
        positions=positions,
        angles=angles,
        velocities=np.zeros((alive, 2)),
        angular_velocities=spin[:alive],
        asleep=np.arange(alive) % 3 == step % 3,
        **_kept(pieces, pieces["owners"] < alive),
        contacts=contacts,
        joints=joints,
        diagnostics=Diagnostics(kinetic, 400 - kinetic, (0.0, 0.0), 0.0, 0.005 * abs(np.sin(time * 9)), len(down)),
        stage_ms={"broad phase": 0.05 + 0.01 * np.sin(time), "narrow phase": 0.2, "solve": 0.5 + 0.004 * len(down)},
        commands=({"command": "spawn", "shape": "box", "count": 8, "x": 1.0, "y": 12.0},) if step == 40 else (),
    )


def _kept(pieces: dict[str, np.ndarray], keep: np.ndarray) -> dict[str, np.ndarray]:
    """Some of the pieces, with their corners."""
    corners = pieces["corners"][np.repeat(keep, pieces["corner_counts"])]
    return {name: values[keep] for name, values in pieces.items() if name != "corners"} | {"corners": corners}


def _any_floats(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    return rng.integers(0, 2**64, shape, np.uint64).view(np.float64)


def _any_records(rng: np.random.Generator, dtype: np.dtype, count: int) -> np.ndarray:
    return np.frombuffer(rng.bytes(dtype.itemsize * count), dtype).copy()
