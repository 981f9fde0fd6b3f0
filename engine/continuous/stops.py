"""Who stops when: fast bodies at the first thing that they would go through, bullets also at what moves by itself.

Times are fractions of the step; `until` holds, by row, when each body stops: 1 for those that go on.
"""

from __future__ import annotations

import numpy as np

from engine.continuous.meeting import find_stop
from engine.continuous.outlines import sweep_of
from engine.continuous.parting import part
from engine.effects.filters import may_meet
from engine.jit import kernel
from engine.pairs import is_listed, may_touch
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2, rotate

BLOCK = 16  # static shapes that are looked at together first: those created one after another mostly lie together
DONE = 3.0  # time of an encounter at which both have stopped

ENCOUNTER = np.dtype(
    [
        ("shape1", np.int64),  # rows of two shapes that may meet on their ways
        ("shape2", np.int64),
        ("sunk", np.int64),  # 1: they overlap already
        ("time", np.float64),  # when one must stop, as long as neither has stopped before; 2: never, 3: they have
    ]
)


@kernel
def write_path(body, mover, reach, path):
    """The box (4,) around all places that a shape comes to: lower x and y, upper x and y [m]."""
    x, y = body.center_x, body.center_y
    end_x, end_y = x + np.float64(mover.dx), y + np.float64(mover.dy)
    path[0], path[1] = min(x, end_x) - reach, min(y, end_y) - reach
    path[2], path[3] = max(x, end_x) + reach, max(y, end_y) + reach


@kernel
def may_collide(row1, row2, shapes, bodies, colliders, joined, category, mask, group):
    """Whether two shapes collide at all, as for the pairs of the broad phase.

    joined, category, mask, group: of length 0 where not called for; None would mean to compile all of this once more.
    """
    shape1, shape2 = shapes[row1], shapes[row2]
    if not may_touch(shape1, shape2, colliders):
        return False
    if len(joined) > 0:
        serial1, serial2 = bodies[shape1.body].serial, bodies[shape2.body].serial
        if is_listed(joined, min(serial1, serial2), max(serial1, serial2)):
            return False
    if len(category) > 0:
        return may_meet(category[row1], mask[row1], group[row1], category[row2], mask[row2], group[row2])
    return True


@kernel
def stop_of(row1, row2, shapes, hulls, bodies, movers, until, scratch, end):
    """When one of two shapes must stop, before `end`."""
    shape1, shape2 = shapes[row1], shapes[row2]
    body1, body2 = bodies[shape1.body], bodies[shape2.body]
    sweep1 = sweep_of(body1, movers[shape1.body], until[shape1.body])
    sweep2 = sweep_of(body2, movers[shape2.body], until[shape2.body])
    return find_stop(shape1, body1, sweep1, shape2, body2, sweep2, hulls, scratch, end)


@kernel
def note(sunk, row, stop, own, other):
    """Remembers which shapes keep a body, where contacts did not; sunk (B, 2): rows of shapes, -1 for none."""
    sunk[row, 0], sunk[row, 1] = (own, other) if stop.sunk else (-1, -1)


@kernel
def is_in_way(bounds, rank, path):
    """Whether the box of that rank, of `bounds` (4, S), overlaps a path."""
    in_x = bounds[0, rank] <= path[2] and bounds[2, rank] >= path[0]
    return in_x and bounds[1, rank] <= path[3] and bounds[3, rank] >= path[1]


@kernel
def overlap(a, b):
    """Whether two boxes (4,) do."""
    return a[0] <= b[2] and a[2] >= b[0] and a[1] <= b[3] and a[3] >= b[1]


