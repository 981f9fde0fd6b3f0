"""Who is fast: bodies that go further in a step than a part of the half width of their thinnest shape.

Whoever is slower is less than halfway in when contacts find it, and pushed out on the side it came from. That contacts
look ahead by the speculative distance does not count: soft as they are, they let 3 percent of a speed through.
"""

from __future__ import annotations

import numpy as np

from engine.continuous.outlines import half_width, load_outline, reach_of
from engine.jit import kernel

SLOWEST = np.dtype(
    [
        ("way", np.float64),  # a body is fast if it goes further than this in a step [m]
        ("reach", np.float64),  # and its corners are so far from its centre of mass, which counts for spin [m]
    ]
)
"""Which way is a long one: one row a body, and one more for all together: the least way and the greatest reach."""

NO_LIMIT = 1e30


@kernel
def measure_bodies(dynamic, first_shapes, shape_rows, shapes, hulls, bodies, share, of_line, slowest, reaches):
    """Writes the row of every dynamic body, and into the last one that for all of them. The rest are never fast.

    share: part of its half width that a body may go; of_line: what it may where it has none [m].

    first_shapes (B + 1,), shape_rows: see Content. reaches (S,): how far each shape's core is from its body's centre of
    mass, plus its radius [m].
    """
    outline, corners = np.empty((8, 5)), np.empty((8, 2))
    for row in range(len(slowest)):
        slowest[row].way, slowest[row].reach = NO_LIMIT, 0.0
    least, furthest = NO_LIMIT, 0.0
    for row in range(len(first_shapes) - 1):
        body = bodies[row]
        for k in range(first_shapes[row], first_shapes[row + 1]):
            shape = shapes[shape_rows[k]]
            count = load_outline(shape, hulls, body, corners, outline)
            reaches[shape_rows[k]] = reach_of(outline, count) + shape.radius
    for row in dynamic:
        limit, reach = NO_LIMIT, 0.0
        for k in range(first_shapes[row], first_shapes[row + 1]):
            shape = shapes[shape_rows[k]]
            half = half_width(shape, hulls)
            limit = min(limit, share * half if half > 0.0 else of_line)
            reach = max(reach, reaches[shape_rows[k]] - shape.radius)
        slowest[row].way, slowest[row].reach = limit, reach
        least, furthest = min(least, limit), max(furthest, reach)
    slowest[len(slowest) - 1].way, slowest[len(slowest) - 1].reach = least, furthest
