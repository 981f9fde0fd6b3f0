"""Where two shapes touch: one file a kind of pair, one line here.

A collider is a kernel `collide(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions,
steps)`: it finds the contacts of the arbiters whose indices are chosen[first:last], all of its own kind of pair, in
either order; `chosen` is filled up with the row of no arbiter, for those that work on eight at a time. A world calls
only those whose pairs it holds, so a world of boxes neither compiles nor runs the others.
"""

from __future__ import annotations

import numpy as np

from engine.narrow_phase import box_box_talk, colliders
from engine.shapes import SHAPES
from engine.shapes.box import BOX
from engine.shapes.capsule import CAPSULE
from engine.shapes.chain import CHAIN
from engine.shapes.circle import CIRCLE
from engine.shapes.polygon import POLYGON
from engine.shapes.segment import SEGMENT

PAIRS = {
    (BOX, BOX): colliders.box_box,
    (BOX, CIRCLE): colliders.box_circle,
    (CIRCLE, CIRCLE): colliders.circle_circle,
    (CIRCLE, CAPSULE): colliders.circle_core,
    (CIRCLE, SEGMENT): colliders.circle_core,
    (CAPSULE, CAPSULE): colliders.core_core,
    (CAPSULE, SEGMENT): colliders.core_core,
    (CIRCLE, POLYGON): colliders.circle_polygon,
    (BOX, CAPSULE): colliders.hull_and_hull,
    (BOX, POLYGON): colliders.hull_and_hull,
    (BOX, SEGMENT): colliders.hull_and_hull,
    (CAPSULE, POLYGON): colliders.hull_and_hull,
    (POLYGON, POLYGON): colliders.hull_and_hull,
    (POLYGON, SEGMENT): colliders.hull_and_hull,
    (CIRCLE, CHAIN): colliders.circle_chain,
    (BOX, CHAIN): colliders.hull_chain,
    (CAPSULE, CHAIN): colliders.hull_chain,
    (POLYGON, CHAIN): colliders.hull_chain,
}
COLLIDERS = tuple(dict.fromkeys(PAIRS.values()))
TALK_COLLIDERS = tuple(box_box_talk.collide if kernel is colliders.box_box else kernel for kernel in COLLIDERS)

TOGETHER = {colliders.box_box: colliders.boxes_together, colliders.circle_circle: colliders.circles_together}
"""Colliders that several threads share, where there are thousands of pairs."""


def _table() -> np.ndarray:
    """(K, K) int32: by the kinds of two shapes the index of their collider; -1 where they never meet."""
    table = np.full((len(SHAPES), len(SHAPES)), -1, np.int32)
    for (first, second), kernel in PAIRS.items():
        table[first, second] = table[second, first] = COLLIDERS.index(kernel)
    return table


COLLIDER_OF = _table()
