"""Explosions: an impulse away from a point on everything near it, at once.

Each piece of a shape gets impulse x its width as seen from the point, at the place on it that is nearest to the point:
in full as far as `radius`, then less and less until, `falloff` further out, there is nothing left. A piece that the
point lies in is pushed at its middle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from engine import validate
from engine.effects.cores import write_core
from engine.effects.effect import Effect
from engine.jit import kernel
from engine.shapes.placing import write_placements
from engine.sleeping import touch_weights
from engine.tables import HULL_POINTS, empty, placement_dtype
from engine.vec2 import Vec2, cross, dot, rotate

if TYPE_CHECKING:
    from engine.bodies import Pair
    from engine.settings import Settings
    from engine.state import State
    from engine.world import World


class Facing(NamedTuple):
    """A piece as seen from the explosion, which is at the origin."""

    point: Vec2  # where the impulse acts [m]
    direction: Vec2  # unit, away from the explosion; zero where there is none
    distance: Any  # [m]
    width: Any  # across the direction [m]


@kernel
def explode_all(order, shapes, hulls, placements, bodies, motions, center_x, center_y, radius, falloff, impulse):
    """Gives every piece its impulse, in the order of creation."""
    corners = np.empty((HULL_POINTS, 2))
    for rank in range(len(order)):
        shape = shapes[order[rank]]
        motion = motions[shape.body]
        if motion.inverse_mass == 0.0:
            continue
        body = bodies[shape.body]
        place = placements[order[rank]]
        count = write_core(shape, hulls, corners)
        q = Vec2(np.float64(place.cosine), np.float64(place.sine))
        for k in range(count):
            corner = rotate(q, Vec2(corners[k, 0], corners[k, 1]))
            corners[k, 0] = corner.x + (place.x - center_x)
            corners[k, 1] = corner.y + (place.y - center_y)
        facing = face(corners, count, shape.radius)
        strength = impulse * facing.width * share(facing.distance, radius, falloff)
        if strength != 0.0:
            push = facing.direction * strength
            arm = facing.point - Vec2(body.center_x - center_x, body.center_y - center_y)
            motion.vx += np.float64(motion.inverse_mass) * push.x
            motion.vy += np.float64(motion.inverse_mass) * push.y
            motion.w += np.float64(motion.inverse_inertia) * cross(arm, push)


@kernel
def share(distance, radius, falloff):
    """What is left of the impulse so far away, 1 to 0."""
    if distance <= radius:
        return 1.0
    if distance >= radius + falloff:
        return 0.0
    return (radius + falloff - distance) / falloff


@kernel
def face(corners, count, rounding):
    """How a piece faces the origin: its corners, counter-clockwise, and how far it is rounded [m]."""
    nearest, inside = nearest_point(corners, count)
    away = np.sqrt(dot(nearest, nearest))
    distance = 0.0
    if inside or away == 0.0:
        nearest = middle(corners, count)
        away = np.sqrt(dot(nearest, nearest))
        if away == 0.0:
            return Facing(nearest, Vec2(0.0, 0.0), 0.0, 0.0)
        direction = nearest * (1.0 / away)
    else:
        direction = nearest * (1.0 / away)
        distance = max(away - rounding, 0.0)
        nearest = direction * distance
    least = np.inf
    most = -np.inf
    for k in range(count):
        across = cross(direction, Vec2(corners[k, 0], corners[k, 1]))
        least = min(least, across)
        most = max(most, across)
    return Facing(nearest, direction, distance, most - least + 2.0 * rounding)


@kernel
def nearest_point(corners, count):
    """(the point of a polygon's outline, line or point that is nearest to the origin, whether the origin is inside)."""
    best = Vec2(corners[0, 0], corners[0, 1])
    inside = count > 2
    for k in range(count if count > 2 else count - 1):
        after = k + 1 if k + 1 < count else 0
        a = Vec2(corners[k, 0], corners[k, 1])
        edge = Vec2(corners[after, 0], corners[after, 1]) - a
        along = min(max(-dot(a, edge) / dot(edge, edge), 0.0), 1.0)
        point = a + edge * along
        if dot(point, point) < dot(best, best):
            best = point
        inside = inside and cross(a, edge) > 0.0
    return best, inside


@kernel
def middle(corners, count):
    """The mean of the corners."""
    x = 0.0
    y = 0.0
    for k in range(count):
        x += corners[k, 0]
        y += corners[k, 1]
    return Vec2(x / count, y / count)


def explode(world: World, position: Pair, radius: float, falloff: float, impulse: float) -> None:
    """Checks everything, then pushes: World.explode says what the arguments mean."""
    x, y = validate.vector("position", position)
    radius = validate.non_negative("radius", radius)
    falloff = validate.non_negative("falloff", falloff)
    strength = validate.number("impulse", impulse)
    state = world._state
    shapes, hulls = state.shapes.tables["shapes"], state.hulls.tables["hulls"]
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    placements = empty(len(shapes), placement_dtype(state.precision))
    write_placements(state.shapes.order, shapes, bodies, motions, placements)
    before = np.array(motions)
    with np.errstate(over="ignore", invalid="ignore"):  # without compilation numpy would warn of what is refused below
        explode_all(
            state.shapes.order, shapes, hulls, placements, bodies, motions, x, y, radius, falloff, strength
        )  # fmt: skip
    if not all(np.isfinite(motions[name]).all() for name in ("vx", "vy", "w")):
        motions[:] = before
        raise validate.refuse("impulse", impulse, f"one that velocities in {world.precision} precision can hold")
    touch_weights(state, np.flatnonzero(motions != before))
    state.explosions += 1


def blasts(state: State, settings: Settings) -> str:
    """It acts when it is asked for, not in a step."""
    count = state.explosions
    return f"{count} explosion{'s' * (count != 1)} so far" if count else ""


EXPLOSION = Effect("explosions", "an impulse away from a point, as strong as what faces it is wide", blasts)
