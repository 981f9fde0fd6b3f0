"""What polygons look like: equal ones are one mesh drawn many times, and those of many kinds one mesh of all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from web.outlines import ARC_POINTS, grown, reach
from web.parts import RIM_SHARE, RIM_WIDTH, Loose, Mesh, Part, Pieces, fan
from web.stage import Layer
from web.theme import RIM_TONE

LOOSE_ARC_POINTS = 4  # of a rounded corner, where all points are sent with every frame
MOST_OUTLINES = 8  # with a mesh of their own: each costs every client two nodes, and every frame their messages

Outlines = tuple[np.ndarray, np.ndarray]  # of the rim and of the face, (V, 2) each [m]


def polygons(pieces: Pieces) -> Iterator[Part | Loose]:
    """The most frequent outlines as meshes of their own."""
    corners = corners_of(pieces)
    radii = pieces.sizes[:, 0]
    alike: dict[bytes, list[int]] = defaultdict(list)
    for k, own in enumerate(corners):
        alike[own.tobytes() + radii[k].tobytes()].append(k)
    groups = sorted(alike.values(), key=len, reverse=True)
    width = RIM_WIDTH * pieces.view_height
    for number, group in enumerate(groups[:MOST_OUTLINES]):
        yield from _equal(number, pieces.members[group], outlines_of(corners[group[0]], radii[group[0]], width))
    if rest := groups[MOST_OUTLINES:]:
        every = [outlines_of(corners[group[0]], radii[group[0]], width, LOOSE_ARC_POINTS) for group in rest]
        yield from _various(pieces.members, rest, every)


def corners_of(pieces: Pieces) -> list[np.ndarray]:
    """The corners (n, 2) of each piece, in its own frame [m]."""
    counts = pieces.frame.corner_counts.astype(np.int64)
    ends = np.cumsum(counts)
    return [pieces.frame.corners[ends[i] - counts[i] : ends[i]] for i in pieces.members]


def outlines_of(corners: np.ndarray, radius: float, width: float, arc_points: int = ARC_POINTS) -> Outlines:
    """Around the polygon, and around what a rim of that width leaves of it."""
    width = min(width, RIM_SHARE * (radius + reach(corners)))
    return grown(corners, radius, arc_points), grown(corners, radius - width, arc_points)


def _equal(number: int, members: np.ndarray, outlines: Outlines) -> Iterator[Part]:
    ones, zeros = np.ones((len(members), 2)), np.zeros((len(members), 2))
    for outline, layer, tone in zip(outlines, (Layer.RIM, Layer.FACE), (RIM_TONE, 1.0), strict=True):
        yield Part(Mesh(f"polygon_{number}", *fan(outline)), layer, tone, members, ones, zeros)


def _various(members: np.ndarray, groups: list[list[int]], every: list[Outlines]) -> Iterator[Loose]:
    for side, (layer, tone) in enumerate(((Layer.RIM, RIM_TONE), (Layer.FACE, 1.0))):
        vertices, owners, faces, first = [], [], [], 0
        for group, outlines in zip(groups, every, strict=True):
            for k in group:
                points, triangles = fan(outlines[side])
                vertices.append(points[:, :2])
                owners.append(np.full(len(points), members[k]))
                faces.append(triangles + first)
                first += len(points)
        yield Loose(layer, tone, np.vstack(vertices), np.concatenate(owners), np.vstack(faces).astype(np.uint32))
