"""A piece of a chain against a circle."""

from __future__ import annotations

from engine.jit import kernel
from engine.lanes import const
from engine.narrow_phase.chain_piece import JOINT_SLACK, load_piece
from engine.narrow_phase.circles import round_touch
from engine.narrow_phase.manifold_points import nothing, one_point, pack
from engine.vec2 import Vec2, dot, rotate, unrotate


@kernel
def beyond_start(before, seen):
    """Whether the corner where a piece begins touches what is at `seen`: not the piece before it."""
    return before.owned and dot(before.along, seen - before.end) >= -const(JOINT_SLACK, seen.x)


@kernel
def beyond_end(after, seen):
    """Whether the corner where a piece ends touches what is at `seen`."""
    return after.owned and dot(after.along, seen - after.end) <= const(JOINT_SLACK, seen.x)


@kernel
def collide_chain_circle(half_x, ghost1, ghost2, center1, q1, radius, center2, margin):
    """The manifold of a chain's piece (chain_piece.py) and a circle; see Manifold."""
    piece = load_piece(half_x, ghost1, ghost2)
    slack = const(JOINT_SLACK, half_x)
    seen = unrotate(q1, center2 - center1)
    up = Vec2(-q1.y, q1.x)
    zero = const(0.0, half_x)
    before = piece.before
    after = piece.after
    if seen.x < -half_x and (before.convex or seen.x < -half_x - slack):
        if not beyond_start(before, seen):
            return nothing(zero)
        return pack(round_touch(center1 + rotate(q1, before.end), zero, center2, radius, up), margin)
    if seen.x > half_x and (after.convex or seen.x > half_x + slack):
        if not beyond_end(after, seen):
            return nothing(zero)
        return pack(round_touch(center1 + rotate(q1, after.end), zero, center2, radius, up), margin)
    if seen.y < 0:
        return nothing(zero)
    middle = const(0.5, half_x) * (seen.y - radius)  # midway between the two surfaces
    point = center1 + rotate(q1, Vec2(seen.x, middle))
    return pack(one_point(up, point, seen.y - radius), margin)