@kernel
def boxes_of_blocks(ranks, bounds):
    """(N, 4) the boxes around so many shapes each, one after the other of `ranks`."""
    boxes = np.empty(((len(ranks) + BLOCK - 1) // BLOCK, 4))
    for place in range(len(ranks)):
        box, rank = boxes[place // BLOCK], ranks[place]
        first = place % BLOCK == 0
        for side in range(2):
            low, high = np.float64(bounds[side, rank]), np.float64(bounds[side + 2, rank])
            box[side] = low if first else min(box[side], low)
            box[side + 2] = high if first else max(box[side + 2], high)
    return boxes


@kernel
def stop_at_fixed(
    fast, slowest, first_shapes, shape_rows, reaches, ranks, order, bounds, shapes, hulls, bodies, movers, colliders,
    joined, category, mask, group, until, sunk, scratch,
):  # fmt: skip
    """Stops fast bodies at shapes that do not move: ranks, of which `bounds` (4, S) has the boxes."""
    path, own_path = np.empty(4), np.empty(4)
    boxes = boxes_of_blocks(ranks, bounds)
    for row in fast:
        write_path(bodies[row], movers[row], slowest[row].extent, path)
        for block in range(len(boxes)):
            if not overlap(path, boxes[block]):
                continue
            for place in range(BLOCK * block, min(BLOCK * block + BLOCK, len(ranks))):
                rank = ranks[place]
                if is_in_way(bounds, rank, path):
                    for k in range(first_shapes[row], first_shapes[row + 1]):
                        own, other = shape_rows[k], order[rank]
                        write_path(bodies[row], movers[row], reaches[own], own_path)
                        if is_in_way(bounds, rank, own_path) and may_collide(
                            own, other, shapes, bodies, colliders, joined, category, mask, group
                        ):  # fmt: skip
                            stop = stop_of(own, other, shapes, hulls, bodies, movers, until, scratch, until[row])
                            if stop.time < until[row]:
                                until[row] = stop.time
                                note(sunk, row, stop, own, other)


@kernel
def write_paths(ranks, order, bounds, reaches, shapes, movers, paths):
    """The boxes (M, 4) around all places that shapes, given by rank, come to, from those where they began."""
    for k in range(len(ranks)):
        row = order[ranks[k]]
        mover = movers[shapes[row].body]
        further = abs(np.float64(mover.turned)) * reaches[row]
        x, y = np.float64(mover.dx), np.float64(mover.dy)
        paths[k, 0] = bounds[0, ranks[k]] + min(x, 0.0) - further
        paths[k, 1] = bounds[1, ranks[k]] + min(y, 0.0) - further
        paths[k, 2] = bounds[2, ranks[k]] + max(x, 0.0) + further
        paths[k, 3] = bounds[3, ranks[k]] + max(y, 0.0) + further


@kernel
def stop_at_kinematic(
    fast, first_shapes, shape_rows, reaches, kinematic, order, bounds, paths, shapes, hulls, bodies, movers, colliders,
    joined, category, mask, group, until, sunk, carriers, scratch,
):  # fmt: skip
    """Stops fast bodies at kinematic ones, whose shapes' ranks are given, and notes by which they are carried on.

    bounds (4, S): boxes as the step began; paths (M, 4): scratch.
    """
    path = np.empty(4)
    write_paths(kinematic, order, bounds, reaches, shapes, movers, paths)
    for row in fast:
        for k in range(first_shapes[row], first_shapes[row + 1]):
            own = shape_rows[k]
            write_path(bodies[row], movers[row], reaches[own], path)
            for m in range(len(kinematic)):
                if overlap(path, paths[m]):
                    other = order[kinematic[m]]
                    carrier = shapes[other].body
                    if may_collide(own, other, shapes, bodies, colliders, joined, category, mask, group):
                        stop = stop_of(own, other, shapes, hulls, bodies, movers, until, scratch, until[row])
                        if stop.time < until[row]:
                            until[row] = stop.time
                            carriers[row] = carrier
                            note(sunk, row, stop, own, other)


@kernel
def find_encounters(
    fast, hurry, first_shapes, shape_rows, reaches, dynamic, paths, bullet, shapes, bodies, movers, colliders, joined,
    category, mask, group, encounters,
):  # fmt: skip
    """Writes the pairs of dynamic shapes, one of a bullet and one of a fast body, whose paths overlap.

    hurry (B,): whether the body in that row is fast; dynamic (M,): rows of all dynamic shapes; paths (M, 4): scratch.
    Returns how many there are; those beyond the room in `encounters` are only counted.
    """
    for m in range(len(dynamic)):
        body = shapes[dynamic[m]].body
        write_path(bodies[body], movers[body], reaches[dynamic[m]], paths[m])
    path = np.empty(4)
    found = 0 * len(dynamic)
    for row in fast:
        for k in range(first_shapes[row], first_shapes[row + 1]):
            own = shape_rows[k]
            write_path(bodies[row], movers[row], reaches[own], path)
            for m in range(len(dynamic)):
                other = shapes[dynamic[m]].body
                if overlap(path, paths[m]) and (bullet[row] or bullet[other]):
                    twice = hurry[other] and bodies[other].serial < bodies[row].serial  # it has found the pair itself
                    if not twice and may_collide(
                        own, dynamic[m], shapes, bodies, colliders, joined, category, mask, group
                    ):  # fmt: skip
                        if found < len(encounters):
                            encounters[found].shape1, encounters[found].shape2 = own, dynamic[m]
                        found += 1
    return found


@kernel
def write_stop(pair, shapes, hulls, bodies, movers, until, scratch):
    """Finds when the two of an encounter must stop."""
    stop = stop_of(pair.shape1, pair.shape2, shapes, hulls, bodies, movers, until, scratch, 1.0)
    pair.time, pair.sunk = stop.time, stop.sunk


@kernel
def stop_at_each_other(encounters, shapes, hulls, bodies, movers, until, sunk, carriers, scratch):
    """Stops both bodies of every encounter, the earliest first: who has stopped is met, or missed, where it stands."""
    for k in range(len(encounters)):
        pair = encounters[k]
        write_stop(pair, shapes, hulls, bodies, movers, until, scratch)
    for _ in range(len(encounters)):
        first = 0
        for k in range(1, len(encounters)):
            if encounters[k].time < encounters[first].time:
                first = k
        pair = encounters[first]
        if pair.time >= 1.0:
            return
        body1, body2 = shapes[pair.shape1].body, shapes[pair.shape2].body
        for body in (body1, body2):
            if pair.time < until[body]:
                until[body] = pair.time
                sunk[body, 0], sunk[body, 1] = -1, -1
                carriers[body] = -1  # it does not come so far
        if pair.sunk != 0:
            sunk[body1, 0], sunk[body1, 1] = pair.shape1, pair.shape2
        pair.time = DONE
        for k in range(len(encounters)):
            other = encounters[k]
            if other.time != DONE:
                mine, theirs = shapes[other.shape1].body, shapes[other.shape2].body
                if mine in (body1, body2) or theirs in (body1, body2):
                    write_stop(other, shapes, hulls, bodies, movers, until, scratch)


@kernel
def part_sunk(rows, shapes, hulls, bodies, movers, motions, until, sunk, scratch):
    """Takes the speed of approach from bodies that stop though contacts should have held them; see parting.py."""
    for row in rows:
        if sunk[row, 0] >= 0 and until[row] < 1.0:
            shape1, shape2 = shapes[sunk[row, 0]], shapes[sunk[row, 1]]
            sweep1 = sweep_of(bodies[shape1.body], movers[shape1.body], 1.0)
            sweep2 = sweep_of(bodies[shape2.body], movers[shape2.body], 1.0)
            part(shape1, shape2, bodies, movers, motions, sweep1, sweep2, until[row], hulls, scratch)
        sunk[row, 0], sunk[row, 1] = -1, -1


@kernel
def find_contacts_anew(arbiters, count, until):
    """Lets the next step keep no contact of a body that stops: it may spin fast, and touch elsewhere at once."""
    for index in range(count):
        if until[arbiters[index].body1] < 1.0 or until[arbiters[index].body2] < 1.0:
            arbiters[index].recyclable = 0


@kernel
def hold_back(rows, bodies, movers, until, carriers):
    """Shortens the ways of bodies that stop; one that a kinematic body stopped goes along with it from then on."""
    for row in rows:
        time = until[row]
        if time < 1.0:
            mover = movers[row]
            mover.dx, mover.dy = np.float64(mover.dx) * time, np.float64(mover.dy) * time
            mover.turned = np.float64(mover.turned) * time
            if carriers[row] >= 0:
                carry(bodies[row], mover, bodies[carriers[row]], movers[carriers[row]], time)
        until[row] = 1.0


@kernel
def carry(body, mover, carrier, carrying, time):
    """Moves a body that has stopped along with a carrier, for the rest of the step."""
    way = Vec2(np.float64(carrying.dx), np.float64(carrying.dy))
    turn = np.float64(carrying.turned) * (1.0 - time)
    start = Vec2(carrier.center_x, carrier.center_y) + way * time
    here = Vec2(body.center_x + np.float64(mover.dx), body.center_y + np.float64(mover.dy))
    c, s = cos_sin(turn)
    there = start + way * (1.0 - time) + rotate(Vec2(c, s), here - start)
    mover.dx, mover.dy = there.x - body.center_x, there.y - body.center_y
    mover.turned = np.float64(mover.turned) + turn
