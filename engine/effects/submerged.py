"""How much of a shape is in a fluid, and where: its outline clipped to the fluid's rectangle.

Clipping to one side after another: I. Sutherland and G. Hodgman, "Reentrant Polygon Clipping" (1974).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.effects.outlines import MOST_POINTS, moments
from engine.jit import kernel
from engine.vec2 import Vec2, rotate

CLIPPED_POINTS = MOST_POINTS + 4  # each side that clips a convex polygon adds one corner at most


class Region(NamedTuple):
    """A rectangle as seen from a shape [m]."""

    left: Any
    bottom: Any
    right: Any
    top: Any


class Submerged(NamedTuple):
    """A part of a shape."""

    area: Any  # [m^2]
    moment: Vec2  # first moment of area about the origin of the shape's own frame, turned as the world is [m^3]


@kernel
def submerged(outline, whole, q, region, work):
    """The part of a shape inside a region: outline (n, 2) in the shape's frame, q its rotation, work (2, m, 2)."""
    reach = whole.reach
    if region.left >= reach or region.bottom >= reach or region.right <= -reach or region.top <= -reach:
        return Submerged(0.0, Vec2(0.0, 0.0))
    left_open, bottom_open = region.left <= -reach, region.bottom <= -reach
    right_open, top_open = region.right >= reach, region.top >= reach
    if left_open and bottom_open and right_open and top_open:
        return Submerged(whole.area, rotate(q, Vec2(whole.moment_x, whole.moment_y)))
    count = len(outline)
    for k in range(count):
        point = rotate(q, Vec2(outline[k, 0], outline[k, 1]))
        work[0, k, 0] = point.x
        work[0, k, 1] = point.y
    now = 0
    if not top_open:
        count = clip(work[now], count, 1, 1.0, region.top, work[1 - now])
        now = 1 - now
    if not bottom_open:
        count = clip(work[now], count, 1, -1.0, region.bottom, work[1 - now])
        now = 1 - now
    if not right_open:
        count = clip(work[now], count, 0, 1.0, region.right, work[1 - now])
        now = 1 - now
    if not left_open:
        count = clip(work[now], count, 0, -1.0, region.left, work[1 - now])
        now = 1 - now
    area, moment_x, moment_y = moments(work[now], count)
    return Submerged(area, Vec2(moment_x, moment_y))


@kernel
def clip(points, count, axis, sign, limit, kept):
    """Keeps what lies on one side of a line: sign x coordinate <= sign x limit. Returns how many corners that has."""
    total = 0
    before = count - 1
    for k in range(count):
        was = sign * (points[before, axis] - limit)
        now = sign * (points[k, axis] - limit)
        if (was <= 0.0) != (now <= 0.0):
            other = 1 - axis
            part = was / (was - now)
            kept[total, axis] = limit
            kept[total, other] = points[before, other] + part * (points[k, other] - points[before, other])
            total += 1
        if now <= 0.0:
            kept[total, 0] = points[k, 0]
            kept[total, 1] = points[k, 1]
            total += 1
        before = k
    return total
