"""What a viewer sees of one step: read-only arrays and numbers, never the world itself."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from engine import Diagnostics, Events, Settings
from engine.effects import EffectStatus
from engine.events import NOTHING


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
    """One step's outcome: N bodies and the S pieces of their shapes, both in the order of creation.

    A body has any number of pieces; a shape is one piece, but for a chain, which is one a segment. Every array is a
    read-only copy. What describes pieces stays as it is until `content` changes.
    """

    scene: str
    step: int  # steps since the scene began
    time: float  # simulated time since the scene began [s]
    dt: float  # time step that led here [s]
    serials: np.ndarray  # (N,) int64, creation number: a body's identity, never reused
    body_kinds: np.ndarray  # (N,) uint8, index into engine.BODY_KINDS
    positions: np.ndarray  # (N, 2) float64, of the bodies' origins [m]
    angles: np.ndarray  # (N,) float64, unwrapped [rad]
    velocities: np.ndarray  # (N, 2) float64, of the centres of mass [m/s]
    angular_velocities: np.ndarray  # (N,) float64 [rad/s]
    asleep: np.ndarray  # (N,) bool, who sleeps
    shape_serials: np.ndarray  # (S,) int64, creation number of each piece
    owners: np.ndarray  # (S,) int64, which body it belongs to: index into the arrays above
    shape_kinds: np.ndarray  # (S,) uint8, index into engine.SHAPE_KINDS
    sizes: np.ndarray  # (S, 2) float64 [m], box: width, height; circle: radius, 0; capsule: length, radius;
    # polygon: how far it is rounded, 0; segment and piece of a chain: length, 0
    places: np.ndarray  # (S, 3) float64, x, y [m] and angle [rad] of the piece's own frame in that of its body
    corner_counts: np.ndarray  # (S,) uint8, of polygons; 0 of all others
    corners: np.ndarray  # (sum of the counts, 2) float64, one polygon after another, each in its piece's own frame [m]
    contacts: np.ndarray  # (C,) engine.CONTACT_RECORD
    joints: np.ndarray  # (J,) engine.JOINT_RECORD
    diagnostics: Diagnostics
    settings: Settings
    bounds: np.ndarray = field(default_factory=lambda: np.zeros((0, 4), np.float32))  # (S, 4): the pieces' boxes as the
    # broad phase has them, lower x and y, upper x and y [m]; a recording does not hold them: (0, 4)
    events: Events = NOTHING  # since the frame before, where the setting tell_events is on
    events_lost: int = 0  # that are not among them: too many came since
    effects: tuple[EffectStatus, ...] = ()  # every effect the engine has; of a recording none
    stage_ms: dict[str, float] = field(default_factory=dict)  # time of each stage of this step [ms]
    commands: tuple[dict, ...] = ()  # commands applied just before this step, as JSON-ready dicts
    drives: tuple[float, ...] = ()  # how far each of the scene's drives is on, -1 to 1; of a recording none
    content: int = 0  # changes whenever bodies or shapes came or went, or a scene began
    status: Status = Status()

    def shape_poses(self) -> tuple[np.ndarray, np.ndarray]:
        """Where the pieces' own frames are in the world: (S, 2) [m], and their angles (S,) [rad]."""
        angles = self.angles[self.owners]
        cosine, sine = np.cos(angles), np.sin(angles)
        x, y, turn = self.places.T
        positions = self.positions[self.owners]
        positions[:, 0] += cosine * x - sine * y
        positions[:, 1] += sine * x + cosine * y
        return positions, angles + turn
