"""A semicircular arch of loose stones."""

from __future__ import annotations

import math

import numpy as np

from engine import Polygon, World
from sandbox.lab.sag import predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import ROUGH, add_floor, and_a_fifth, but_a_fifth, distance_from
from sandbox.scenes.registry import scene

STONES = 13
KEYSTONE = STONES // 2
INNER, OUTER = 4.0, 5.2  # radii [m]. It stands if it is thicker than 0.1075 of its mean radius (M. Milankovitch, 1907).


def ray(k: int, radius: float) -> np.ndarray:
    """A corner: on joint k of 0 (the right foot) to STONES (the left one), at that radius [m]."""
    angle = math.pi * k / STONES
    return radius * np.array([math.cos(angle), math.sin(angle)])


def stone(k: int) -> tuple[np.ndarray, np.ndarray]:
    """Where stone k has its centre of mass, and its four corners from there [m]."""
    corners = np.array([ray(k, INNER), ray(k, OUTER), ray(k + 1, OUTER), ray(k + 1, INNER)])
    plate = Polygon(tuple(map(tuple, corners))).lamina()
    center = np.array([plate.x, plate.y])
    return center, corners - center


def arch_of_stones() -> Structure:
    """The stones, and the two points of each joint: its inner and its outer end."""
    shapes = [(center, Polygon(tuple(map(tuple, corners)))) for center, corners in map(stone, range(STONES))]
    points = []
    for k in range(STONES + 1):
        first, second = (k - 1, k) if k < STONES else (k - 1, GROUND)
        nx, ny = -math.sin(math.pi * k / STONES), math.cos(math.pi * k / STONES)
        points += [Point(first, second, float(x), float(y), nx, ny) for x, y in (ray(k, INNER), ray(k, OUTER))]
    masses = np.array([shape.area for _, shape in shapes])
    inertias = np.array([shape.inertia(mass) for (_, shape), mass in zip(shapes, masses, strict=True)])
    return Structure(np.array([center for center, _ in shapes]), masses, inertias, points)


@scene(
    "Stacking/Arch",
    shows=Criterion(
        "the keystone is off its place by",
        lambda world: distance_from(world, 1 + KEYSTONE, *stone(KEYSTONE)[0]),
        unit="m",
        after=10.0,
        at_most=and_a_fifth(lambda world, dt: predicted_sink(world, dt, arch_of_stones(), KEYSTONE)),
        at_least=but_a_fifth(lambda world, dt: predicted_sink(world, dt, arch_of_stones(), KEYSTONE)),
    ),
    view=(0.0, 2.8, 9.0),
)
def arch(world: World) -> None:
    """Thirteen loose stones hold each other up: all of them push, none pulls."""
    add_floor(world, 40)
    for k in range(STONES):
        center, corners = stone(k)
        world.create_body(Polygon(tuple(map(tuple, corners))), position=tuple(center), friction=ROUGH)
