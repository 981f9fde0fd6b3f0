"""Which entity shows which pieces, and as what."""

from __future__ import annotations

from collections import defaultdict
from typing import Protocol

import numpy as np

from engine import BODY_KINDS, SHAPE_KINDS
from recordings import palette
from recordings.drawn import Alike, Columns, Lines, Solids, Various
from recordings.outlines import Outline, outlines
from recordings.shot import Shot

MOST_OUTLINES = 24  # with an entity of their own: each is a chunk more in every block
BAND_WIDTH = 0.012  # of the view's height: along the side on which a chain is solid
_STATIC = BODY_KINDS.index("static")


class Look(Protocol):
    """How one entity shows its pieces."""

    members: np.ndarray  # (M,) their indices in the shot

    def shape_columns(self) -> Columns:
        """One row: what they look like, sent when bodies or shapes came or went."""

    def empty_columns(self) -> Columns:
        """One row that takes them out of the picture."""

    def pose_columns(self, poses: np.ndarray) -> Columns:
        """K rows, from where they are: x, y, depth and angle, (K, M, 4)."""


def looks(shot: Shot, view_height: float) -> dict[str, Look]:
    """What each entity shows of a shot; static bodies apart so that they can be switched off."""
    colors = palette.body_colors(shot.serials, shot.body_kinds)[shot.owners]
    static = (shot.body_kinds == _STATIC)[shot.owners]
    every_outline = outlines(shot, view_height)
    found: dict[str, Look] = {}
    for folder, chosen in (("/world/static", static), ("/world/bodies", ~static)):
        for name in ("box", "circle"):
            for part in ("boxes",) if name == "box" else ("circles", "circles/spokes"):
                own = _of_kind(shot, name, chosen)
                if len(own):
                    found[f"{folder}/{part}"] = Solids(part, own, shot.sizes[own], colors[own])
        own_outlines = {piece: outline for piece, outline in every_outline.items() if chosen[piece]}
        found |= {f"{folder}/outlines/{name}": look for name, look in _outline_looks(own_outlines, colors).items()}
        for name, width in (("segment", 0.0), ("chain", 0.0), ("chain", BAND_WIDTH * view_height)):
            own = _of_kind(shot, name, chosen)
            shades = palette.faded(colors[own]) if width else colors[own]
            if len(own):
                found[f"{folder}/{name}s{'/solid_side' if width else ''}"] = Lines(
                    own, shot.sizes[own, 0], shades, width
                )
    return found


def _of_kind(shot: Shot, name: str, chosen: np.ndarray) -> np.ndarray:
    return np.flatnonzero(chosen & (shot.shape_kinds == SHAPE_KINDS.index(name)))


def _outline_looks(pieces: dict[int, Outline], colors: np.ndarray) -> dict[str, Look]:
    """The most frequent outlines as entities of their own, the others in one mesh."""
    alike: dict[tuple[int, bytes], list[int]] = defaultdict(list)
    for piece, outline in pieces.items():
        alike[id(outline), colors[piece].tobytes()].append(piece)
    groups = sorted(alike.values(), key=len, reverse=True)
    found: dict[str, Look] = {
        str(number): Alike(np.array(group), pieces[group[0]], colors[group[0]])
        for number, group in enumerate(groups[:MOST_OUTLINES])
    }
    others = {piece: pieces[piece] for group in groups[MOST_OUTLINES:] for piece in group}
    return found | ({"various": Various(others, colors)} if others else {})
