"""What a viewer sees of one step: read-only arrays and numbers, never the world itself."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from engine import Diagnostics, Settings


@dataclass(frozen=True)
class Status:
    """How the session that made a frame was doing."""

    paused: bool = False
    speed: float = 1.0  # simulated seconds per second asked for
    steps_per_second: float = 0.0
    behind: bool = False  # real time was asked for and could not be kept
    failure: str = ""  # why the last step failed, empty while all is well
    notice: str = ""  # the last thing worth telling: a refused command, a finished recording
    recording: str = ""  # the file being written, empty if none


@dataclass(frozen=True)
class Frame:
    """One step's outcome. N bodies in the order of creation; every array is a read-only copy."""

    scene: str
    step: int  # steps since the scene began
    time: float  # simulated time since the scene began [s]
    dt: float  # time step that led here [s]
    serials: np.ndarray  # (N,) int64, creation number: a body's identity, never reused
    body_kinds: np.ndarray  # (N,) uint8, index into engine.BODY_KINDS
    shape_kinds: np.ndarray  # (N,) uint8, index into engine.SHAPE_KINDS
    sizes: np.ndarray  # (N, 2) float64, box: full width and height [m]; circle: radius, 0 [m]
    positions: np.ndarray  # (N, 2) float64 [m]
    angles: np.ndarray  # (N,) float64, unwrapped [rad]
    velocities: np.ndarray  # (N, 2) float64 [m/s]
    angular_velocities: np.ndarray  # (N,) float64 [rad/s]
    contacts: np.ndarray  # (C,) engine.CONTACT_RECORD
    joints: np.ndarray  # (J,) engine.JOINT_RECORD
    diagnostics: Diagnostics
    settings: Settings
    stage_ms: dict[str, float] = field(default_factory=dict)  # time of each stage of this step [ms]
    commands: tuple[dict, ...] = ()  # commands applied just before this step, as JSON-ready dicts
    content: int = 0  # changes whenever bodies came or went, or a scene began
    status: Status = Status()
