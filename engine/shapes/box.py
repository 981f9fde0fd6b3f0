"""A box: the talk's one shape, about its centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from engine.constants import BOUNDS_MARGIN, BOUNDS_MARGIN_RELATIVE
from engine.jit import kernel
from engine.lanes import absolute
from engine.validate import positive

BOX = 0


@dataclass(frozen=True)
class Box:
    """A rectangle of full `width` and `height` [m] about the body's centre."""

    width: float
    height: float

    name = "box"
    kind = BOX

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", positive("width", self.width))
        object.__setattr__(self, "height", positive("height", self.height))

    @property
    def area(self) -> float:
        """[m^2]"""
        return self.width * self.height

    def inertia(self, mass: float) -> float:
        """Moment of inertia about the centre, m (w^2 + h^2) / 12 [kg m^2]."""
        return mass * (self.width * self.width + self.height * self.height) / 12.0

    @property
    def half_extents(self) -> tuple[float, float]:
        """What the body table keeps of it [m]."""
        return 0.5 * self.width, 0.5 * self.height

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of what it fills upright [m]."""
        return self.width, self.height

    @staticmethod
    def sizes(half_x: Any, half_y: Any) -> tuple[Any, Any]:
        """What describes it to the outside, numbers or arrays: full width and height [m]."""
        return 2.0 * half_x, 2.0 * half_y

    @classmethod
    def filling(cls, width: float, height: float) -> Box:
        """The one that fills a rectangle of that width and height [m]."""
        return cls(width, height)

    @staticmethod
    def from_half_extents(half_x: float, half_y: float) -> Box:
        return Box(2.0 * half_x, 2.0 * half_y)

    @staticmethod
    def contains(x: Any, y: Any, half_x: Any, half_y: Any) -> Any:
        """Whether a point in the body's frame lies in the box: numbers, or arrays of them [m]."""
        return (abs(x) <= half_x) & (abs(y) <= half_y)


@kernel
def box_bounds(order, bodies, motions, bounds):
    """Writes the bounding boxes of all box bodies: bounds (4, N) float32, lower x and y, upper x and y, in `order`."""
    for rank in range(len(order)):
        row = order[rank]
        body = bodies[row]
        if body.shape_kind == BOX:
            motion = motions[row]
            c = absolute(motion.cosine)
            s = absolute(motion.sine)
            reach_x = c * body.half_x + s * body.half_y
            reach_y = s * body.half_x + c * body.half_y
            reach_x += BOUNDS_MARGIN + BOUNDS_MARGIN_RELATIVE * (absolute(body.x) + reach_x)
            reach_y += BOUNDS_MARGIN + BOUNDS_MARGIN_RELATIVE * (absolute(body.y) + reach_y)
            bounds[0, rank] = body.x - reach_x
            bounds[1, rank] = body.y - reach_y
            bounds[2, rank] = body.x + reach_x
            bounds[3, rank] = body.y + reach_y
