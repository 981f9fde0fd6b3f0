"""Where shapes are: their own frames, carried along by their bodies."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.constants import BOUNDS_MARGIN_RELATIVE
from engine.jit import kernel
from engine.lanes import absolute, const
from engine.rows import at, load_row, put, wide
from engine.simd import WIDTH
from engine.tables import SHAPE, empty
from engine.vec2 import Vec2, rotate

NUMBERS = ("local_x", "local_y", "local_cosine", "local_sine", "half_x", "half_y", "radius")
GROUP = np.dtype(
    [
        ("rank", np.int64),  # among the shapes in the order of creation
        ("row", np.int64),  # in the table of shapes
        ("body", np.int64),  # row of its body
        *((name, SHAPE[name]) for name in NUMBERS),  # as in SHAPE
    ]
)
"""What is read of a shape in each step, closely packed: a third of its row."""


def group_of(ranks: np.ndarray, order: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """(N / 8,) of eight shapes each, of those ranks (N,), filled up with the last; order: the rows by rank."""
    ranks = np.append(ranks, np.full(-len(ranks) % WIDTH, ranks[-1]))
    rows = order[ranks]
    group = empty(len(rows) // WIDTH, wide(GROUP))
    columns = {"rank": ranks, "row": rows} | {name: shapes[name][rows] for name in ("body", *NUMBERS)}
    for name, column in columns.items():
        group[name] = column.reshape(-1, WIDTH)
    return group


class Place(NamedTuple):
    """Where a shape is, or where eight are."""

    x: Any  # [m]
    y: Any
    cosine: Any  # rounded as in the table of placements
    sine: Any


@kernel
def put_shape(shape, row, bodies, motions, placements):
    """Puts a shape, or eight, where its body is now. shape: of SHAPE, or eight of GROUP; row: in SHAPE."""
    body = at(bodies, shape.body)
    _, _, _, _, _, cosine, sine, _ = load_row(motions, shape.body)
    x = body.x
    c, s = const(cosine, x), const(sine, x)
    out = rotate(Vec2(c, s), Vec2(shape.local_x, shape.local_y))
    turned_cosine = const(c * shape.local_cosine - s * shape.local_sine, cosine)
    turned_sine = const(s * shape.local_cosine + c * shape.local_sine, sine)
    put_x, put_y = x + out.x, body.y + out.y
    place = at(placements, row)
    place.x, place.y, place.cosine, place.sine = put_x, put_y, turned_cosine, turned_sine
    return Place(put_x, put_y, const(turned_cosine, x), const(turned_sine, x))


@kernel
def write_placements(order, shapes, bodies, motions, placements):
    """Puts every shape where its body is now."""
    for rank in range(len(order)):
        put_shape(shapes[order[rank]], order[rank], bodies, motions, placements)


@kernel
def write_bounds(ranks, place, reach_x, reach_y, margin, sides):
    """Writes the boxes that reach so far about their places, grown by `margin` [m]; sides: the rows of `bounds`."""
    lower_x, lower_y, upper_x, upper_y = sides
    reach_x += margin + BOUNDS_MARGIN_RELATIVE * (absolute(place.x) + reach_x)
    reach_y += margin + BOUNDS_MARGIN_RELATIVE * (absolute(place.y) + reach_y)
    put(lower_x, ranks, place.x - reach_x)
    put(lower_y, ranks, place.y - reach_y)
    put(upper_x, ranks, place.x + reach_x)
    put(upper_y, ranks, place.y + reach_y)
