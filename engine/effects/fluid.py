"""Fluids: the handle that a user holds, and how one is made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from engine import validate
from engine.sleeping import wake_in
from engine.vec2 import Vec2

if TYPE_CHECKING:
    from engine.bodies import Pair
    from engine.world import World


class Fluid:
    """A fluid of a world, in a rectangle. Reading or changing one that was destroyed is a ValueError."""

    __slots__ = ("__weakref__", "_row", "serial", "world")

    def __init__(self, world: World, row: int, serial: int) -> None:
        self.world = world
        self.serial = serial  # number of creation among the fluids, from 0, never given twice
        self._row = row

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fluid) and other.world is self.world and other.serial == self.serial

    def __hash__(self) -> int:
        return hash((id(self.world), "fluid", self.serial))

    def __repr__(self) -> str:
        if not self.alive:
            return f"<Fluid {self.serial}, destroyed>"
        return f"<Fluid {self.serial}: {tuple(self.lower)} to {tuple(self.upper)}, density {self.density:g}>"

    @property
    def alive(self) -> bool:
        """Whether it is still in its world."""
        return self.world._state.fluids.holds(self._row, self.serial)

    def destroy(self) -> None:
        """Takes the fluid out of the world."""
        self._check()
        self.world._state.fluids.remove(self._row)
        self.world._content_changed()

    @property
    def lower(self) -> Vec2:
        """Lower left corner [m]."""
        return Vec2(float(self._fluid["lower_x"]), float(self._fluid["lower_y"]))

    @property
    def upper(self) -> Vec2:
        """Upper right corner [m]."""
        return Vec2(float(self._fluid["upper_x"]), float(self._fluid["upper_y"]))

    @property
    def density(self) -> float:
        """[kg/m^2], as of shapes."""
        return float(self._fluid["density"])

    @density.setter
    def density(self, value: float) -> None:
        self._put("density", checked_density(self.world, value))

    @property
    def linear_drag(self) -> float:
        """Rate at which a body as dense as the fluid loses speed where it is all under [1/s]."""
        return float(self._fluid["linear_drag"])

    @linear_drag.setter
    def linear_drag(self, value: float) -> None:
        self._put("linear_drag", checked_drag(self.world, "linear_drag", value))

    @property
    def angular_drag(self) -> float:
        """Rate at which it loses spin, beyond what linear drag does [1/s]."""
        return float(self._fluid["angular_drag"])

    @angular_drag.setter
    def angular_drag(self, value: float) -> None:
        self._put("angular_drag", checked_drag(self.world, "angular_drag", value))

    def _put(self, name: str, value: float) -> None:
        self._fluid[name] = value
        self.world._content_changed()

    def _check(self) -> None:
        if not self.alive:
            raise ValueError(f"fluid = Fluid {self.serial}: must be a living fluid, this one was destroyed")

    @property
    def _fluid(self) -> Any:
        self._check()
        return self.world._state.fluids.tables["fluids"][self._row]


def add_fluid(world: World, lower: Pair, upper: Pair, density: float, linear_drag: float, angular_drag: float) -> Fluid:
    """Checks everything, then writes the fluid's row: World.create_fluid says what the arguments mean."""
    lower_x, lower_y = validate.vector("lower", lower)
    upper_x, upper_y = validate.vector("upper", upper)
    if not (lower_x < upper_x and lower_y < upper_y):
        raise validate.refuse("upper", (upper_x, upper_y), f"above and to the right of lower = {(lower_x, lower_y)}")
    values = {
        "lower_x": lower_x, "lower_y": lower_y, "upper_x": upper_x, "upper_y": upper_y,
        "density": checked_density(world, density),
        "linear_drag": checked_drag(world, "linear_drag", linear_drag),
        "angular_drag": checked_drag(world, "angular_drag", angular_drag),
    }  # fmt: skip
    storage = world._state.fluids
    row = storage.add()
    for name, value in values.items():
        storage.tables["fluids"][name][row] = value
    wake_in(world._state, row)
    return Fluid(world, row, int(storage.tables["fluids"]["serial"][row]))


def checked_density(world: World, value: float) -> float:
    density = validate.positive("density", value)
    validate.in_range(world.precision, density=(density,))
    return density


def checked_drag(world: World, name: str, value: float) -> float:
    drag = validate.non_negative(name, value)
    validate.in_range(world.precision, **{name: (drag,)})
    return drag
