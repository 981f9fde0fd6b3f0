"""From arbiters to their contacts: for each kind of pair a loop that reads the tables and writes what it finds.

The geometry of two shapes stands in the other files of this folder and knows no tables.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from engine.atomics import count_up
from engine.jit import kernel
from engine.lanes import const, eight_of, select
from engine.narrow_phase import box_box as boxes
from engine.narrow_phase import capsules, chain_circle, chain_hull, circles, hull_circle, hull_hull, hulls
from engine.narrow_phase.manifold import places_of, write_manifold
from engine.narrow_phase.manifold_points import mirrored, mirrored_where
from engine.rows import at
from engine.shapes.box import BOX
from engine.shapes.polygon import POLYGON
from engine.simd import WIDTH
from engine.tables import HULL_POINTS
from engine.threads import DONE, take_part, wait_for_all
from engine.vec2 import Vec2, choose


class Two(NamedTuple):
    """The two shapes of an arbiter, the one of the lower kind first; or of eight arbiters."""

    flip: Any  # whether it is the arbiter's second
    row1: Any
    row2: Any
    center1: Vec2  # lanes [m]
    center2: Vec2
    q1: Vec2
    q2: Vec2


@kernel
def two_of(arbiter, shapes, placements, places):
    """The shapes of an arbiter in the order that the geometry wants."""
    row1 = arbiter.shape1
    row2 = arbiter.shape2
    place1 = at(placements, row1)
    place2 = at(placements, row2)
    q1 = Vec2(place1.cosine, place1.sine)
    q2 = Vec2(place2.cosine, place2.sine)
    flip = at(shapes, row1).kind > at(shapes, row2).kind
    return Two(
        flip,
        select(flip, row2, row1),
        select(flip, row1, row2),
        choose(flip, places.shape2, places.shape1),
        choose(flip, places.shape1, places.shape2),
        choose(flip, q2, q1),
        choose(flip, q1, q2),
    )


@kernel
def half_of(shape, lane):
    """Half the sides of a box."""
    return Vec2(const(shape.half_x, lane), const(shape.half_y, lane))


# --- eight pairs at a time: `chosen` is filled up to a multiple of eight -------------------------------------------


@kernel
def box_box(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """Two boxes; see narrow_phase/__init__.py."""
    step = steps[0]
    for k in range(first, last, WIDTH):
        index = eight_of(chosen, k)
        arbiter = at(arbiters, index)
        row1, row2 = arbiter.shape1, arbiter.shape2
        place1, place2 = at(placements, row1), at(placements, row2)
        q1, q2 = Vec2(place1.cosine, place1.sine), Vec2(place2.cosine, place2.sine)
        lane = q1.x
        places = places_of(arbiter, placements, bodies, lane)
        half1, half2 = half_of(at(shapes, row1), lane), half_of(at(shapes, row2), lane)
        found = boxes.collide_boxes(half1, places.shape1, q1, half2, places.shape2, q2, step.margin)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def boxes_together(leads, board, firsts, chosen, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """The same by several threads: part p from firsts[p] to before firsts[p + 1]."""
    part = take_part(board, len(firsts) - 1)
    while part >= 0:
        box_box(
            chosen, firsts[part], firsts[part + 1], arbiters, contacts, shapes, hulls, placements, bodies, motions,
            steps,
        )  # fmt: skip
        count_up(board, DONE)
        part = take_part(board, len(firsts) - 1)
    if leads:
        wait_for_all(board, len(firsts) - 1)


@kernel
def box_circle(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """A box and a circle."""
    step = steps[0]
    for k in range(first, last, WIDTH):
        index = eight_of(chosen, k)
        arbiter = at(arbiters, index)
        lane = at(placements, arbiter.shape1).cosine
        places = places_of(arbiter, placements, bodies, lane)
        two = two_of(arbiter, shapes, placements, places)
        half = half_of(at(shapes, two.row1), lane)
        radius = const(at(shapes, two.row2).radius, lane)
        found = circles.collide_box_circle(half, two.center1, two.q1, radius, two.center2, step.margin)
        found = mirrored_where(two.flip, found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def circle_circle(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """Two circles."""
    step = steps[0]
    for k in range(first, last, WIDTH):
        index = eight_of(chosen, k)
        arbiter = at(arbiters, index)
        lane = at(placements, arbiter.shape1).cosine
        places = places_of(arbiter, placements, bodies, lane)
        radius1 = const(at(shapes, arbiter.shape1).radius, lane)
        radius2 = const(at(shapes, arbiter.shape2).radius, lane)
        found = circles.collide_circles(radius1, places.shape1, radius2, places.shape2, step.margin)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def circles_together(
    leads, board, firsts, chosen, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps
):
    """The same by several threads: part p from firsts[p] to before firsts[p + 1]."""
    part = take_part(board, len(firsts) - 1)
    while part >= 0:
        circle_circle(
            chosen, firsts[part], firsts[part + 1], arbiters, contacts, shapes, hulls, placements, bodies, motions,
            steps,
        )  # fmt: skip
        count_up(board, DONE)
        part = take_part(board, len(firsts) - 1)
    if leads:
        wait_for_all(board, len(firsts) - 1)


@kernel
def circle_core(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """A circle and a capsule or segment."""
    step = steps[0]
    for k in range(first, last, WIDTH):
        index = eight_of(chosen, k)
        arbiter = at(arbiters, index)
        lane = at(placements, arbiter.shape1).cosine
        places = places_of(arbiter, placements, bodies, lane)
        two = two_of(arbiter, shapes, placements, places)
        radius = const(at(shapes, two.row1).radius, lane)
        core = at(shapes, two.row2)
        found = circles.collide_capsule_circle(
            const(core.half_x, lane), const(core.radius, lane), two.center2, two.q2, radius, two.center1, step.margin
        )  # fmt: skip
        found = mirrored_where(~two.flip, found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def core_core(chosen, first, last, arbiters, contacts, shapes, hulls, placements, bodies, motions, steps):
    """Two capsules, or a capsule and a segment."""
    step = steps[0]
    for k in range(first, last, WIDTH):
        index = eight_of(chosen, k)
        arbiter = at(arbiters, index)
        lane = at(placements, arbiter.shape1).cosine
        places = places_of(arbiter, placements, bodies, lane)
        two = two_of(arbiter, shapes, placements, places)
        shape1, shape2 = at(shapes, two.row1), at(shapes, two.row2)
        half1, radius1 = const(shape1.half_x, lane), const(shape1.radius, lane)
        half2, radius2 = const(shape2.half_x, lane), const(shape2.radius, lane)
        found = capsules.collide_capsules(
            half1, radius1, two.center1, two.q1, half2, radius2, two.center2, two.q2, step.margin
        )  # fmt: skip
        found = mirrored_where(two.flip, found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


# --- one pair at a time: their geometry decides with `if` ------------------------------------------------------------


@kernel
def circle_polygon(chosen, first, last, arbiters, contacts, shapes, hull_table, placements, bodies, motions, steps):
    """A circle and a polygon."""
    step = steps[0]
    scratch = np.empty((HULL_POINTS, 4), placements.cosine.dtype)
    for k in range(first, last):
        index = chosen[k]
        arbiter = arbiters[index]
        places = places_of(arbiter, placements, bodies, step.margin)
        two = two_of(arbiter, shapes, placements, places)
        radius = const(shapes[two.row1].radius, step.margin)
        corners = hulls.load_hull(hull_table[shapes[two.row2].hull], scratch)
        rounding = const(shapes[two.row2].radius, step.margin)
        found = hull_circle.collide_hull_circle(
            scratch, corners, rounding, two.center2, two.q2, radius, two.center1, step.margin
        )  # fmt: skip
        if not two.flip:
            found = mirrored(found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def load_any(shape, hull_table, scratch, lane):
    """The corners of a box, polygon, capsule or segment. Returns how many there are."""
    if shape.kind == BOX:
        return hulls.load_box(half_of(shape, lane), scratch)
    if shape.kind == POLYGON:
        return hulls.load_hull(hull_table[shape.hull], scratch)
    return hulls.load_capsule(const(shape.half_x, lane), scratch)


@kernel
def hull_and_hull(chosen, first, last, arbiters, contacts, shapes, hull_table, placements, bodies, motions, steps):
    """Any two of box, polygon, capsule and segment that have no loop of their own."""
    step = steps[0]
    scratch1 = np.empty((HULL_POINTS, 4), placements.cosine.dtype)
    scratch2 = np.empty((HULL_POINTS, 4), placements.cosine.dtype)
    for k in range(first, last):
        index = chosen[k]
        arbiter = arbiters[index]
        places = places_of(arbiter, placements, bodies, step.margin)
        two = two_of(arbiter, shapes, placements, places)
        shape1 = shapes[two.row1]
        shape2 = shapes[two.row2]
        count1 = load_any(shape1, hull_table, scratch1, step.margin)
        count2 = load_any(shape2, hull_table, scratch2, step.margin)
        radius1 = const(shape1.radius, step.margin)
        radius2 = const(shape2.radius, step.margin)
        found = hull_hull.collide_hulls(
            scratch1, count1, radius1, two.center1, two.q1, scratch2, count2, radius2, two.center2, two.q2, step.margin
        )  # fmt: skip
        if two.flip:
            found = mirrored(found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def ghosts_of(piece, lane):
    """The far ends of a chain piece's neighbours, in its own frame."""
    ghost1 = Vec2(const(piece.ghost1_x, lane), const(piece.ghost1_y, lane))
    ghost2 = Vec2(const(piece.ghost2_x, lane), const(piece.ghost2_y, lane))
    return ghost1, ghost2


