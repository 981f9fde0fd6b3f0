"""What each kind of shape looks like: a dark rim with a lighter face on top, or a line. A further kind is one entry."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from web.chains import chains
from web.parts import DISC, MARKED_DISC, SQUARE, Loose, Part, Pieces, rimmed
from web.polygons import polygons
from web.stage import Layer
from web.theme import LINE_TONE, RIM_TONE

LINE_WIDTH = 0.005  # of the view's height


def boxes(pieces: Pieces) -> Iterable[Part]:
    """Squares, drawn out."""
    return rimmed(SQUARE, SQUARE, pieces, pieces.sizes / 2.0)


def circles(pieces: Pieces) -> Iterable[Part]:
    """Discs with a mark that shows how they turn."""
    return rimmed(MARKED_DISC, DISC, pieces, np.repeat(pieces.sizes[:, :1], 2, axis=1))


def capsules(pieces: Pieces) -> Iterable[Part]:
    """A disc at either end and a rectangle between; as all have one colour, one does not see where they overlap."""
    length, radius = pieces.sizes.T
    end, zero = length / 2.0, np.zeros_like(length)
    for layer, tone, reach in ((Layer.RIM, RIM_TONE, radius), (Layer.FACE, 1.0, radius - pieces.rim(radius))):
        for mesh, half_x, middle in ((SQUARE, end, zero), (DISC, reach, -end), (DISC, reach, end)):
            half, offsets = np.column_stack([half_x, reach]), np.column_stack([middle, zero])
            yield Part(mesh, layer, tone, pieces.members, half, offsets)


def segments(pieces: Pieces) -> Iterable[Part]:
    """Lines about where they are: they are solid from both sides."""
    half = np.full((len(pieces.members), 2), LINE_WIDTH * pieces.view_height / 2.0)
    half[:, 0] = pieces.sizes[:, 0] / 2.0
    return (Part(SQUARE, Layer.FACE, LINE_TONE, pieces.members, half, np.zeros_like(half)),)


SHAPE_LOOKS: dict[str, Callable[[Pieces], Iterable[Part | Loose]]] = {
    "box": boxes,
    "circle": circles,
    "capsule": capsules,
    "polygon": polygons,
    "segment": segments,
    "chain": chains,
}
