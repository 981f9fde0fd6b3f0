"""What bodies weigh: mass, centre of mass and inertia, from their shapes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine import validate
from engine.constants import DENSITY
from engine.integrate import place_rows
from engine.shapes import SHAPES, Shape
from engine.tables import DYNAMIC, REALS
from engine.vec2 import Vec2, rotate

if TYPE_CHECKING:
    from engine.state import State


class Part(NamedTuple):
    """A shape with mass, in its body's frame."""

    mass: float  # [kg]
    center: Vec2  # of mass [m]
    inertia: float  # about it [kg m^2]


def shape_mass(shape: Shape, mass: float | None, density: float | None) -> float:
    """Mass of a shape [kg], from what was given of it."""
    if mass is not None and density is not None:
        raise validate.refuse("density", density, "left out where mass is given")
    if mass is not None:
        mass = validate.positive("mass", mass)
        if shape.area == 0.0:
            raise validate.refuse("mass", mass, f"left out for a {shape.name}: it has none")
        return mass
    return validate.positive("density", DENSITY if density is None else density) * shape.area


def check_weight(shape: Shape, mass: float, kind: str, precision: str) -> None:
    """ValueError if the solver's precision cannot hold what a dynamic body of this shape weighs."""
    if kind == "dynamic" and shape.area > 0.0:
        check_range(mass, shape.inertia(mass), precision)


def check_range(mass: float, inertia: float, precision: str) -> None:
    """A joint multiplies two inverse masses: their product, too, must be a normal number."""
    low = math.sqrt(float(np.finfo(REALS[precision]).tiny))
    for name, value in (("mass", mass), ("inertia", inertia)):
        if not low < value < 1.0 / low:
            raise validate.refuse(name, value, f"from {low:.2g} to {1.0 / low:.2g} in {precision} precision")


def weigh(state: State, rows: np.ndarray, shape_rows: np.ndarray) -> None:
    """Writes mass, centre and inertia of bodies that all have shapes alike: the first one's are those of all.

    shape_rows: of all their shapes, body after body. Nothing but the frame of the body need be right before.
    """
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    if len(rows) == 0:
        return
    mass, center, inertia = together(weights_of(state, shape_rows[: len(shape_rows) // len(rows)]))
    bodies["local_x"][rows], bodies["local_y"][rows] = center
    if bodies["kind"][rows[0]] == DYNAMIC:
        turns = inertia > 0.0 and not bodies["fixed_rotation"][rows[0]]
        bodies["mass"][rows] = mass
        bodies["inertia"][rows] = inertia
        motions["inverse_mass"][rows] = 1.0 / mass if mass > 0.0 else 0.0
        motions["inverse_inertia"][rows] = 1.0 / inertia if turns else 0.0
    else:
        bodies["mass"][rows] = bodies["inertia"][rows] = math.inf
        motions["inverse_mass"][rows] = motions["inverse_inertia"][rows] = 0.0


def reweigh(state: State, row: int) -> None:
    """Takes one body's mass, centre and inertia afresh.

    Its velocity becomes that of its new centre's material point, and kept contacts, whose anchors are reckoned from the
    old one, are found anew.
    """
    bodies, motions = state.bodies.tables["bodies"], state.bodies.tables["motions"]
    shapes = state.shapes.tables["shapes"]
    own = state.shapes.order[shapes["body"][state.shapes.order] == row]
    before = Vec2(float(bodies["center_x"][row]), float(bodies["center_y"][row]))
    weigh(state, np.array([row]), own)
    place_rows(bodies, motions, np.array([row]))
    way = Vec2(float(bodies["center_x"][row]), float(bodies["center_y"][row])) - before
    w = float(motions["w"][row])
    motions["vx"][row] -= w * way.y
    motions["vy"][row] += w * way.x
    state.find_contacts_anew(row)


def weights_of(state: State, shape_rows: np.ndarray) -> list[Part]:
    """What has mass among some shapes, in the body's frame."""
    shapes = state.shapes.tables["shapes"]
    parts = []
    for row in shape_rows:
        one = shapes[row : row + 1]
        mass = float(one["mass"][0])
        if mass > 0.0:
            shape = SHAPES[int(one["kind"][0])].from_rows(one, state.hulls.tables["hulls"])
            q = Vec2(float(one["local_cosine"][0]), float(one["local_sine"][0]))
            parts.append(placed_part(shape, mass, q, Vec2(float(one["local_x"][0]), float(one["local_y"][0]))))
    return parts


def placed_part(shape: Shape, mass: float, q: Vec2, place: Vec2) -> Part:
    """What a shape adds to a body in whose frame it is placed and turned like that."""
    plate = shape.lamina()
    return Part(mass, place + rotate(q, Vec2(plate.x, plate.y)), shape.inertia(mass))


def together(parts: list[Part]) -> tuple[float, tuple[float, float], float]:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2] of parts together (Huygens and Steiner)."""
    mass = math.fsum(part.mass for part in parts)
    if mass == 0.0:
        return 0.0, (0.0, 0.0), 0.0
    x = math.fsum(part.mass * part.center.x for part in parts) / mass
    y = math.fsum(part.mass * part.center.y for part in parts) / mass
    inertia = math.fsum(p.inertia + p.mass * ((p.center.x - x) ** 2 + (p.center.y - y) ** 2) for p in parts)
    return mass, (x, y), inertia
