"""Shapes as polygons, which can be clipped: rounded ones as many-sided polygons of exactly their area.

A rounded corner becomes eight sides, the end of a capsule or half a circle sixteen. Their corners lie a little outside
the arc, and their middles inside, as far as it takes for the whole to have the area of the shape; and a polygon is then
moved, by thousandths of its rounding, so that its centroid is that of the shape. What is all under water is so lifted
exactly, and exactly where it weighs. Made once, when content changes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.effects.cores import write_core
from engine.jit import kernel
from engine.shapes.box import BOX
from engine.shapes.polygon import POLYGON
from engine.tables import HULL_POINTS, empty

if TYPE_CHECKING:
    from engine.state import State

CORNER_SIDES = 8  # of a polygon's rounded corner
END_SIDES = 16  # of half a turn: a circle has two
MOST_POINTS = HULL_POINTS * (CORNER_SIDES + 1)
OPPOSITE = 1e-6  # two unit vectors whose sum is shorter are half a turn apart

WHOLE = np.dtype(
    [
        ("area", np.float64),  # [m^2]
        ("moment_x", np.float64),  # first moment of area about the origin of the shape's own frame [m^3]
        ("moment_y", np.float64),
        ("reach", np.float64),  # farthest point from there [m]
    ]
)


class Outlines(NamedTuple):
    """The outlines of the pieces that have an area, on bodies that move by forces."""

    rows: np.ndarray  # (R,) of the pieces, in the order of creation
    starts: np.ndarray  # (R + 1,) where each one's points begin
    points: np.ndarray  # (P, 2) counter-clockwise, in the piece's own frame [m]
    wholes: np.ndarray  # (R,) WHOLE


def outlines_of(state: State) -> Outlines:
    """Outlines of everything that can float."""
    shapes, hulls = state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    inverse_mass = state.bodies.tables["motions"]["inverse_mass"]
    order = state.shapes.order
    rows = order[(shapes["kind"][order] <= POLYGON) & (inverse_mass[shapes["body"][order]] > 0.0)]
    kinds = shapes["kind"][rows]
    corners = np.where(kinds == POLYGON, hulls["count"][np.where(kinds == POLYGON, shapes["hull"][rows], 0)], 4)
    rounded = np.where(kinds == POLYGON, corners * (CORNER_SIDES + 1), 2 * (END_SIDES + 1))
    counts = np.where((kinds == BOX) | (shapes["radius"][rows] == 0.0), corners, rounded)
    starts = np.concatenate([[0], np.cumsum(counts)])
    found = Outlines(rows, starts, np.empty((int(starts[-1]), 2)), empty(len(rows), WHOLE))
    write_outlines(rows, shapes, hulls, found.starts, found.points, found.wholes)
    return found


@kernel
def write_outlines(rows, shapes, hulls, starts, points, wholes):
    """Writes the outlines of these pieces."""
    corners = np.empty((HULL_POINTS, 2))
    directions = np.empty((MOST_POINTS, 2))
    for k in range(len(rows)):
        shape = shapes[rows[k]]
        count = write_core(shape, hulls, corners)
        outline = points[starts[k] : starts[k + 1]]
        if shape.radius > 0.0:
            round_off(corners, count, shape.radius, directions, outline)
            if count > 2:
                center(corners, count, shape.radius, directions, outline)
        else:
            for i in range(count):  # element by element: copying slices takes seconds to compile
                outline[i, 0] = corners[i, 0]
                outline[i, 1] = corners[i, 1]
        whole = wholes[k]
        whole.area, whole.moment_x, whole.moment_y = moments(outline, len(outline))
        whole.reach = 0.0
        for i in range(len(outline)):
            whole.reach = max(whole.reach, np.sqrt(outline[i, 0] * outline[i, 0] + outline[i, 1] * outline[i, 1]))


@kernel
def moments(points, count):
    """(area, first moments of area about the origin) of the polygon of the first `count` points, counter-clockwise."""
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    for k in range(count):
        after = k + 1 if k + 1 < count else 0
        twice = points[k, 0] * points[after, 1] - points[k, 1] * points[after, 0]
        area += 0.5 * twice
        moment_x += twice * (points[k, 0] + points[after, 0]) / 6.0
        moment_y += twice * (points[k, 1] + points[after, 1]) / 6.0
    return area, moment_x, moment_y


@kernel
def round_off(corners, count, radius, directions, outline):
    """Writes the outline of all that is within `radius` of a convex polygon, a line (count 2) or a point (count 1).

    Arcs of a circle of radius R about the corners, in straight sides: with the perimeter P of the corners and the sum s
    of the sides' triangles at radius 1, they add P R + s R^2 to the area. R is such that this is P r + pi r^2.
    """
    arcs = max(count, 2)
    sides = CORNER_SIDES if count > 2 else END_SIDES
    perimeter = 0.0
    unit_area = 0.0
    for i in range(arcs):
        before_x, before_y, _ = edge_normal(corners, count, i - 1 if i > 0 else arcs - 1)
        after_x, after_y, length = edge_normal(corners, count, i)
        perimeter += length
        fan = directions[i * (sides + 1) : (i + 1) * (sides + 1)]
        fan[0, 0], fan[0, 1] = before_x, before_y
        fan[sides, 0], fan[sides, 1] = after_x, after_y
        fill_fan(fan, sides)
        for k in range(sides):
            unit_area += 0.5 * (fan[k, 0] * fan[k + 1, 1] - fan[k, 1] * fan[k + 1, 0])
    wanted = perimeter * radius + np.pi * radius * radius
    reach = 2.0 * wanted / (perimeter + np.sqrt(perimeter * perimeter + 4.0 * unit_area * wanted))
    for i in range(arcs):
        corner = corners[i if i < count else 0]
        for k in range(i * (sides + 1), (i + 1) * (sides + 1)):
            outline[k, 0] = corner[0] + reach * directions[k, 0]
            outline[k, 1] = corner[1] + reach * directions[k, 1]


@kernel
def center(corners, count, radius, directions, outline):
    """Moves the outline of a rounded polygon to where its centroid is that of the shape.

    That is made of the polygon of the corners, a rectangle to each edge, and a sector to each corner: of area
    r^2 phi / 2 and, about its tip, of moment (2/3) r^3 sin(phi / 2), of which the sine is half the way between the
    normals at its sides, turned.
    """
    area, moment_x, moment_y = moments(corners, count)
    for i in range(count):
        x, y, length = edge_normal(corners, count, i)
        after = i + 1 if i + 1 < count else 0
        edge_area = length * radius
        area += edge_area
        moment_x += edge_area * (0.5 * (corners[i, 0] + corners[after, 0]) + 0.5 * radius * x)
        moment_y += edge_area * (0.5 * (corners[i, 1] + corners[after, 1]) + 0.5 * radius * y)
        fan = directions[i * (CORNER_SIDES + 1) : (i + 1) * (CORNER_SIDES + 1)]
        side = arc_sine(fan[0, 0] * fan[1, 1] - fan[0, 1] * fan[1, 0])
        sector_area = 0.5 * radius * radius * CORNER_SIDES * side
        cube = radius * radius * radius / 3.0
        area += sector_area
        moment_x += sector_area * corners[i, 0] + cube * (fan[CORNER_SIDES, 1] - fan[0, 1])
        moment_y += sector_area * corners[i, 1] - cube * (fan[CORNER_SIDES, 0] - fan[0, 0])
    outline_area, outline_x, outline_y = moments(outline, len(outline))
    shift_x = moment_x / area - outline_x / outline_area
    shift_y = moment_y / area - outline_y / outline_area
    for k in range(len(outline)):
        outline[k, 0] += shift_x
        outline[k, 1] += shift_y


@kernel
def arc_sine(x):
    """The angle in [0, pi/8] whose sine is x, by its power series: the same bits on every machine [rad]."""
    square = x * x
    total = x
    term = x
    for k in range(1, 16):  # the last one adds less than 1e-15
        term *= square * (2.0 * k - 1.0) / (2.0 * k)
        total += term / (2.0 * k + 1.0)
    return total


@kernel
def edge_normal(corners, count, i):
    """Unit outward normal and length of the edge from corner i to the next; a point has one to each side."""
    if count == 1:
        return 0.0, 2.0 * i - 1.0, 0.0
    after = i + 1 if i + 1 < count else 0
    x = corners[after, 0] - corners[i, 0]
    y = corners[after, 1] - corners[i, 1]
    length = np.sqrt(x * x + y * y)
    return y / length, -x / length, length


@kernel
def fill_fan(fan, sides):
    """Halves the turn from the first direction to the last again and again: sides is a power of two."""
    step = sides
    while step > 1:
        half = step // 2
        for k in range(half, sides, step):
            x = fan[k - half, 0] + fan[k + half, 0]
            y = fan[k - half, 1] + fan[k + half, 1]
            length = np.sqrt(x * x + y * y)
            if length < OPPOSITE:
                x, y, length = -fan[k - half, 1], fan[k - half, 0], 1.0
            fan[k, 0] = x / length
            fan[k, 1] = y / length
        step = half
