"""Making bodies, shapes and joints: everything is checked first, then written, so that a refusal changes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine import validate
from engine.blueprint import Blueprint
from engine.bodies import Body, Pair
from engine.effects import BODY_PROPERTIES, SHAPE_PROPERTIES
from engine.integrate import place_rows
from engine.properties import check
from engine.shape_handle import ShapeHandle
from engine.shapes import Shape
from engine.sleeping import asleep_of, touch
from engine.tables import BODY_KINDS, DYNAMIC
from engine.trigonometry import cos_sin
from engine.vec2 import Vec2
from engine.weights import check_range, check_weight, placed_part, reweigh, together, weigh, weights_of

if TYPE_CHECKING:
    from engine.state import State
    from engine.world import World


def add_bodies(
    world: World,
    shape: Shape | None,
    positions: np.ndarray,
    angles: np.ndarray,
    kind: str,
    mass: float | None,
    density: float | None,
    friction: float,
    velocities: np.ndarray,
    angular_velocities: np.ndarray,
    fixed_rotation: bool,
    offset: Pair,
    shape_angle: float,
    properties: dict[str, Any],
) -> list[Body]:
    """Checks everything, then writes the rows of all bodies: World.create_body says what the arguments mean."""
    kind = validate.choice("kind", kind, BODY_KINDS)
    fixed_rotation = validate.switch("fixed_rotation", fixed_rotation)
    shape_angle = validate.number("shape_angle", shape_angle)
    of_shape = {name: value for name, value in properties.items() if name in SHAPE_PROPERTIES}
    of_body = {name: value for name, value in properties.items() if name not in SHAPE_PROPERTIES}
    of_body = check(world, of_body, BODY_PROPERTIES, more=SHAPE_PROPERTIES)
    validate.in_range(
        world.precision, velocity=np.abs(velocities).max(0, initial=0), angular_velocity=np.abs(angular_velocities)
    )
    if kind == "static" and (velocities.any() or angular_velocities.any()):
        raise validate.refuse("velocity", (*velocities[0], angular_velocities[0]), "zero for a static body")
    if kind == "dynamic" and fixed_rotation and angular_velocities.any():
        raise validate.refuse("angular_velocity", float(angular_velocities[0]), "zero where the rotation is fixed")
    blueprint = None
    if shape is not None:
        blueprint = Blueprint(world, shape, mass, density, friction, offset, shape_angle, of_shape)
        check_weight(shape, blueprint.mass, kind, world.precision)
    elif mass is not None or density is not None or of_shape:
        raise validate.refuse("shape", shape, "given where mass, density or properties of a shape are")

    state = world._state
    rows = state.bodies.add_many(len(positions))
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    bodies["x"][rows], bodies["y"][rows] = positions[:, 0], positions[:, 1]
    bodies["angle"][rows] = angles
    bodies["kind"][rows] = BODY_KINDS.index(kind)
    bodies["fixed_rotation"][rows] = fixed_rotation
    motions["vx"][rows], motions["vy"][rows] = velocities[:, 0], velocities[:, 1]
    motions["w"][rows] = angular_velocities
    for name, value in of_body.items():
        state.bodies.put(name, rows, value)
    shape_rows = np.empty(0, np.int64) if blueprint is None else blueprint.write(state, rows)
    weigh(state, rows, shape_rows)
    place_rows(bodies, motions, rows)
    if asleep_of(state) is not None:
        state.bodies.put("disturbed", rows, 1)
    return [Body(world, int(row), int(serial)) for row, serial in zip(rows, bodies["serial"][rows], strict=True)]


def add_shape(
    world: World,
    body: Body,
    shape: Shape,
    mass: float | None,
    density: float | None,
    friction: float,
    offset: Pair,
    angle: float,
    properties: dict[str, Any],
) -> ShapeHandle:
    """Puts a shape on a body, whose mass, centre and inertia follow: Body.add_shape says what the arguments mean."""
    blueprint = Blueprint(world, shape, mass, density, friction, offset, angle, properties)
    state = world._state
    check_more_weight(state, body._row, blueprint, world.precision)
    touch(state, body._row)
    rows = blueprint.write(state, np.array([body._row]))
    reweigh(state, body._row)
    return ShapeHandle(world, rows, int(state.shapes.tables["shapes"]["serial"][rows[0]]))


def check_more_weight(state: State, row: int, blueprint: Blueprint, precision: str) -> None:
    """ValueError if the solver's precision cannot hold what a dynamic body weighs with one shape more."""
    if int(state.bodies.tables["bodies"]["kind"][row]) != DYNAMIC or blueprint.shape.area == 0.0:
        return
    order, shapes = state.shapes.order, state.shapes.tables["shapes"]
    parts = weights_of(state, order[shapes["body"][order] == row])
    parts.append(placed_part(blueprint.shape, blueprint.mass, Vec2(*cos_sin(blueprint.angle)), blueprint.offset))
    mass, center, inertia = together(parts)
    validate.in_range(precision, offset=center)
    check_range(mass, inertia, precision)


def checked_positions(value: Any) -> np.ndarray:
    """(N, 2) finite floats."""
    try:
        positions = real_numbers(value)
    except (TypeError, ValueError):
        positions = np.empty(0)
    if positions.ndim != 2 or positions.shape[1] != 2:
        if positions.shape == (0,) and hasattr(value, "__len__") and len(value) == 0:
            return np.empty((0, 2))
        raise validate.refuse("positions", value, "an array (N, 2) of finite numbers")
    return finite_rows("positions", positions, len(positions), 2)


def real_numbers(value: Any) -> np.ndarray:
    """An array of floats; text and booleans are no numbers. TypeError or ValueError if it is something else."""
    given = np.asarray(value)
    if given.dtype.kind not in "fiu":
        raise TypeError(given.dtype)
    return given.astype(np.float64)


def finite_rows(name: str, value: Any, count: int, width: int) -> np.ndarray:
    """(count, width) or, for width 0, (count,) finite floats, from an array or one value for all."""
    allowed = f"finite numbers, {count} times {width or 1} or one for all"
    try:
        values = real_numbers(value)
        values = np.broadcast_to(values, (count, width) if width else (count,))
    except (TypeError, ValueError):
        raise validate.refuse(name, value, allowed) from None
    if not np.isfinite(values).all():
        bad = int(np.flatnonzero(~np.isfinite(values.reshape(count, -1)).all(axis=1))[0])
        raise validate.refuse(f"{name}[{bad}]", values[bad], "finite")
    return values
