"""What sinks further though contacts hold it is taken the speed with which it does.

Contacts within a step act at points that turn with their bodies by straight pieces. A corner that comes round fast is
at another place half a substep later, where the push that it got is taken back as if it were not needed: it would sink
in a little with each step, and stop for ever. So where bodies that overlapped already have to stop, the speed of
approach at the very moment and point is taken from them, as by an impact without bouncing.
"""

from __future__ import annotations

import numpy as np

from engine.constants import CONTINUOUS_NEAR
from engine.continuous.impact import separation_at
from engine.continuous.meeting import EITHER
from engine.continuous.outlines import NOW_X, NOW_Y, load_outline, turn_outline
from engine.jit import kernel
from engine.vec2 import Vec2, cross, dot, spin


@kernel
def lowest(outline, count, normal, slack):
    """The corner that lies furthest against a normal; and whether it is the only one, or an edge lies so [m]."""
    best = 0
    least = outline[0, NOW_X] * normal.x + outline[0, NOW_Y] * normal.y
    for k in range(1, count):
        height = outline[k, NOW_X] * normal.x + outline[k, NOW_Y] * normal.y
        if height < least:
            best, least = k, height
    alike = 0
    for k in range(count):
        if outline[k, NOW_X] * normal.x + outline[k, NOW_Y] * normal.y < least + slack:
            alike += 1
    return Vec2(outline[best, NOW_X], outline[best, NOW_Y]), alike == 1


@kernel
def part(shape_a, shape_b, bodies, movers, motions, sweep_a, sweep_b, time, hulls, scratch):
    """Takes the speed with which two shapes approach at a time from the velocities of their bodies."""
    a, b, corners = scratch[0], scratch[1], scratch[2]
    count_a = load_outline(shape_a, hulls, bodies[shape_a.body], corners, a)
    count_b = load_outline(shape_b, hulls, bodies[shape_b.body], corners, b)
    radii = shape_a.radius + shape_b.radius
    side = separation_at(0.0, radii, EITHER, a, count_a, sweep_a, b, count_b, sweep_b).normal
    axis = separation_at(time, radii, side, a, count_a, sweep_a, b, count_b, sweep_b)
    normal = axis.normal
    slack = CONTINUOUS_NEAR * shape_a.radius + 1e-4
    center_a, center_b = turn_outline(a, count_a, sweep_a, time), turn_outline(b, count_b, sweep_b, time)
    arm_a, alone = lowest(a, count_a, normal, slack)
    arm_b, _ = lowest(b, count_b, -normal, slack)
    if alone:
        arm_b = center_a + arm_a - center_b
    else:
        arm_a = center_b + arm_b - center_a
    push(shape_a.body, arm_a, shape_b.body, arm_b, normal, movers, motions)


@kernel
def push(row_a, arm_a, row_b, arm_b, normal, movers, motions):
    """An impulse along a normal, from B to A, after which two points of two bodies no longer approach."""
    a, b = movers[row_a], movers[row_b]
    speed_a = Vec2(np.float64(a.vx), np.float64(a.vy)) + spin(np.float64(a.w), arm_a)
    speed_b = Vec2(np.float64(b.vx), np.float64(b.vy)) + spin(np.float64(b.w), arm_b)
    speed = dot(normal, speed_a - speed_b)
    turn_a, turn_b = cross(arm_a, normal), cross(arm_b, normal)
    inverse_a = np.float64(motions[row_a].inverse_mass)
    inverse_b = np.float64(motions[row_b].inverse_mass)
    inertia_a = np.float64(motions[row_a].inverse_inertia)
    inertia_b = np.float64(motions[row_b].inverse_inertia)
    inverse = inverse_a + inverse_b + inertia_a * turn_a * turn_a + inertia_b * turn_b * turn_b
    if speed < 0.0 and inverse > 0.0:
        impulse = -speed / inverse
        a.vx, a.vy = a.vx + inverse_a * impulse * normal.x, a.vy + inverse_a * impulse * normal.y
        b.vx, b.vy = b.vx - inverse_b * impulse * normal.x, b.vy - inverse_b * impulse * normal.y
        a.w, b.w = a.w + inertia_a * impulse * turn_a, b.w - inertia_b * impulse * turn_b
