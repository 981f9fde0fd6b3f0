"""When two outlines on their way begin to overlap: conservative advancement along axes that keep them apart.

Along a fixed axis a corner that turns with its body moves by a speed that is known and changes by no more than its
distance from the centre times the square of the angular velocity. So two outlines that an axis keeps apart now are kept
apart by it at least until the first root of a parabola, for the worst pair of corners; and until the circles meet in
which they turn, however fast they do. Of all axes that could matter
(the normals of faces, and the way from the nearest point to the nearest point) the one that lasts longest says how far
time may go on; what slides along a floor is kept apart by the floor's normal for the whole step. It never goes too far,
and what does not turn is found at once.

Idea: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems" (1996), conservative advancement; the axes
are those of separating axis tests. Times are fractions of the step.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from engine.continuous.outlines import AWAY, NOW_X, NOW_Y, turn_outline
from engine.jit import kernel
from engine.lanes import sqrt
from engine.vec2 import Vec2, dot

NEVER = 2.0
"""Time of an impact that does not come in this step."""

FOREVER = 1e30
"""Time for which an axis keeps outlines apart that do not approach along it."""

MOST_STEPS = 64
"""Advances after which the time reached stands for that of the impact: it is too early, never too late."""

POINT = 1e-12
"""What is shorter is a point [m], or its square [m^2]: no direction can be had from it."""


class Axis(NamedTuple):
    """A direction, from B to A, that may keep them apart."""

    normal: Vec2  # unit
    separation: Any  # of the outlines along it [m]
    lasts: Any  # for how long it is sure to keep them apart


class Task(NamedTuple):
    """What is asked of a pair of outlines."""

    radii: Any  # sum of their rounding radii [m]
    depth: Any  # separation at which they are said to meet [m]
    spare: Any  # added to it along an axis that lies along `line`: none, where that is zero [m]
    line: Vec2  # unit, of an outline that is a line
    near: Any  # by how much of the way an impact may be found too early [m]
    side: Vec2  # only axes that do not point against this; zero: all do
    reach_a: Any  # radius of the circle in which the corners of A turn [m]
    reach_b: Any


@kernel
def first_root(gap, speed, bend):
    """When gap + speed t - bend t^2 / 2 is first 0, for gap > 0 and bend >= 0."""
    root = sqrt(speed * speed + 2.0 * bend * gap)
    if speed < 0.0:
        return 2.0 * gap / (root - speed)
    return (speed + root) / bend if bend > 0.0 else FOREVER


@kernel
def least_along(outline, count, normal):
    """The least of the corners' coordinates along a normal, from their centre [m]."""
    least = outline[0, NOW_X] * normal.x + outline[0, NOW_Y] * normal.y
    for k in range(1, count):
        least = min(least, outline[k, NOW_X] * normal.x + outline[k, NOW_Y] * normal.y)
    return least


@kernel
def try_axis(best, normal, task, a, count_a, b, count_b, apart, approach, turn_a, turn_b):
    """The better of the best axis so far and a new one: of those that keep the outlines apart, the one that lasts.

    apart, approach: from the centre of B to that of A, and how it changes in a step [m]; turn_a, turn_b [rad/step].
    """
    if dot(normal, task.side) < 0.0:
        return best
    low = least_along(a, count_a, normal)
    high = -least_along(b, count_b, -normal)
    between = dot(normal, apart)
    separation = between + low - high - task.radii
    depth = task.depth + task.spare * dot(normal, task.line) ** 2
    if separation <= depth:
        return Axis(normal, separation, 0.0) if separation > best.separation and best.lasts == 0.0 else best
    rest = between - task.radii - depth
    speed = dot(normal, approach)
    in_circles = rest - (task.reach_a if turn_a != 0.0 else -low) - (task.reach_b if turn_b != 0.0 else high)
    least = max(best.lasts, first_root(in_circles, speed, 0.0) if in_circles > 0.0 else 0.0)
    lasts = FOREVER
    for k in range(count_a):
        height, drift, bend = low, 0.0, 0.0
        if turn_a != 0.0:  # otherwise the lowest one speaks for all
            height = a[k, NOW_X] * normal.x + a[k, NOW_Y] * normal.y
            drift = turn_a * (a[k, NOW_X] * normal.y - a[k, NOW_Y] * normal.x)
            bend = turn_a * turn_a * a[k, AWAY]
        for j in range(count_b):
            top, rise, curve = high, 0.0, 0.0
            if turn_b != 0.0:
                top = b[j, NOW_X] * normal.x + b[j, NOW_Y] * normal.y
                rise = turn_b * (b[j, NOW_X] * normal.y - b[j, NOW_Y] * normal.x)
                curve = turn_b * turn_b * b[j, AWAY]
            lasts = min(lasts, first_root(rest + height - top, speed + drift - rise, bend + curve))
            if turn_b == 0.0:
                break
        if turn_a == 0.0 or lasts <= least:
            break
    lasts = max(lasts, least)
    return Axis(normal, separation, lasts) if lasts > best.lasts else best


