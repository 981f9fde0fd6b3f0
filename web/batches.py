"""What the canvas fills: batches of one mesh in many places, and meshes of which every vertex has its own place."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import viser

from sandbox.frame import Frame
from web.parts import Loose, Mesh, Part
from web.stage import Layer, Stage
from web.theme import to_linear, toned


class Poses(NamedTuple):
    """Where the pieces' own frames are, S of them."""

    positions: np.ndarray  # (S, 2) [m]
    cosine: np.ndarray  # (S,)
    sine: np.ndarray
    turns: np.ndarray  # (S, 4) float32 quaternions, w first

    @classmethod
    def of(cls, frame: Frame) -> Poses:
        positions, angles = frame.shape_poses()
        turns = np.zeros((len(angles), 4), np.float32)
        turns[:, 0], turns[:, 3] = np.cos(angles / 2.0), np.sin(angles / 2.0)
        return cls(positions, np.cos(angles), np.sin(angles), turns)

    def to_world(self, pieces: np.ndarray, local: np.ndarray) -> np.ndarray:
        """Points (K, 2) in the frames of these pieces (K,), in the world [m]."""
        cosine, sine = self.cosine[pieces], self.sine[pieces]
        points = self.positions[pieces]
        points[:, 0] += cosine * local[:, 0] - sine * local[:, 1]
        points[:, 1] += sine * local[:, 0] + cosine * local[:, 1]
        return points


class Batch:
    """One mesh in one layer, in any number of places."""

    def __init__(self, scene: viser.SceneApi, mesh: Mesh, layer: Layer) -> None:
        self._layer = layer
        self._handle = scene.add_batched_meshes_simple(
            f"/bodies/{mesh.name}/{layer.name.lower()}",
            mesh.vertices,
            mesh.faces,
            batched_wxyzs=np.zeros((0, 4), np.float32),
            batched_positions=np.zeros((0, 3), np.float32),
            batched_scales=np.zeros((0, 3), np.float32),
            batched_colors=np.zeros((0, 3), np.uint8),
            lod="off",
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )
        self._pieces = np.zeros(0, np.int64)
        self._tones = np.zeros((0, 1))
        self._offsets: np.ndarray | None = None  # None: all are zero, as most are
        self._z = 0.0

    def select(self, parts: list[Part], stage: Stage) -> None:
        """Take up these parts. They have no colours yet."""
        if not parts and not len(self._pieces):
            return
        self._z = stage.z(self._layer)
        self._pieces = np.concatenate([np.zeros(0, np.int64), *(part.pieces for part in parts)])
        offsets = np.concatenate([np.zeros((0, 2)), *(part.offsets for part in parts)])
        self._offsets = offsets if offsets.any() else None
        scales = np.full((len(self._pieces), 3), stage.gap, np.float32)
        scales[:, :2] = np.concatenate([np.zeros((0, 2)), *(part.scales for part in parts)])
        self._tones = np.repeat([part.tone for part in parts], [len(part.pieces) for part in parts])[:, None]
        if parts:
            self._handle.vertices, self._handle.faces = parts[0].mesh.vertices, parts[0].mesh.faces
        self._handle.batched_scales = scales
        if not parts:
            self._handle.batched_positions = np.zeros((0, 3), np.float32)
            self._handle.batched_wxyzs = np.zeros((0, 4), np.float32)

    def colour(self, colours: np.ndarray) -> None:
        """Take up colours: those of all pieces of the frame, (S, 3)."""
        self._handle.batched_colors = to_linear(toned(colours[self._pieces], self._tones))

    def pose(self, poses: Poses) -> None:
        pieces = self._pieces
        if not len(pieces):
            return
        places = np.full((len(pieces), 3), self._z, np.float32)
        places[:, :2] = poses.positions[pieces] if self._offsets is None else poses.to_world(pieces, self._offsets)
        self._handle.batched_positions = places
        self._handle.batched_wxyzs = poses.turns[pieces]


class LooseMesh:
    """A mesh in one colour and layer of pieces that each look different: its vertices are sent with every frame."""

    def __init__(self, scene: viser.SceneApi, colour: np.ndarray, part: Loose) -> None:
        name = "".join(f"{value:02x}" for value in colour.tolist())
        self._handle = scene.add_mesh_simple(
            f"/bodies/loose/{part.layer.name.lower()}/{name}",
            np.zeros((3, 3), np.float32),
            np.array([(0, 1, 2)], np.uint32),
            color=tuple(toned(colour, part.tone).tolist()),
            side="double",
            visible=False,
            cast_shadow=False,
            receive_shadow=False,
        )
        self._part = part
        self._chosen = np.zeros(0, np.int64)
        self._z = 0.0

    def clear(self) -> None:
        self._chosen = np.zeros(0, np.int64)
        self._handle.visible = False

    def select(self, part: Loose, chosen: np.ndarray, stage: Stage) -> None:
        """Take up those vertices (V,) of the part; whoever has one vertex of a piece has them all."""
        self._part, self._chosen = part, np.flatnonzero(chosen)
        self._z = stage.z(part.layer)
        numbers = np.cumsum(chosen) - 1
        self._handle.faces = numbers[part.faces[chosen[part.faces[:, 0]]]].astype(np.uint32)
        self._handle.visible = True

    def pose(self, poses: Poses) -> None:
        chosen, part = self._chosen, self._part
        if not len(chosen):
            return
        vertices = np.full((len(chosen), 3), self._z, np.float32)
        vertices[:, :2] = poses.to_world(part.pieces[chosen], part.vertices[chosen])
        self._handle.vertices = vertices
