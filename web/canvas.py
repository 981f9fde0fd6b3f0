"""The bodies: a few unit meshes, each a batch of as many copies as there are, whatever the number of bodies.

Poses go out with every frame; sizes, colours and outlines only when bodies or shapes came or went.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import viser

from engine import SHAPE_KINDS
from sandbox.frame import Frame
from web.batches import Batch, LooseMesh, Poses
from web.parts import Loose, Part, Pieces, square_corners
from web.shapes import SHAPE_LOOKS
from web.stage import Layer, Stage
from web.theme import BACKDROP, GRID, GRID_SECTION, body_colours

GRID_CELLS = (0.5, 1.0, 5.0, 10.0, 50.0, 100.0)  # m
GRID_SIZE, BACKDROP_SIZE = 60.0, 200.0  # in view heights: beyond what one can zoom out to


class Canvas:
    """Draws frames. Called by one thread at a time."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._scene = server.scene
        self._batches: dict[tuple[str, Layer], Batch] = {}
        self._loose: dict[tuple[bytes, Layer], LooseMesh] = {}
        self._stage: Stage | None = None
        self._content = -1
        self._serials = self._shape_serials = np.zeros(0, np.int64)
        self._loose_parts: list[Loose] = []
        self._asleep = np.zeros(0, np.bool_)
        self._grid_shown = True

    def draw(self, frame: Frame, stage: Stage) -> None:
        if stage != self._stage:
            self._stage = stage
            self._draw_backdrop(stage)
            self._draw_grid(stage)
            self._content = -1
        if self._is_new(frame):
            self._select(frame, stage)
        elif not np.array_equal(frame.asleep, self._asleep):
            self._colour(frame, stage)
        poses = Poses.of(frame)
        for batch in self._batches.values():
            batch.pose(poses)
        for mesh in self._loose.values():
            mesh.pose(poses)

    def show_grid(self, shown: bool) -> None:
        self._grid_shown = shown
        if self._stage is not None:
            self._draw_grid(self._stage)

    def _is_new(self, frame: Frame) -> bool:
        """Whether bodies or shapes came or went. A recording's frames may all have the same content number."""
        same = (
            frame.content == self._content
            and np.array_equal(frame.serials, self._serials)
            and np.array_equal(frame.shape_serials, self._shape_serials)
        )
        self._content, self._serials, self._shape_serials = frame.content, frame.serials, frame.shape_serials
        return not same

    def _select(self, frame: Frame, stage: Stage) -> None:
        """Takes up what there is to draw. Numbers may have changed, so poses must follow at once."""
        parts: dict[tuple[str, Layer], list[Part]] = defaultdict(list)
        loose: list[Loose] = []
        for kind, name in enumerate(SHAPE_KINDS):
            members = np.flatnonzero(frame.shape_kinds == kind)
            if not len(members):
                continue
            for part in SHAPE_LOOKS[name](Pieces(frame, members, stage.height)):
                if isinstance(part, Loose):
                    loose.append(part)
                else:
                    parts[part.mesh.name, part.layer].append(part)
        for key in parts.keys() | self._batches.keys():
            if key not in self._batches:
                self._batches[key] = Batch(self._scene, parts[key][0].mesh, key[1])
            self._batches[key].select(parts.get(key, []), stage)
        self._loose_parts = loose
        self._colour(frame, stage)

    def _colour(self, frame: Frame, stage: Stage) -> None:
        """Gives all pieces their bodies' colours, which change when these fall asleep and wake."""
        self._asleep = frame.asleep
        colours = body_colours(frame.serials, frame.body_kinds, frame.asleep)[frame.owners]
        for batch in self._batches.values():
            batch.colour(colours)
        self._select_loose(colours, stage)

    def _select_loose(self, colours: np.ndarray, stage: Stage) -> None:
        """A mesh for each colour in which there are any."""
        for mesh in self._loose.values():
            mesh.clear()
        for part in self._loose_parts:
            own = colours[part.pieces]
            for colour in np.unique(own, axis=0):
                key = colour.tobytes(), part.layer
                if key not in self._loose:
                    self._loose[key] = LooseMesh(self._scene, colour, part)
                self._loose[key].select(part, (own == colour).all(axis=1), stage)

    def _draw_backdrop(self, stage: Stage) -> None:
        """A plain far larger than the view, in place of the page's own black."""
        vertices, faces = square_corners()
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
