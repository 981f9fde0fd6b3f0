"""Converged references: for scenes without an exact answer, where their bodies go if time steps hardly matter any more.

A reference is a run of soft_step in double precision, in time steps and substeps so short that another run, of steps
twice as long, goes nearly the same way; joints that hang together are solved at once. How far the two are apart is its
uncertainty: what is closer to the reference than that is not known to be wrong, and once the uncertainty has grown, in
a heap whose impacts multiply every difference, nothing is known. Made once, and kept in the user's cache folder under a
hash of the scene, the engine's source text and the versions of numpy and numba.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

import engine
from engine import World
from engine.tables import DYNAMIC
from sandbox.lab.measures import distances
from sandbox.simulation import TIME_STEP

Fill = Callable[[World], Any]

FINEST: dict[str, int] = {"steps": 8, "substeps": 32}  # in 1/60 s, and in each of them
COARSER: dict[str, int] = {"steps": 4, "substeps": 32}


@dataclass(frozen=True, eq=False)
class Reference:
    """Where the dynamic bodies of a scene go, every 1/60 s."""

    positions: np.ndarray  # (frames, N, 2), the first after 1/60 s [m]
    uncertainty: np.ndarray  # (frames,) how far the run of twice as long steps is from it, at worst [m]

    def known(self, within: float) -> int:
        """For how many frames, from the first on, it is certain to so many metres."""
        beyond = np.flatnonzero(~(self.uncertainty <= within))
        return int(beyond[0]) if len(beyond) else len(self.uncertainty)

    def distances(self, positions: np.ndarray, dt: float) -> np.ndarray:
        """(frames,) how far a run in steps of dt [s] is from it [m]: NaN between its steps, infinite after its end.

        positions: (steps, N, 2), the first after one step.
        """
        found = np.full(len(self.positions), np.nan)
        moments = np.arange(1, len(positions) + 1) * dt / TIME_STEP
        frames = np.round(moments).astype(int)
        both = (np.abs(moments - frames) < 1e-6) & (frames >= 1) & (frames <= len(found))
        found[frames[both] - 1] = distances(positions[both], self.positions[frames[both] - 1])
        found[int(len(positions) * dt / TIME_STEP + 1e-6) :] = np.inf
        return found


def dynamic_positions(world: World) -> np.ndarray:
    """(N, 2) of all dynamic bodies, in the order of creation [m]."""
    return world.positions[world.body_records()["kind"] == DYNAMIC]


def reference_of(name: str, fill: Fill, seconds: float, folder: Path | None = None) -> Reference:
    """The reference of a scene: from memory, from the cache folder, or made now, which takes seconds to minutes.

    fill: puts the scene into an empty world; folder: another one than the user's.
    """
    key = key_of(fill, seconds)
    path = (folder or cache_folder()) / f"{name}-{key[:20]}.npz"
    return remembered(path) or kept(path, make(fill, seconds))


def make(fill: Fill, seconds: float) -> Reference:
    """A reference, and how sure it is."""
    finest, coarser = (trajectory(fill, seconds, **run) for run in (FINEST, COARSER))
    return Reference(finest, distances(coarser, finest))


def trajectory(fill: Fill, seconds: float, steps: int, substeps: int) -> np.ndarray:
    """(frames, N, 2) where the bodies are every 1/60 s, in so many steps each [m]."""
    world = empty_world(substeps)
    fill(world)
    frames = []
    for _ in range(round(seconds / TIME_STEP)):
        world.run(steps, TIME_STEP / steps)
        frames.append(dynamic_positions(world))
    return np.array(frames)


def empty_world(substeps: int) -> World:
    """As references are made in: nothing sleeps, and chains are solved at once."""
    return World(substeps=substeps, precision="double", joint_solving="direct", sleeping=False)


# --- the cache --------------------------------------------------------------------------------------------------------


def key_of(fill: Fill, seconds: float) -> str:
    """Hash of everything that a reference depends on: 64 hex digits."""
    world = empty_world(FINEST["substeps"])
    fill(world)
    snapshot = world.snapshot()
    digest = hashlib.sha256(repr((seconds, FINEST, COARSER, snapshot.settings.to_dict())).encode())
    for table, rows in sorted(snapshot.tables.items()):
        digest.update(f"{table} {rows.dtype} {rows.shape}".encode())
        digest.update(np.ascontiguousarray(rows).tobytes())
    digest.update(engine_hash().encode())
    return digest.hexdigest()


@cache
def engine_hash() -> str:
    """Hash of the engine's source text and of what compiles it."""
    folder = Path(engine.__file__).parent
    digest = hashlib.sha256(f"{version('numpy')} {version('numba')}".encode())
    for path in sorted(folder.rglob("*.py")):
        digest.update(str(path.relative_to(folder)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def cache_folder() -> Path:
    """The user's, as the system has it: XDG_CACHE_HOME or ~/.cache, ~/Library/Caches, or LOCALAPPDATA."""
    home = Path.home()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "tumble" / "references"


_memory: dict[Path, Reference] = {}


def remembered(path: Path) -> Reference | None:
    """What was kept there, if it is whole."""
    if path not in _memory:
        try:
            with np.load(path, allow_pickle=False) as stored:
                _memory[path] = Reference(stored["positions"], stored["uncertainty"])
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None
    return _memory[path]


def kept(path: Path, reference: Reference) -> Reference:
    """Keeps it: in memory, and on disk where that can be written. Several processes may do so at once."""
    _memory[path] = reference
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
            np.savez_compressed(part, positions=reference.positions, uncertainty=reference.uncertainty)
        os.replace(part.name, path)
    except OSError:
        pass  # it is made again by the next process
    return reference
