"""Buoyancy: a fluid in a rectangle carries what is in it (Archimedes), and holds it back.

    lift = -(density of the fluid) A g,   at the centroid of the submerged area A of each piece of a shape

Boxes and polygons are clipped exactly, rounded shapes as polygons of their area (outlines.py). The fluid is at rest and
stays where it is. What is in two fluids, or covers a place with two shapes, is lifted twice.

Drag acts at the same centroids, d = linear_drag x displaced mass each [kg/s], and on the turning of the body,
angular_drag x displaced mass x I / m: a body as dense as the fluid, all under, loses speed as with damping of that rate
[1/s]. With K the matrix of all of it and M that of mass and inertia, the force is -K u', (M + dt K) u' = M u: implicit,
so that however thick the fluid is, what moves comes to rest and is never turned round.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.effects.ahead import center_ahead, time_ahead, turn_ahead
from engine.effects.effect import Effect
from engine.effects.outlines import outlines_of
from engine.effects.submerged import CLIPPED_POINTS, Region, submerged
from engine.jit import kernel
from engine.shapes.circle import CIRCLE
from engine.tables import empty
from engine.vec2 import Vec2, rotate

if TYPE_CHECKING:
    from engine.settings import Settings
    from engine.state import State

SUMS = np.dtype(
    [
        ("force_x", np.float64),  # lift [N]
        ("force_y", np.float64),
        ("torque", np.float64),  # about the centre of mass [N m]
        ("drag", np.float64),  # sum of d [kg/s]
        ("drag_x", np.float64),  # of d times the way from the centre of mass [kg m/s]
        ("drag_y", np.float64),
        ("drag_turn", np.float64),  # of d times that way squared, and what turning adds [kg m^2/s]
        ("used", np.int64),  # 1: any of the above was written
    ]
)
"""What the fluids do to a body: of all its pieces together."""


@kernel
def add_pieces(
    fluids, order, rows, starts, points, wholes, shapes, placements, bodies, motions, sums, steps
):  # fmt: skip
    """Sums up by body what each piece gets, piece after piece and fluid after fluid in the order of creation."""
    work = np.empty((2, CLIPPED_POINTS, 2))
    time = time_ahead(steps[0])
    gravity = Vec2(np.float64(steps[0].gravity_x), np.float64(steps[0].gravity_y))
    for k in range(len(rows)):
        shape = shapes[rows[k]]
        place = placements[rows[k]]
        body = bodies[shape.body]
        motion = motions[shape.body]
        turn = turn_ahead(motion, time)
        arm = rotate(turn, Vec2(place.x - body.center_x, place.y - body.center_y))
        origin = center_ahead(body, motion, time) + arm
        q = rotate(turn, Vec2(np.float64(place.cosine), np.float64(place.sine)))
        if shape.kind == CIRCLE:  # turning must not show the corners that stand for it
            q = Vec2(1.0, 0.0)
        for f in range(len(order)):
            fluid = fluids[order[f]]
            region = Region(
                fluid.lower_x - origin.x, fluid.lower_y - origin.y, fluid.upper_x - origin.x, fluid.upper_y - origin.y
            )
            part = submerged(points[starts[k] : starts[k + 1]], wholes[k], q, region, work)
            if part.area > 0.0:
                add_part(sums[shape.body], body, fluid, part, arm, gravity)


@kernel
def add_part(total, body, fluid, part, arm, gravity):
    """What one fluid does to one piece."""
    mass = fluid.density * part.area  # displaced [kg]
    x = fluid.density * part.moment.x + mass * arm.x  # times the way from the body's centre [kg m]
    y = fluid.density * part.moment.y + mass * arm.y
    total.force_x -= mass * gravity.x
    total.force_y -= mass * gravity.y
    total.torque -= x * gravity.y - y * gravity.x
    total.drag += fluid.linear_drag * mass
    total.drag_x += fluid.linear_drag * x
    total.drag_y += fluid.linear_drag * y
    total.drag_turn += fluid.linear_drag * (x * x + y * y) / mass + fluid.angular_drag * mass * body.inertia / body.mass
    total.used = 1


@kernel
def add_to_bodies(dynamic, bodies, motions, sums, steps):
    """Adds the sums to the forces on the bodies, and takes them back to nothing."""
    dt = np.float64(steps[0].dt)
    for k in range(len(dynamic)):
        total = sums[dynamic[k]]
        if total.used == 0:
            continue
        body = bodies[dynamic[k]]
        v, w = slowed(body, motions[dynamic[k]], total, dt)
        body.force_x += total.force_x - (total.drag * v.x - total.drag_y * w)
        body.force_y += total.force_y - (total.drag * v.y + total.drag_x * w)
        body.torque += total.torque - (total.drag_x * v.y - total.drag_y * v.x + total.drag_turn * w)
        total.force_x = total.force_y = total.torque = 0.0
        total.drag = total.drag_x = total.drag_y = total.drag_turn = 0.0
        total.used = 0


@kernel
def slowed(body, motion, total, dt):
    """The velocities that drag alone leaves after dt: (M + dt K) u' = M u, the linear part eliminated first."""
    vx = np.float64(motion.vx)
    vy = np.float64(motion.vy)
    w = np.float64(motion.w)
    heavier = body.mass + dt * total.drag
    if motion.inverse_inertia > 0.0:
        off = dt * (total.drag_y * vx - total.drag_x * vy) * body.mass / heavier
        coupled = dt * (total.drag_x * total.drag_x + total.drag_y * total.drag_y) / heavier
        w = (body.inertia * w + off) / (body.inertia + dt * (total.drag_turn - coupled))
    x = (body.mass * vx + dt * total.drag_y * w) / heavier
    y = (body.mass * vy - dt * total.drag_x * w) / heavier
    return Vec2(x, y), w


def apply(state: State, settings: Settings) -> None:
    """Adds the lift and drag of all fluids."""
    kept = state.gathered
    if "outlines" not in kept:
        kept["outlines"] = outlines_of(state)
        kept["sums"] = empty(len(state.bodies.tables["bodies"]), SUMS)
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    fluids = state.fluids.tables["fluids"]
    rows, starts, points, wholes = kept["outlines"]
    add_pieces(
        fluids, state.fluids.order, rows, starts, points, wholes, state.shapes.tables["shapes"], state.placements,
        bodies, motions, kept["sums"], state.steps,
    )  # fmt: skip
    add_to_bodies(state.dynamic, bodies, motions, kept["sums"], state.steps)


def flooded(state: State, settings: Settings) -> str:
    """A fluid calls for it."""
    count = state.fluids.count
    return f"{count} fluid{'s' * (count != 1)}" if count else ""


BUOYANCY = Effect("buoyancy", "fluids carry what is in them, and hold it back", flooded, apply=apply)