@kernel
def circle_chain(chosen, first, last, arbiters, contacts, shapes, hull_table, placements, bodies, motions, steps):
    """A circle and a piece of a chain."""
    step = steps[0]
    for k in range(first, last):
        index = chosen[k]
        arbiter = arbiters[index]
        places = places_of(arbiter, placements, bodies, step.margin)
        two = two_of(arbiter, shapes, placements, places)
        piece = shapes[two.row2]
        ghost1, ghost2 = ghosts_of(piece, step.margin)
        half_x = const(piece.half_x, step.margin)
        radius = const(shapes[two.row1].radius, step.margin)
        found = chain_circle.collide_chain_circle(
            half_x, ghost1, ghost2, two.center2, two.q2, radius, two.center1, step.margin
        )  # fmt: skip
        if not two.flip:
            found = mirrored(found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)


@kernel
def hull_chain(chosen, first, last, arbiters, contacts, shapes, hull_table, placements, bodies, motions, steps):
    """A box, polygon or capsule and a piece of a chain."""
    step = steps[0]
    scratch = np.empty((HULL_POINTS, 4), placements.cosine.dtype)
    for k in range(first, last):
        index = chosen[k]
        arbiter = arbiters[index]
        places = places_of(arbiter, placements, bodies, step.margin)
        two = two_of(arbiter, shapes, placements, places)
        shape = shapes[two.row1]
        piece = shapes[two.row2]
        ghost1, ghost2 = ghosts_of(piece, step.margin)
        half_x = const(piece.half_x, step.margin)
        corners = load_any(shape, hull_table, scratch, step.margin)
        radius = const(shape.radius, step.margin)
        found = chain_hull.collide_chain_hull(
            half_x, ghost1, ghost2, two.center2, two.q2, scratch, corners, radius, two.center1, two.q1, step.margin
        )  # fmt: skip
        if not two.flip:
            found = mirrored(found)
        write_manifold(index, arbiters, contacts, places, found, motions, step.warm_starting != 0)
