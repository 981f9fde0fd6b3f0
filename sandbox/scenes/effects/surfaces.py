"""What surfaces do: rub, bounce, resist rolling, carry along."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Circle, World
from sandbox.lab.references import apex, flight_lag, friction_seen, rolling_distance, slope_acceleration
from sandbox.scenes.criterion import Criterion
from sandbox.scenes.parts import GRAVITY, add_floor
from sandbox.scenes.registry import scene

# --- friction ---------------------------------------------------------------------------------------------------------

FRICTIONS = (0.2, 0.4, 0.6, 0.8)
BAND = 2.0  # what a slope may differ from sticking to sliding [%]
TRIED = 1.01 * BAND / 100.0  # slopes tried: tan(angle) = mu (1 - this) must stick, mu (1 + this) must slide
RAMP, RAMP_HEIGHT = 5.0, 0.4  # [m]
WATCHED = 4.0  # [s]
STUCK = 1e-3  # slower than this [m/s]


def slopes() -> list[tuple[float, float, float, float]]:
    """Friction, angle, and the middle of each ramp's surface [m]: those that stick above, those that slide below."""
    columns = [(mu, 6.0 * (k - 1.5)) for k, mu in enumerate(FRICTIONS)]
    rows = ((6.5, 1.0 - TRIED), (0.0, 1.0 + TRIED))
    return [(mu, math.atan(part * mu), x, y) for y, part in rows for mu, x in columns]


def box_on(angle: float, x: float, y: float, up: float = 1.5) -> tuple[float, float]:
    """Middle of a unit box that lies on a slope, that far up from its middle [m]."""
    c, s = math.cos(angle), math.sin(angle)
    return x + up * c - 0.25 * s, y + up * s + 0.25 * c


def friction_error(world: World) -> float:
    """The worst friction coefficient that the boxes show, in % from theirs: of those that stuck, none."""
    worst = 0.0
    for (mu, angle, x, y), box in zip(slopes(), world.bodies[1::2], strict=True):
        distance = math.dist(box.position, box_on(angle, x, y))
        if math.tan(angle) > mu or math.hypot(*box.velocity) > STUCK:
            worst = max(worst, abs(friction_seen(angle, distance, GRAVITY, world.time) / mu - 1.0))
    return 100.0 * worst


def slid(world: World) -> float:
    """How far the box that slid least of those that must has come, in parts of (sin - mu cos) g t^2 / 2."""
    parts = []
    for (mu, angle, x, y), box in zip(slopes(), world.bodies[1::2], strict=True):
        way = 0.5 * slope_acceleration(angle, mu, GRAVITY) * world.time**2
        if way > 0.0:
            parts.append(math.dist(box.position, box_on(angle, x, y)) / way)
    return min(parts)


SLID = Criterion(  # where nothing falls asleep: what begins to slide so slowly would be held
    "where it is too steep, a box has slid, in parts of what is left to pull it,",
    slid,
    unit="",
    after=WATCHED,
    at_least=0.5,  # the pull is 2 % of what friction takes: half of it is 1 % of friction
)


@scene(
    "Effects/Friction Ramp",
    shows=Criterion("friction differs from what it should be by", friction_error, "%", WATCHED, at_most=BAND),
    view=(0.0, 3.2, 18.0),
)
def friction_ramp(world: World) -> None:
    """Boxes stick while tan(slope) is 2 % below their friction, above, and slide where it is 2 % above, below."""
    for mu, angle, x, y in slopes():
        c, s = math.cos(angle), math.sin(angle)
        place = (x + 0.5 * RAMP_HEIGHT * s, y - 0.5 * RAMP_HEIGHT * c)
        world.create_body(Box(RAMP, RAMP_HEIGHT), position=place, angle=angle, kind="static", friction=mu)
        world.create_body(Box(0.8, 0.5), position=box_on(angle, x, y), angle=angle, friction=mu)


# --- restitution ------------------------------------------------------------------------------------------------------

RESTITUTIONS = tuple(k / 8 for k in range(3, 9))
DROP = 5.0  # [m]
RADIUS = 0.4
FIRST_FLIGHT = 1.4
"""When all of them are on the way up or down after their first bounce [s]: they hit after 1 s, and the flattest flight
lasts another 0.75 s."""


