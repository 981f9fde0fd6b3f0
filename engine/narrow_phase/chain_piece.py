"""One piece of a chain, and what it knows of its neighbours: enough to leave to them what is theirs.

In its own frame a piece runs from (-half_x, 0) to (half_x, 0); what is above is outside, and nothing touches it from
below. Its ghosts are the far ends of the pieces before and after it. A ghost that is the piece's own end makes that end
a free one: the chain stops there, as if a wall went down from it that nothing touches.

A joint of two pieces is *convex* where the chain turns down. The normals between those of the two pieces are then the
corner's, and the piece that begins there owns it; a free end is owned by its only piece. At a flat or concave joint no
normal but the pieces' own is possible: what slides over it never feels an edge.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.jit import kernel
from engine.lanes import const, sqrt
from engine.vec2 import Vec2, dot

FLAT = 1e-5
"""A joint that turns by less [rad] is flat. Zero: rounding makes joints of a straight chain convex or concave."""

IN_PLACE = 1e-5
"""A ghost nearer than this to the piece's own end, as part of half its length, is that end. Zero: rounding gives it a
direction."""

JOINT_SLACK = 1e-4
"""By so much [m] two pieces overlap at their joint. Zero: what stands exactly over it may, by rounding, miss both."""


class Neighbour(NamedTuple):
    """What one end of a piece borders on."""

    end: Vec2  # that end of the piece [m]
    along: Vec2  # unit, direction of travel on the neighbour's side; downwards beyond a free end, upwards before one
    convex: Any
    free: Any
    owned: Any  # whether the corner there is this piece's


class Piece(NamedTuple):
    """A piece in its own frame."""

    half_x: Any
    before: Neighbour
    after: Neighbour


@kernel
def load_piece(half_x, ghost1, ghost2):
    """half_x: half its length; ghost1, ghost2: far ends of the pieces before and after, in its own frame [m]."""
    zero = const(0.0, half_x)
    one = const(1.0, half_x)
    flat = const(FLAT, half_x)
    start = Vec2(-half_x, zero)
    end = Vec2(half_x, zero)
    least = half_x * const(IN_PLACE, half_x)
    free1, along1 = direction(start - ghost1, least, Vec2(zero, one))
    free2, along2 = direction(ghost2 - end, least, Vec2(zero, -one))
    convex1 = along1.y > flat
    convex2 = along2.y < -flat
    before = Neighbour(start, along1, convex1, free1, convex1)
    after = Neighbour(end, along2, convex2, free2, free2)
    return Piece(half_x, before, after)


@kernel
def direction(offset, least, fallback):
    """Whether an offset is shorter than `least` [m], and its direction, or else the fallback."""
    length = sqrt(dot(offset, offset))
    if length > least:
        return False, Vec2(offset.x / length, offset.y / length)
    return True, fallback
