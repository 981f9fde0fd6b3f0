"""What may be asked of a simulation, as checked, immutable data: a page, a script and a recording all say it so.

A command is validated when it is made: ValueError names the argument, its value and what is allowed. Those with a name
in PHYSICS change the world; they are recorded with the step before which they were applied, and make a recording of a
lively session repeatable.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from engine import SHAPE_KINDS, SOLVERS, Box, Circle, validate
from engine.constants import MAX_ITERATIONS
from sandbox.scenes import find_scene

if TYPE_CHECKING:
    from sandbox.simulation import Simulation

REACH = 1e5  # farthest coordinate that a command may name [m]
LARGEST_GRAVITY = 1000.0  # [m/s^2]
SIZES = (0.05, 20.0)  # [m]
LARGEST_MASS = 1e6  # [kg]
LARGEST_FRICTION = 10.0
LARGEST_SPAWN = 200  # bodies at once
MOST_ITERATIONS = min(1000, MAX_ITERATIONS)
HANDS = 2**31
SWITCHES = ("accumulate_impulses", "warm_starting", "position_correction")
SPEEDS = (0.1, 4.0)  # simulated seconds per second


class Command(Protocol):
    """What the session takes."""

    name: ClassVar[str]


class PhysicsCommand:
    """A command that changes the world."""

    name: ClassVar[str]

    def to_dict(self) -> dict[str, Any]:
        """As JSON takes it."""
        return {"command": self.name, **asdict(self)}  # type: ignore[call-overload]

    def apply(self, simulation: Simulation) -> None:
        """Does it."""
        raise TypeError(f"{type(self).__name__} cannot be applied")

    def _keep(self, **checked: Any) -> None:
        for name, value in checked.items():
            object.__setattr__(self, name, value)


def coordinates(**values: Any) -> dict[str, float]:
    """Checked coordinates [m]."""
    return {name: validate.between(name, value, -REACH, REACH) for name, value in values.items()}


@dataclass(frozen=True)
class SetGravity(PhysicsCommand):
    """Gravity [m/s^2]."""

    x: float
    y: float
    name = "set_gravity"

    def __post_init__(self) -> None:
        for name in ("x", "y"):
            value = validate.between(name, getattr(self, name), -LARGEST_GRAVITY, LARGEST_GRAVITY)
            self._keep(**{name: value})

    def apply(self, simulation: Simulation) -> None:
        simulation.world.gravity = (self.x, self.y)


@dataclass(frozen=True)
class SetIterations(PhysicsCommand):
    """Passes over all constraints in a step."""

    iterations: int
    name = "set_iterations"

    def __post_init__(self) -> None:
        self._keep(iterations=validate.whole("iterations", self.iterations, 1, MOST_ITERATIONS))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.iterations = self.iterations


@dataclass(frozen=True)
class SetSwitch(PhysicsCommand):
    """One of the talk's three switches."""

    switch: str
    on: bool
    name = "set_switch"

    def __post_init__(self) -> None:
        self._keep(switch=validate.choice("switch", self.switch, SWITCHES), on=validate.switch("on", self.on))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.set(**{self.switch: self.on})


@dataclass(frozen=True)
class SetSolver(PhysicsCommand):
    """The solver, by name."""

    solver: str
    name = "set_solver"

    def __post_init__(self) -> None:
        self._keep(solver=validate.choice("solver", self.solver, SOLVERS))

    def apply(self, simulation: Simulation) -> None:
        simulation.world.solver = self.solver


