"""Bodies as filled shapes: their looks are sent when they change, their poses once a step in which they moved."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import rerun as rr

from engine import BODY_KINDS, SHAPE_KINDS
from recordings import palette
from recordings.columns import Sheet, time_columns
from recordings.roster import Run
from recordings.shot import Shot

HALF_DEPTH = 0.01  # of every shape along the line of sight [m]; 3D shapes seen by a far camera make the 2D picture
_LAYERS = 8  # shapes of neighbouring serials lie at different depths, or overlapping faces would flicker
_LAYER_STEP = 0.004  # [m]
_SPOKE_WIDTH = 0.06  # of a circle's radius line, in radii
_FILL = (
    rr.components.FillMode.TransparentFillMajorWireframe
)  # a filled shape with its outline: neighbours of one hue stay apart
_STATIC = BODY_KINDS.index("static")


class BodiesView:
    """Turns runs of shots into sheets; remembers what was sent last."""

    def __init__(self) -> None:
        self._sent: dict[str, bytes] = {}  # last poses of each entity
        self._groups: dict[str, np.ndarray] = {}  # indices of the bodies shown by each entity

    def sheets(self, run: Run) -> Iterator[Sheet]:
        """The shapes if they changed, then the poses of the bodies that moved."""
        if run.changed:
            yield from self._shapes(run.shots[0])
        for path, members in self._groups.items():
            if len(members):
                yield from self._poses(path, members, run.shots)

    def _shapes(self, shot: Shot) -> Iterator[Sheet]:
        groups = _groups(shot)
        times = time_columns([shot.step], [shot.time])
        for path, members in groups.items():
            # An entity that never had a body is left out; one that lost its last body is sent empty once.
            if len(members) or len(self._groups.get(path, ())):
                yield Sheet(path, times, _shape_columns(path, shot, members))
        self._groups = groups
        self._sent.clear()

    def _poses(self, path: str, members: np.ndarray, shots: list[Shot]) -> Iterator[Sheet]:
        layers = (shots[0].serials[members] % _LAYERS * _LAYER_STEP).astype(np.float32)
        poses = np.empty((len(shots), len(members), 4), np.float32)  # x, y, z, angle
        poses[:, :, 0:2] = np.stack([shot.positions[members] for shot in shots])
        poses[:, :, 2] = layers
        poses[:, :, 3] = np.stack([np.remainder(shot.angles[members], 2 * np.pi) for shot in shots])
        moved = self._moved(path, poses)
        if not len(moved):
            return
        times = time_columns([shots[i].step for i in moved], [shots[i].time for i in moved])
        poses = poses[moved].reshape(-1, 4)
        turn = np.zeros((len(poses), 4), np.float32)  # quaternions about z
        turn[:, 2], turn[:, 3] = np.sin(poses[:, 3] / 2), np.cos(poses[:, 3] / 2)
        columns = rr.InstancePoses3D.columns(translations=poses[:, 0:3], quaternions=turn)
        yield Sheet(path, times, list(columns.partition(np.full(len(moved), len(members)))))

    def _moved(self, path: str, poses: np.ndarray) -> np.ndarray:
        """Which shots differ from the one before, (k,) indices."""
        rows = [row.tobytes() for row in poses]
        before = [self._sent.get(path), *rows[:-1]]
        self._sent[path] = rows[-1]
        return np.array([i for i, row in enumerate(rows) if row != before[i]], np.int64)


def _groups(shot: Shot) -> dict[str, np.ndarray]:
    """Indices of the bodies that each entity shows; static ones apart so that they can be switched off."""
    static = shot.body_kinds == _STATIC
    groups = {}
    for kind, shape in enumerate(SHAPE_KINDS):
        for folder, of_folder in (("static", static), ("bodies", ~static)):
            members = np.flatnonzero(of_folder & (shot.shape_kinds == kind))
            for part in ("boxes",) if shape == "box" else ("circles", "circles/spokes"):
                groups[f"/world/{folder}/{part}"] = members
    return groups


def _shape_columns(path: str, shot: Shot, members: np.ndarray) -> list[rr.ComponentColumn]:
    """One row with the shape of each member, in its own frame."""
    sizes = shot.sizes[members].astype(np.float32)
    colors = palette.body_colors(shot.serials[members], shot.body_kinds[members] == _STATIC)
    count = [len(members)]
    depth = np.full(len(members), HALF_DEPTH, np.float32)
    if path.endswith("boxes"):
        half_sizes = np.column_stack([sizes / 2, depth])
        columns = rr.Boxes3D.columns(half_sizes=half_sizes, colors=colors)
        mode = rr.Boxes3D.columns(fill_mode=[_FILL])
    elif path.endswith("circles"):
        columns = rr.Cylinders3D.columns(lengths=2 * depth, radii=sizes[:, 0], colors=colors)
        mode = rr.Cylinders3D.columns(fill_mode=[_FILL])
    else:
        radius, zero = sizes[:, 0], np.zeros(len(members), np.float32)
        half_sizes = np.column_stack([radius / 2, radius * _SPOKE_WIDTH / 2, depth])
        centers = np.column_stack([radius / 2, zero, zero + HALF_DEPTH / 2])
        columns = rr.Boxes3D.columns(half_sizes=half_sizes, centers=centers, colors=colors)
        mode = rr.Boxes3D.columns(fill_mode=[rr.components.FillMode.Solid])
    return [*columns.partition(count), *mode]
