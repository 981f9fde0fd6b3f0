"""The bodies: one batch of meshes for each kind of shape, whatever the number of bodies.

Poses go out with every frame; sizes and colours only when bodies came or went.
"""

from __future__ import annotations

import numpy as np
import viser

from engine import BODY_KINDS, SHAPE_KINDS
from sandbox.frame import Frame
from web.shapes import SHAPE_LOOKS, Mesh, ShapeLook, square
from web.stage import Layer, Stage
from web.theme import BACKDROP, GRID, GRID_SECTION, RIM_TONE, body_colours, to_linear

RIM_WIDTH = 0.0045  # of the view's height
RIM_SHARE = 0.22  # at most this part of a body's smaller half extent, so that small bodies keep a face
GRID_CELLS = (0.5, 1.0, 5.0, 10.0, 50.0, 100.0)  # m
GRID_SIZE, BACKDROP_SIZE = 60.0, 200.0  # in view heights: beyond what one can zoom out to
STATIC_BODY = BODY_KINDS.index("static")


class Canvas:
    """Draws frames. Called by one thread at a time."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._scene = server.scene
        self._batches = [ShapeBatch(server, kind) for kind in SHAPE_KINDS]
        self._stage: Stage | None = None
        self._content = -1
        self._serials = np.zeros(0, np.int64)
        self._grid_shown = True

    def draw(self, frame: Frame, stage: Stage) -> None:
        if stage != self._stage:
            self._stage = stage
            self._draw_backdrop(stage)
            self._draw_grid(stage)
            self._content = -1
        # A recording's frames may all have the same content number, hence the look at the serials.
        if frame.content != self._content or not np.array_equal(frame.serials, self._serials):
            self._content, self._serials = frame.content, frame.serials
            for kind, batch in enumerate(self._batches):
                batch.select(frame, kind, stage)
        for batch in self._batches:
            batch.pose(frame)

    def show_grid(self, shown: bool) -> None:
        self._grid_shown = shown
        if self._stage is not None:
            self._draw_grid(self._stage)

    def _draw_backdrop(self, stage: Stage) -> None:
        """A plain far larger than the view, in place of the page's own black."""
        vertices, faces = square()
        vertices = vertices * BACKDROP_SIZE * stage.height
        place = (0.0, 0.0, stage.z(Layer.BACKDROP))
        self._scene.add_mesh_simple(
            "/backdrop", vertices, faces, color=BACKDROP, position=place, cast_shadow=False, receive_shadow=False
        )

    def _draw_grid(self, stage: Stage) -> None:
        """A grid with cells of a round size, of which about thirty fill the view's height."""
        cell = next((size for size in GRID_CELLS if stage.height / size <= 32.0), GRID_CELLS[-1])
        size = GRID_SIZE * stage.height
        self._scene.add_grid(
            "/grid",
            width=size,
            height=size,
            plane="xy",
            cell_size=cell,
            section_size=10.0 * cell,
            cell_color=GRID,
            section_color=GRID_SECTION,
            cell_thickness=0.8,
            section_thickness=1.0,
            fade_distance=1e9,
            fade_strength=0.0,
            shadow_opacity=0.0,
            position=(0.0, 0.0, stage.z(Layer.GRID)),
            visible=self._grid_shown,
        )


class ShapeBatch:
    """All bodies of one kind of shape: their rims, and their faces on top."""

    def __init__(self, server: viser.ViserServer, kind: str) -> None:
        self._look: ShapeLook = SHAPE_LOOKS[kind]
        self._rim = _add_batch(server, f"/bodies/{kind}/rim", self._look.rim)
        self._face = _add_batch(server, f"/bodies/{kind}/face", self._look.face)
        self._members = np.zeros(0, np.int64)
        self._z = (0.0, 0.0)

    def select(self, frame: Frame, kind: int, stage: Stage) -> None:
        """Take up the bodies of this kind. Their number may have changed, so their poses must follow at once."""
        members = np.flatnonzero(frame.shape_kinds == kind)
        self._members = members
        self._z = (stage.z(Layer.RIM), stage.z(Layer.FACE))
        outer = self._look.half_extents(frame.sizes[members])
        rim = np.minimum(RIM_WIDTH * stage.height, RIM_SHARE * outer.min(axis=1, initial=np.inf))
        self._rim.batched_scales = _scales(outer, stage)
        self._face.batched_scales = _scales(outer - rim[:, None], stage)
        colours = body_colours(frame.serials[members], frame.body_kinds[members] == STATIC_BODY)
        self._face.batched_colors = to_linear(colours)
        self._rim.batched_colors = to_linear(colours * RIM_TONE)

    def pose(self, frame: Frame) -> None:
        members = self._members
        turns = np.zeros((len(members), 4), np.float32)
        half = frame.angles[members] / 2.0
        turns[:, 0], turns[:, 3] = np.cos(half), np.sin(half)
        for handle, z in zip((self._rim, self._face), self._z, strict=True):
            places = np.full((len(members), 3), z, np.float32)
            places[:, :2] = frame.positions[members]
            handle.batched_positions = places
            handle.batched_wxyzs = turns


def _scales(half_extents: np.ndarray, stage: Stage) -> np.ndarray:
    scales = np.full((len(half_extents), 3), stage.gap, np.float32)
    scales[:, :2] = half_extents
    return scales


def _add_batch(server: viser.ViserServer, name: str, mesh: Mesh) -> viser.BatchedMeshHandle:
    return server.scene.add_batched_meshes_simple(
        name,
        *mesh,
        batched_wxyzs=np.zeros((0, 4), np.float32),
        batched_positions=np.zeros((0, 3), np.float32),
        batched_scales=np.zeros((0, 3), np.float32),
        batched_colors=np.zeros((0, 3), np.uint8),
        lod="off",
        side="double",
        cast_shadow=False,
        receive_shadow=False,
    )
