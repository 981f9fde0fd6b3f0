"""Where two bodies touch: one file a kind of pair, one line here.

A collider is a kernel `collide(count, bodies, motions, arbiters, contacts)`: of the first `count` arbiters, which
have no contacts yet, it fills those whose two shapes are its own. The world calls
only those whose shapes it holds, so a world of boxes neither compiles nor runs the others.
"""

from __future__ import annotations

from engine.narrow_phase import box_box, box_circle, circle_circle
from engine.shapes.box import BOX
from engine.shapes.circle import CIRCLE

COLLIDERS = {
    (BOX, BOX): box_box.collide,
    (BOX, CIRCLE): box_circle.collide,
    (CIRCLE, CIRCLE): circle_circle.collide,
}
