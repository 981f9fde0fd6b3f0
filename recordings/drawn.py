"""What rerun draws for pieces: a shape sent once with an instance a piece, or points that follow the pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import rerun as rr

from recordings import palette
from recordings.outlines import Outline

HALF_DEPTH = 0.01  # of every solid along the line of sight [m]; 3D shapes seen by a far camera make the 2D picture
_SPOKE_WIDTH = 0.06  # of a circle's radius line, in radii
_FILL = (
    rr.components.FillMode.TransparentFillMajorWireframe
)  # a filled shape with its outline: neighbours of one hue stay apart

Columns = list[rr.ComponentColumn]


@dataclass
class Solids:
    """Boxes, discs, and the spokes that show how discs turn."""

    kind: str  # "boxes", "circles" or "circles/spokes"
    members: np.ndarray
    sizes: np.ndarray  # (M, 2) [m]
    colors: np.ndarray  # (M, 3)

    def shape_columns(self) -> Columns:
        sizes, count = self.sizes.astype(np.float32), [len(self.members)]
        depth = np.full(len(sizes), HALF_DEPTH, np.float32)
        if self.kind == "boxes":
            columns = rr.Boxes3D.columns(half_sizes=np.column_stack([sizes / 2, depth]), colors=self.colors)
            mode = rr.Boxes3D.columns(fill_mode=[_FILL])
        elif self.kind == "circles":
            columns = rr.Cylinders3D.columns(lengths=2 * depth, radii=sizes[:, 0], colors=self.colors)
            mode = rr.Cylinders3D.columns(fill_mode=[_FILL])
        else:
            radius = sizes[:, 0]
            half_sizes = np.column_stack([radius / 2, radius * _SPOKE_WIDTH / 2, depth])
            centers = np.column_stack([radius / 2, 0 * radius, depth / 2])
            columns = rr.Boxes3D.columns(half_sizes=half_sizes, centers=centers, colors=self.colors)
            mode = rr.Boxes3D.columns(fill_mode=[rr.components.FillMode.Solid])
        return [*columns.partition(count), *mode]

    def empty_columns(self) -> Columns:
        none = np.zeros(0, np.int64)
        return Solids(self.kind, none, self.sizes[:0], self.colors[:0]).shape_columns()

    def pose_columns(self, poses: np.ndarray) -> Columns:
        return _instance_poses(poses)


@dataclass
class Alike:
    """Pieces of one outline and one colour."""

    members: np.ndarray
    outline: Outline
    color: np.ndarray  # (3,)

    def shape_columns(self) -> Columns:
        return _mesh_columns(self.outline.vertices, _mesh_colors(self.outline, self.color), self.outline.triangles)

    def empty_columns(self) -> Columns:
        return _no_mesh()

    def pose_columns(self, poses: np.ndarray) -> Columns:
        return _instance_poses(poses)


class Various:
    """Pieces of which hardly two look the same: one mesh, all vertices of which are sent with every step."""

    def __init__(self, pieces: dict[int, Outline], colors: np.ndarray) -> None:
        self.members = np.array(list(pieces), np.int64)
        every = list(pieces.values())
        counts = np.array([len(outline.vertices) for outline in every])
        self._local = np.vstack([outline.vertices for outline in every])
        self._place = np.repeat(np.arange(len(every)), counts)  # of each vertex's piece among the members
        firsts = np.cumsum(counts) - counts
        self._triangles = np.vstack([o.triangles + first for o, first in zip(every, firsts, strict=True)])
        self._colors = np.vstack([_mesh_colors(o, colors[piece]) for piece, o in pieces.items()])

    def shape_columns(self) -> Columns:
        return _mesh_columns(None, self._colors, self._triangles.astype(np.uint32))

    def empty_columns(self) -> Columns:
        return _no_mesh()

    def pose_columns(self, poses: np.ndarray) -> Columns:
        points = _to_world(poses[:, self._place], self._local[:, :2])
        points[:, :, 2] += self._local[:, 2]
        count = np.full(len(points), points.shape[1])
        return list(rr.Mesh3D.columns(vertex_positions=points.reshape(-1, 3)).partition(count))


@dataclass
class Lines:
    """Segments and pieces of chains; or the bands along the right of a chain's pieces, on which it is solid."""

    members: np.ndarray
    lengths: np.ndarray  # (M,) [m]
    colors: np.ndarray  # (M, 3)
    width: float = 0.0  # of a band [m]; 0: a line

    def shape_columns(self) -> Columns:
        count = [len(self.members)]
        radius = self.width / 2 if self.width else rr.Radius.ui_points(1.5)
        colors = rr.LineStrips3D.columns(colors=self.colors).partition(count)
        return [*colors, *rr.LineStrips3D.columns(radii=[radius])]

    def empty_columns(self) -> Columns:
        return list(rr.LineStrips3D.columns(strips=np.zeros((0, 2, 3), np.float32)).partition([0]))

    def pose_columns(self, poses: np.ndarray) -> Columns:
        ends = []
        for side in (-0.5, 0.5):
            local = np.column_stack([side * self.lengths, np.full(len(self.lengths), -self.width / 2)])
            ends.append(_to_world(poses, local))
        strips = np.stack(ends, axis=2)
        strips[..., 2] -= HALF_DEPTH * bool(self.width)
        count = np.full(len(strips), strips.shape[1])
        return list(rr.LineStrips3D.columns(strips=strips.reshape(-1, 2, 3)).partition(count))


def _mesh_colors(outline: Outline, color: np.ndarray) -> np.ndarray:
    return np.where(outline.is_face[:, None], palette.faded(color), color)


def _mesh_columns(vertices: np.ndarray | None, colors: np.ndarray, triangles: np.ndarray) -> Columns:
    """One row; without vertices where these follow with the poses."""
    columns = [
        *rr.Mesh3D.columns(vertex_colors=colors).partition([len(colors)]),
        *rr.Mesh3D.columns(triangle_indices=triangles).partition([len(triangles)]),
    ]
    if vertices is not None:
        columns += rr.Mesh3D.columns(vertex_positions=vertices).partition([len(vertices)])
    return columns


def _no_mesh() -> Columns:
    """One row: nothing to draw."""
    nothing = np.zeros((0, 3), np.float32)
    return [*rr.Mesh3D.columns(vertex_positions=nothing).partition([0])]


def _instance_poses(poses: np.ndarray) -> Columns:
    """K rows of instances."""
    rows = poses.reshape(-1, 4)
    turn = np.zeros((len(rows), 4), np.float32)  # quaternions about z
    turn[:, 2], turn[:, 3] = np.sin(rows[:, 3] / 2), np.cos(rows[:, 3] / 2)
    columns = rr.InstancePoses3D.columns(translations=rows[:, 0:3], quaternions=turn)
    return list(columns.partition(np.full(len(poses), poses.shape[1])))


def _to_world(poses: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Points (M, 2) in the frames of their pieces (K, M, 4): (K, M, 3) float32."""
    cosine, sine = np.cos(poses[:, :, 3]), np.sin(poses[:, :, 3])
    points = poses[:, :, :3].copy()
    points[:, :, 0] += cosine * local[:, 0] - sine * local[:, 1]
    points[:, :, 1] += sine * local[:, 0] + cosine * local[:, 1]
    return points.astype(np.float32)