@kernel
def face_normal(outline, count, k):
    """The outward normal of the edge from corner k to the next, and whether there is one."""
    after = k + 1 if k + 1 < count else 0
    x, y = outline[after, NOW_X] - outline[k, NOW_X], outline[after, NOW_Y] - outline[k, NOW_Y]
    length = sqrt(x * x + y * y)
    if length < POINT:
        return Vec2(0.0, 0.0), False
    return Vec2(y / length, -x / length), True


@kernel
def nearest_on(point, outline, count, center):
    """From the nearest point of an outline's edges to a point [m]."""
    best = Vec2(FOREVER, 0.0)
    for k in range(count):
        after = k + 1 if k + 1 < count else 0
        start = center + Vec2(outline[k, NOW_X], outline[k, NOW_Y])
        edge = Vec2(outline[after, NOW_X] - outline[k, NOW_X], outline[after, NOW_Y] - outline[k, NOW_Y])
        away = point - start
        squared = dot(edge, edge)
        t = min(1.0, max(0.0, dot(away, edge) / squared)) if squared > POINT * POINT else 0.0
        away = away - edge * t
        if dot(away, away) < dot(best, best):
            best = away
        if count <= 2:
            break
    return best


@kernel
def between_nearest(a, count_a, b, count_b, apart):
    """From the nearest point of the edges of B to that of A [m]."""
    origin = Vec2(0.0, 0.0)
    best = Vec2(FOREVER, 0.0)
    for k in range(count_a):
        away = nearest_on(apart + Vec2(a[k, NOW_X], a[k, NOW_Y]), b, count_b, origin)
        if dot(away, away) < dot(best, best):
            best = away
    for j in range(count_b):
        away = -nearest_on(Vec2(b[j, NOW_X], b[j, NOW_Y]), a, count_a, apart)
        if dot(away, away) < dot(best, best):
            best = away
    return best


@kernel
def best_axis(task, a, count_a, b, count_b, apart, approach, turn_a, turn_b):
    """The axis that keeps two outlines apart for longest; if none does now, the one along which they overlap least."""
    best = Axis(Vec2(0.0, 0.0), -FOREVER, 0.0)
    if count_b > 1:
        for j in range(count_b):
            normal, there = face_normal(b, count_b, j)
            if there:
                best = try_axis(best, normal, task, a, count_a, b, count_b, apart, approach, turn_a, turn_b)
    if count_a > 1:
        for k in range(count_a):
            normal, there = face_normal(a, count_a, k)
            if there:
                best = try_axis(best, -normal, task, a, count_a, b, count_b, apart, approach, turn_a, turn_b)
    if task.radii > 0.0 or count_a == 1 or count_b == 1:
        away = between_nearest(a, count_a, b, count_b, apart)
        distance = sqrt(dot(away, away))
        if distance > POINT:
            normal = Vec2(away.x / distance, away.y / distance)
            best = try_axis(best, normal, task, a, count_a, b, count_b, apart, approach, turn_a, turn_b)
    return best


@kernel
def separation_at(time, radii, side, a, count_a, sweep_a, b, count_b, sweep_b):
    """The axis along which two outlines are furthest apart, or overlap least, at a time; side: as in Task."""
    apart = turn_outline(a, count_a, sweep_a, time) - turn_outline(b, count_b, sweep_b, time)
    nothing = Vec2(0.0, 0.0)
    task = Task(radii, FOREVER, 0.0, nothing, 0.0, side, 0.0, 0.0)  # no axis does, so it is the least overlap
    return best_axis(task, a, count_a, b, count_b, apart, nothing, 0.0, 0.0)


@kernel
def impact_time(task, a, count_a, sweep_a, b, count_b, sweep_b, end):
    """When two outlines first come as near as `task.depth`, before `end`; NEVER if they do not. Never too late."""
    swift = abs(sweep_a.way.x) + abs(sweep_a.way.y) + abs(sweep_b.way.x) + abs(sweep_b.way.y)
    swift += abs(sweep_a.turn) * task.reach_a + abs(sweep_b.turn) * task.reach_b
    time = 0.0
    nothing = Vec2(0.0, 0.0)
    for _ in range(MOST_STEPS):
        apart = turn_outline(a, count_a, sweep_a, time) - turn_outline(b, count_b, sweep_b, time)
        goes_a, goes_b = time < sweep_a.until, time < sweep_b.until
        approach = (sweep_a.way if goes_a else nothing) - (sweep_b.way if goes_b else nothing)
        turn_a, turn_b = sweep_a.turn if goes_a else 0.0, sweep_b.turn if goes_b else 0.0
        best = best_axis(task, a, count_a, b, count_b, apart, approach, turn_a, turn_b)
        last = end
        if goes_a:
            last = min(last, sweep_a.until)
        if goes_b:
            last = min(last, sweep_b.until)
        if time + best.lasts >= last:
            if last >= end:
                return NEVER
            time = last
        elif best.lasts * swift <= task.near:
            return time
        else:
            time += best.lasts
    return time