def apex_error(world: World) -> float:
    """The worst height that a ball will reach, in parts of the square of its speed that came back."""
    heights = world.positions[1:, 1] - RADIUS + world.velocities[1:, 1] ** 2 / (2.0 * GRAVITY)
    exact = np.array([apex(DROP, e) for e in RESTITUTIONS])
    return float(np.abs(heights / exact - 1.0).max())


def apex_limit(world: World, dt: float) -> float:
    """The speed of a hit is known to what a time step adds to it, and heights are as its square; and a ball is below
    its parabola by g h t / 2, of which the flattest has the largest part.
    """
    lag = flight_lag(GRAVITY, dt / world.settings.substeps, FIRST_FLIGHT)
    return 2.0 * GRAVITY * dt / math.sqrt(2.0 * GRAVITY * DROP) + lag / apex(DROP, min(RESTITUTIONS))


@scene(
    "Effects/Restitution",
    shows=Criterion(
        "after its bounce a ball rises to a height that differs from e^2 h by",
        apex_error,
        unit="of it",
        after=FIRST_FLIGHT,
        at_most=apex_limit,
    ),
    view=(0.0, 3.2, 9.0),
)
def restitution(world: World) -> None:
    """Six balls, from dull to perfect: each comes back with its own part of the speed."""
    add_floor(world, 40)
    for k, e in enumerate(RESTITUTIONS):
        place = (1.3 * (k - 2.5), DROP + RADIUS)
        world.create_body(Circle(RADIUS), position=place, restitution=e)


# --- rolling resistance -----------------------------------------------------------------------------------------------

RESISTANCES = (0.1, 0.05, 0.03)  # resisting moment / (radius x load)
DISC = 0.5  # radius [m]
ROLLING_SPEED = 3.0  # [m/s]
TRACKS = (0.0, 2.0, 4.0)  # heights of the floors [m]
ROLLS_FROM = -11.0  # [m]


def rolled(world: World) -> np.ndarray:
    """How far each disc has got [m]."""
    return world.positions[1::2, 0] - ROLLS_FROM


@scene(
    "Effects/Rolling Resistance",
    shows=Criterion(
        "how far a disc rolls differs from 3 r v^2 / (4 c g) by",
        lambda world: float(
            max(
                abs(x / rolling_distance(ROLLING_SPEED, c * DISC, DISC, GRAVITY) - 1.0)
                for x, c in zip(rolled(world), RESISTANCES, strict=True)
            )
        ),
        unit="of it",
        after=18.0,
        at_most=0.01,
    ),
    view=(0.0, 2.8, 20.0),
)
def rolling_resistance(world: World) -> None:
    """Three discs roll until their resistance has used up their speed: half the resistance, twice the way."""
    for y, c in zip(TRACKS, RESISTANCES, strict=True):
        world.create_body(Box(40, 0.2), position=(0.0, y - 0.1), kind="static", friction=0.8)
        world.create_body(
            Circle(DISC),
            position=(ROLLS_FROM, y + DISC),
            velocity=(ROLLING_SPEED, 0.0),
            angular_velocity=-ROLLING_SPEED / DISC,
            friction=0.8,
            rolling_resistance=c,
        )


# --- conveyor ---------------------------------------------------------------------------------------------------------

BELTS = ((1.0, 0.0), (-2.0, 2.5), (3.0, 5.0))  # speed to the right [m/s], height of the belt [m]


@scene(
    "Effects/Conveyor",
    shows=Criterion(
        "a box differs from the speed of its belt by",
        lambda world: float(np.abs(world.velocities[1::2, 0] - [speed for speed, _ in BELTS]).max()),
        unit="m/s",
        after=2.0,
        at_most=1e-3,
    ),
    view=(0.0, 3.2, 10.0),
)
def conveyor(world: World) -> None:
    """Three belts, one of them backwards: friction takes the boxes along, and they end as fast as their belt."""
    for speed, y in BELTS:
        belt = Box(14, 0.4)
        world.create_body(belt, position=(0.0, y - 0.2), kind="static", friction=0.5, tangent_speed=speed)
        start = -5.5 if speed > 0.0 else 5.5
        world.create_body(Box(0.8, 0.8), position=(start, y + 0.4), friction=0.5)
