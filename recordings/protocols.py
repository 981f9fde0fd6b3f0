"""What is asked of those who record and of those who compare: by structure, for this package knows no sandbox."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from engine import Events


class DiagnosticsLike(Protocol):
    """engine.Diagnostics, by structure."""

    @property
    def kinetic_energy(self) -> float: ...
    @property
    def potential_energy(self) -> float: ...
    @property
    def momentum(self) -> tuple[float, float]: ...
    @property
    def angular_momentum(self) -> float: ...
    @property
    def max_penetration(self) -> float: ...
    @property
    def contact_count(self) -> int: ...


class StateLike(Protocol):
    """One step's state, recorded or computed again: what `compare` looks at.

    N bodies, and S pieces of their shapes, both in the order of creation.
    """

    @property
    def step(self) -> int: ...
    @property
    def serials(self) -> np.ndarray: ...  # (N,) int64
    @property
    def body_kinds(self) -> np.ndarray: ...  # (N,) uint8
    @property
    def positions(self) -> np.ndarray: ...  # (N, 2) [m]
    @property
    def angles(self) -> np.ndarray: ...  # (N,) [rad]
    @property
    def velocities(self) -> np.ndarray: ...  # (N, 2) [m/s]
    @property
    def angular_velocities(self) -> np.ndarray: ...  # (N,) [rad/s]
    @property
    def asleep(self) -> np.ndarray: ...  # (N,) bool
    @property
    def shape_serials(self) -> np.ndarray: ...  # (S,) int64
    @property
    def owners(self) -> np.ndarray: ...  # (S,) int64, index of its body
    @property
    def shape_kinds(self) -> np.ndarray: ...  # (S,) uint8
    @property
    def sizes(self) -> np.ndarray: ...  # (S, 2) [m]
    @property
    def places(self) -> np.ndarray: ...  # (S, 3) x, y [m] and angle [rad] in the body's frame
    @property
    def corner_counts(self) -> np.ndarray: ...  # (S,) uint8
    @property
    def corners(self) -> np.ndarray: ...  # (sum of the counts, 2), in the pieces' own frames [m]
    @property
    def contacts(self) -> np.ndarray: ...  # (C,) CONTACT_RECORD
    @property
    def joints(self) -> np.ndarray: ...  # (J,) JOINT_RECORD
    @property
    def events(self) -> Events: ...  # of this step


class FrameLike(StateLike, Protocol):
    """sandbox.frame.Frame, by structure."""

    @property
    def time(self) -> float: ...  # [s]
    @property
    def dt(self) -> float: ...  # [s]
    @property
    def diagnostics(self) -> DiagnosticsLike: ...
    @property
    def stage_ms(self) -> Mapping[str, float]: ...
    @property
    def commands(self) -> tuple[dict[str, Any], ...]: ...


class StartLike(Protocol):
    """sandbox.recorder.RecordingStart, by structure: what a recording starts from."""

    @property
    def scene(self) -> str: ...
    @property
    def step(self) -> int: ...
    @property
    def time(self) -> float: ...  # [s]
    @property
    def dt(self) -> float: ...  # [s]
    @property
    def settings(self) -> Mapping[str, Any]: ...  # JSON-ready
    @property
    def snapshot(self) -> bytes: ...
    @property
    def hands(self) -> Mapping[str, Any]: ...  # JSON-ready
    @property
    def view(self) -> tuple[float, float, float]: ...  # centre x, y and height of what the camera shows [m]
    @property
    def version(self) -> str: ...
