"""Closed rooms of every kind of wall, what is thrown about in them, and how far a body is out of them."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from engine import Body, Box, Capsule, Chain, Circle, Polygon, Segment, Shape, World

HALF = 5.0  # of a room's width and height [m]
CORNERS = ((-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF))
SIDES = list(zip(CORNERS, (*CORNERS[1:], CORNERS[0]), strict=True))


def add_boxes(world: World, thickness: float) -> None:
    """Four boxes around the room."""
    middle, length = HALF + 0.5 * thickness, 2 * (HALF + thickness)
    for x, y in ((middle, 0.0), (-middle, 0.0), (0.0, middle), (0.0, -middle)):
        size = (thickness, length) if y == 0.0 else (length, thickness)
        world.create_body(Box(*size), position=(x, y), kind="static")


def add_segments(world: World, pieces: int) -> None:
    """Each side of so many segments, end to end."""
    walls = world.create_body(kind="static")
    for a, b in SIDES:
        points = np.linspace(a, b, pieces + 1)
        for p, q in itertools.pairwise(points):
            walls.add_shape(Segment(tuple(p), tuple(q)))


ROOMS: dict[str, Any] = {
    "thin boxes": lambda world: add_boxes(world, 0.001),
    "thick boxes": lambda world: add_boxes(world, 1.0),
    "segments": lambda world: add_segments(world, 1),
    "many segments": lambda world: add_segments(world, 20),
    "chain": lambda world: world.create_body(Chain(CORNERS, closed=True), kind="static"),
}

THROWN: dict[str, tuple[tuple[Shape, tuple[float, float], float], ...]] = {
    "small circle": ((Circle(0.005), (0, 0), 0),),
    "circle": ((Circle(0.3), (0, 0), 0),),
    "box": ((Box(0.3, 0.2), (0, 0), 0),),
    "thin rod": ((Box(1.5, 0.004), (0, 0), 0),),
    "capsule": ((Capsule(0.8, 0.01), (0, 0), 0),),
    "splinter": ((Polygon(((0, 0), (0.6, 0.0), (0.0, 0.15))), (0, 0), 0),),
    "rounded": ((Polygon(((0.2, 0), (0, 0.3), (-0.2, -0.1)), radius=0.01), (0, 0), 0),),
    "compound": ((Circle(0.05), (-0.3, 0), 0), (Box(0.1, 0.02), (0.4, 0.1), 0.4)),
}


def throw(world: World, name: str, **how: Any) -> Body:
    """A body of one of those."""
    (shape, offset, angle), *more = THROWN[name]
    body = world.create_body(shape, offset=offset, shape_angle=angle, **how)
    for shape, offset, angle in more:
        body.add_shape(shape, offset=offset, angle=angle)
    return body


def core_points(body: Body) -> np.ndarray:
    """(n, 2) where the corners of its cores are, and its centre of mass [m]."""
    world = body.world
    records, hulls = world.shape_records(), world.hull_records()
    found = [tuple(body.center)]
    c, s = math.cos(body.angle), math.sin(body.angle)
    for shape in records[records["body"] == body._row]:
        local: list[tuple[float, float]] = [
            (sx * shape["half_x"], sy * shape["half_y"]) for sx in (-1, 1) for sy in (-1, 1)
        ]
        if shape["hull"] >= 0:
            hull = hulls[shape["hull"]]
            local = list(zip(hull["x"][: hull["count"]], hull["y"][: hull["count"]], strict=True))
        for x, y in local:
            u = shape["local_x"] + shape["local_cosine"] * x - shape["local_sine"] * y
            v = shape["local_y"] + shape["local_sine"] * x + shape["local_cosine"] * y
            found.append((body.position.x + c * u - s * v, body.position.y + s * u + c * v))
    return np.array(found)


def outside(body: Body) -> float:
    """How far the furthest of these is beyond a wall [m]; < 0: inside."""
    return float(np.abs(core_points(body)).max() - HALF)
