"""A circle: the talk's first exercise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from engine.constants import BOUNDS_MARGIN, BOUNDS_MARGIN_RELATIVE
from engine.jit import kernel
from engine.lanes import absolute
from engine.validate import positive

CIRCLE = 1


@dataclass(frozen=True)
class Circle:
    """A disc of `radius` [m] about the body's centre."""

    radius: float

    name = "circle"
    kind = CIRCLE

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive("radius", self.radius))

    @property
    def area(self) -> float:
        """[m^2]"""
        return math.pi * self.radius * self.radius

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centre, m r^2 / 2 [kg m^2]."""
        return 0.5 * mass * self.radius * self.radius

    @property
    def half_extents(self) -> tuple[float, float]:
        """What the body table keeps of it [m]."""
        return self.radius, 0.0

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills [m]."""
        return 2.0 * self.radius, 2.0 * self.radius

    @staticmethod
    def sizes(half_x: Any, half_y: Any) -> tuple[Any, Any]:
        """What describes it to the outside, numbers or arrays: radius, and 0 [m]."""
        return half_x, half_y

    @classmethod
    def filling(cls, width: float, height: float) -> Circle:
        """The one that has that width for its diameter [m]; the height plays no part."""
        return cls(0.5 * width)

    @staticmethod
    def from_half_extents(half_x: float, half_y: float) -> Circle:
        return Circle(half_x)

    @staticmethod
    def contains(x: Any, y: Any, half_x: Any, half_y: Any) -> Any:
        """Whether a point in the body's frame lies in the disc: numbers, or arrays of them [m]."""
        return x * x + y * y <= half_x * half_x


@kernel
def circle_bounds(order, bodies, motions, bounds):
    """Writes the bounding boxes of all circle bodies: bounds (4, N) float32, as box_bounds does."""
    for rank in range(len(order)):
        body = bodies[order[rank]]
        if body.shape_kind == CIRCLE:
            radius = body.half_x
            reach_x = radius + BOUNDS_MARGIN + BOUNDS_MARGIN_RELATIVE * (absolute(body.x) + radius)
            reach_y = radius + BOUNDS_MARGIN + BOUNDS_MARGIN_RELATIVE * (absolute(body.y) + radius)
            bounds[0, rank] = body.x - reach_x
            bounds[1, rank] = body.y - reach_y
            bounds[2, rank] = body.x + reach_x
            bounds[3, rank] = body.y + reach_y
