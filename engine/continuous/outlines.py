"""The outline of a shape as its body carries it through a step: the corners of its core, and a radius about them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.effects.cores import write_core
from engine.jit import kernel
from engine.lanes import sqrt
from engine.shapes.box import BOX
from engine.shapes.polygon import POLYGON
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2, rotate

X, Y, AWAY, NOW_X, NOW_Y = range(5)
"""What a row of an outline's scratch (8, 5) holds: a corner in the frame of its body, from the centre of mass; how far
it is from there; and where it is from there as the body has turned at the moment looked at [m]."""

CORNERS = 8


class Sweep(NamedTuple):
    """How a body goes through a step: evenly, until it stops. Times are fractions of the step."""

    center: Vec2  # where its centre of mass begins [m]
    way: Vec2  # in the whole step [m]
    angle: Any  # at which it begins [rad]
    turn: Any  # in the whole step [rad]
    until: Any  # from when on it stands still


@kernel
def sweep_of(body, mover, until):
    """From a body as it began the step and what the substeps made of it."""
    return Sweep(
        Vec2(body.center_x, body.center_y),
        Vec2(np.float64(mover.dx), np.float64(mover.dy)),
        body.angle,
        np.float64(mover.turned),
        until,
    )


@kernel
def load_outline(shape, hulls, body, corners, outline):
    """Writes the corners of a shape; corners (8, 2) is scratch. Returns how many."""
    count = write_core(shape, hulls, corners)
    q = Vec2(shape.local_cosine, shape.local_sine)
    for k in range(count):
        p = Vec2(shape.local_x - body.local_x, shape.local_y - body.local_y) + rotate(
            q, Vec2(corners[k, 0], corners[k, 1])
        )
        outline[k, X], outline[k, Y] = p.x, p.y
        outline[k, AWAY] = sqrt(p.x * p.x + p.y * p.y)
    return count


@kernel
def turn_outline(outline, count, sweep, time):
    """Turns the corners to where they are at that time; returns the centre [m]."""
    time = min(time, sweep.until)
    c, s = cos_sin(sweep.angle + sweep.turn * time)
    q = Vec2(c, s)
    for k in range(count):
        r = rotate(q, Vec2(outline[k, X], outline[k, Y]))
        outline[k, NOW_X], outline[k, NOW_Y] = r.x, r.y
    return sweep.center + sweep.way * time


@kernel
def reach_of(outline, count):
    """How far the furthest corner is from the centre of mass [m]."""
    reach = outline[0, AWAY]
    for k in range(1, count):
        reach = max(reach, outline[k, AWAY])
    return reach


@kernel
def half_width(shape, hulls):
    """Half of how thin a shape is at its thinnest [m]: of a polygon, from the mean of its corners; 0 of a line."""
    if shape.kind == BOX:
        return min(shape.half_x, shape.half_y)
    if shape.kind != POLYGON:
        return shape.radius
    hull = hulls[shape.hull]
    x, y = hull.x[0], hull.y[0]
    for k in range(1, hull.count):
        x += hull.x[k]
        y += hull.y[k]
    x, y = x / hull.count, y / hull.count
    least = (hull.x[0] - x) * hull.nx[0] + (hull.y[0] - y) * hull.ny[0]
    for k in range(1, hull.count):
        least = min(least, (hull.x[k] - x) * hull.nx[k] + (hull.y[k] - y) * hull.ny[k])
    return least + shape.radius