@dataclass(frozen=True)
class Spawn(PhysicsCommand):
    """New bodies around a point [m]: box of width and height, or circle of diameter width [m]; mass each [kg]."""

    shape: str
    x: float
    y: float
    width: float = 1.0
    height: float = 1.0
    mass: float = 10.0
    friction: float = 0.2
    count: int = 1
    name = "spawn"

    def __post_init__(self) -> None:
        self._keep(
            shape=validate.choice("shape", self.shape, SHAPE_KINDS),
            width=validate.between("width", self.width, *SIZES),
            height=validate.between("height", self.height, *SIZES),
            mass=validate.between("mass", self.mass, 1e-3, LARGEST_MASS),
            friction=validate.between("friction", self.friction, 0.0, LARGEST_FRICTION),
            count=validate.whole("count", self.count, 1, LARGEST_SPAWN),
            **coordinates(x=self.x, y=self.y),
        )

    def apply(self, simulation: Simulation) -> None:
        simulation.make_room(self.count)
        box = self.shape == "box"
        shape = Box(self.width, self.height) if box else Circle(0.5 * self.width)
        columns = math.ceil(math.sqrt(self.count))
        step_x, step_y = 1.1 * self.width, 1.1 * (self.height if box else self.width)
        for i in range(self.count):
            x = self.x + step_x * (i % columns - 0.5 * (columns - 1))
            y = self.y + step_y * (i // columns)
            simulation.world.create_body(shape, position=(x, y), mass=self.mass, friction=self.friction)


@dataclass(frozen=True)
class Bomb(PhysicsCommand):
    """Box2D Lite's bomb: one heavy box, thrown, and thrown again."""

    x: float
    y: float
    angle: float
    vx: float
    vy: float
    spin: float
    name = "bomb"

    def __post_init__(self) -> None:
        self._keep(
            **coordinates(x=self.x, y=self.y),
            angle=validate.between("angle", self.angle, -1e3, 1e3),
            vx=validate.between("vx", self.vx, -1e3, 1e3),
            vy=validate.between("vy", self.vy, -1e3, 1e3),
            spin=validate.between("spin", self.spin, -1e3, 1e3),
        )

    @classmethod
    def random(cls, rng: random.Random) -> Bomb:
        """From above, aimed at the origin, as Box2D Lite throws it."""
        x, y = rng.uniform(-15.0, 15.0), 15.0
        return cls(x, y, rng.uniform(-1.5, 1.5), -1.5 * x, -1.5 * y, rng.uniform(-20.0, 20.0))

    def apply(self, simulation: Simulation) -> None:
        bomb = simulation.bomb()
        bomb.position = (self.x, self.y)
        bomb.angle = self.angle
        bomb.velocity = (self.vx, self.vy)
        bomb.angular_velocity = self.spin


@dataclass(frozen=True)
class Grab(PhysicsCommand):
    """A hand takes hold of the dynamic body under a point [m], if there is one."""

    hand: int
    x: float
    y: float
    name = "grab"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS), **coordinates(x=self.x, y=self.y))

    def apply(self, simulation: Simulation) -> None:
        simulation.grab(self.hand, (self.x, self.y))


@dataclass(frozen=True)
class MoveHand(PhysicsCommand):
    """A hand moves to a point [m], and what it holds is pulled after it."""

    hand: int
    x: float
    y: float
    name = "move_hand"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS), **coordinates(x=self.x, y=self.y))

    def apply(self, simulation: Simulation) -> None:
        simulation.move_hand(self.hand, (self.x, self.y))


@dataclass(frozen=True)
class Release(PhysicsCommand):
    """A hand lets go."""

    hand: int
    name = "release"

    def __post_init__(self) -> None:
        self._keep(hand=validate.whole("hand", self.hand, 0, HANDS))

    def apply(self, simulation: Simulation) -> None:
        simulation.release(self.hand)


PHYSICS = {
    kind.name: kind
    for kind in (SetGravity, SetIterations, SetSwitch, SetSolver, Spawn, Bomb, Grab, MoveHand, Release)
}  # fmt: skip


def command_from_dict(values: Mapping[str, Any]) -> PhysicsCommand:
    """What `to_dict` gave; anything else is a ValueError."""
    if not isinstance(values, Mapping):
        raise validate.refuse("command", values, "a mapping of names to values")
    kind = PHYSICS[validate.choice("command", values.get("command"), PHYSICS)]
    arguments = {name: value for name, value in values.items() if name != "command"}
    known = {field.name for field in fields(kind)}
    if set(arguments) != known:
        raise validate.refuse(f"arguments of {kind.name}", sorted(arguments), f"exactly {sorted(known)}")
    return kind(**arguments)


# --- what concerns the session, not the world -----------------------------------------------------------------------


@dataclass(frozen=True)
class Pause:
    """Stands still."""

    name = "pause"


@dataclass(frozen=True)
class Play:
    """Goes on."""

    name = "play"


@dataclass(frozen=True)
class StepOnce:
    """One step, then stands still."""

    name = "step_once"


@dataclass(frozen=True)
class SetSpeed:
    """Simulated seconds per second."""

    speed: float
    name = "set_speed"

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", validate.between("speed", self.speed, *SPEEDS))


@dataclass(frozen=True)
class Reset:
    """The scene begins again, with the settings as they are."""

    name = "reset"


@dataclass(frozen=True)
class LoadScene:
    """Another scene begins. UnknownScene if there is none of that name."""

    scene: str
    name = "load_scene"

    def __post_init__(self) -> None:
        object.__setattr__(self, "scene", find_scene(self.scene).name)


@dataclass(frozen=True)
class StartRecording:
    """Records from the next step on."""

    name = "start_recording"


@dataclass(frozen=True)
class StopRecording:
    """Finishes the recording."""

    name = "stop_recording"
