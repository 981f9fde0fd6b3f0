"""Bodies as filled shapes: their looks are sent when they change, their poses once a step in which they moved."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from recordings.columns import Sheet, time_columns
from recordings.looks import Look, looks
from recordings.roster import Run
from recordings.shot import Shot

_LAYERS = 8  # pieces of neighbouring serials lie at different depths, or overlapping faces would flicker
_LAYER_STEP = 0.004  # [m]


class BodiesView:
    """Turns runs of shots into sheets; remembers what was sent last."""

    def __init__(self, view_height: float) -> None:
        self._height = view_height  # [m]
        self._sent: dict[str, bytes] = {}  # last poses of each entity
        self._looks: dict[str, Look] = {}  # what each entity shows

    def sheets(self, run: Run) -> Iterator[Sheet]:
        """The shapes if they changed, then the poses of the pieces that moved."""
        if run.changed:
            yield from self._shapes(run.shots[0])
        for path, look in self._looks.items():
            yield from self._poses(path, look, run.shots)

    def _shapes(self, shot: Shot) -> Iterator[Sheet]:
        times = time_columns([shot.step], [shot.time])
        now = looks(shot, self._height)
        for path, look in now.items():
            yield Sheet(path, times, look.shape_columns())
        for path, look in self._looks.items():
            if path not in now:
                yield Sheet(path, times, look.empty_columns())
        self._looks = now
        self._sent.clear()

    def _poses(self, path: str, look: Look, shots: list[Shot]) -> Iterator[Sheet]:
        poses = _world_poses(shots, look.members)
        moved = self._moved(path, poses)
        if not len(moved):
            return
        times = time_columns([shots[i].step for i in moved], [shots[i].time for i in moved])
        yield Sheet(path, times, look.pose_columns(poses[moved]))

    def _moved(self, path: str, poses: np.ndarray) -> np.ndarray:
        """Which shots differ from the one before, (k,) indices."""
        rows = [row.tobytes() for row in poses]
        before = [self._sent.get(path), *rows[:-1]]
        self._sent[path] = rows[-1]
        return np.array([i for i, row in enumerate(rows) if row != before[i]], np.int64)


def _world_poses(shots: list[Shot], members: np.ndarray) -> np.ndarray:
    """Where these pieces are in each shot: x, y, depth and angle, (K, M, 4) float32."""
    owners, (x, y, turn) = shots[0].owners[members], shots[0].places[members].T
    angles = np.stack([shot.angles[owners] for shot in shots])
    cosine, sine = np.cos(angles), np.sin(angles)
    positions = np.stack([shot.positions[owners] for shot in shots])
    poses = np.empty((*angles.shape, 4), np.float32)
    poses[:, :, 0] = positions[:, :, 0] + (cosine * x - sine * y)
    poses[:, :, 1] = positions[:, :, 1] + (sine * x + cosine * y)
    poses[:, :, 2] = shots[0].shape_serials[members] % _LAYERS * _LAYER_STEP
    poses[:, :, 3] = np.remainder(angles + turn, 2 * np.pi)
    return poses
