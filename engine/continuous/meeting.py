"""When a shape on its way would go through another, and where it stops.

Outlines may overlap a little without harm: contacts do, and a box that slides over a floor of many pieces is a little
deeper than the next one's edge. So an impact is when they overlap by more than a depth that is small against what is
thinner; and a body that came from outside is then put back to where they touched. Outlines that overlap already may
sink further by half of that: who stops on the spot, as it is, would never be seen to approach, and stop for ever. Then
only axes on the side where they are now count: else the two sides of a thin wall could be taken for each other. Beyond
the ends of a line there is no such allowance: through the seam of two of them a splinter could get far.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.constants import CONTINUOUS_DEPTH, CONTINUOUS_NEAR, CONTINUOUS_SHARE
from engine.continuous.impact import NEVER, Task, impact_time, separation_at
from engine.continuous.outlines import NOW_X, NOW_Y, half_width, load_outline, reach_of, turn_outline
from engine.jit import kernel
from engine.lanes import sqrt
from engine.shapes.chain import CHAIN
from engine.vec2 import Vec2, cross, dot

EITHER = Vec2(0.0, 0.0)  # all axes count, on whichever side


@kernel
def depth_of(shape1, shape2, hulls):
    """By how much two shapes may overlap before one is held to go through the other [m]."""
    half1, half2 = half_width(shape1, hulls), half_width(shape2, hulls)
    thinner = min(half1, half2) if min(half1, half2) > 0.0 else max(half1, half2)
    return min(CONTINUOUS_DEPTH, CONTINUOUS_SHARE * thinner)


@kernel
def line_of(outline, count):
    """The direction of an outline of two corners."""
    x, y = outline[1, NOW_X] - outline[0, NOW_X], outline[1, NOW_Y] - outline[0, NOW_Y]
    length = sqrt(x * x + y * y)
    return Vec2(x / length, y / length)


@kernel
def is_behind(piece, piece_center, outline, count, center):
    """Whether the middle of an outline lies behind a piece of a chain, which is then nothing to it."""
    x, y = 0.0, 0.0
    for k in range(count):
        x += outline[k, NOW_X]
        y += outline[k, NOW_Y]
    middle = center + Vec2(x / count, y / count)
    start = piece_center + Vec2(piece[0, NOW_X], piece[0, NOW_Y])
    along = Vec2(piece[1, NOW_X] - piece[0, NOW_X], piece[1, NOW_Y] - piece[0, NOW_Y])
    return cross(along, middle - start) < 0.0


class Stop(NamedTuple):
    """When two shapes must stop so that neither goes through the other."""

    time: Any  # fraction of the step; NEVER
    sunk: Any  # whether they overlapped as the step began, and contacts did not keep them from sinking further


@kernel
def find_stop(shape_a, body_a, sweep_a, shape_b, body_b, sweep_b, hulls, scratch, end):
    """When shape A, or B, must stop, before `end`. scratch (3, 8, 5): room for two outlines and the corners of one."""
    a, b, corners = scratch[0], scratch[1], scratch[2]
    count_a = load_outline(shape_a, hulls, body_a, corners, a)
    count_b = load_outline(shape_b, hulls, body_b, corners, b)
    center_a = turn_outline(a, count_a, sweep_a, 0.0)
    center_b = turn_outline(b, count_b, sweep_b, 0.0)
    if shape_b.kind == CHAIN and is_behind(b, center_b, a, count_a, center_a):
        return Stop(NEVER, False)
    if shape_a.kind == CHAIN and is_behind(a, center_a, b, count_b, center_b):
        return Stop(NEVER, False)
    radii = shape_a.radius + shape_b.radius
    now = separation_at(0.0, radii, EITHER, a, count_a, sweep_a, b, count_b, sweep_b)
    depth = depth_of(shape_a, shape_b, hulls)
    near = CONTINUOUS_NEAR * depth
    line = line_of(b, count_b) if count_b == 2 else line_of(a, count_a) if count_a == 2 else EITHER
    along = dot(now.normal, line)
    close = now.separation < -depth * (0.5 - along * along)
    side = now.normal if close else EITHER
    goal, spare = -depth, depth
    if close:
        goal, spare = min(-depth, now.separation - 0.5 * depth), 0.0
    reach_a, reach_b = reach_of(a, count_a), reach_of(b, count_b)
    through = Task(radii, goal, spare, line, near, side, reach_a, reach_b)
    time = impact_time(through, a, count_a, sweep_a, b, count_b, sweep_b, end)
    if time < NEVER and now.separation > depth:
        touching = Task(radii, 0.0, 0.0, line, near, side, reach_a, reach_b)
        touch = impact_time(touching, a, count_a, sweep_a, b, count_b, sweep_b, time)
        time = min(touch, time)
    return Stop(time, now.separation < -0.5 * depth)
