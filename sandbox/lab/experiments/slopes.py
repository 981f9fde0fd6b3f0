"""What slides down slopes: with dry friction, at and around the angle that it holds; and none, on a wedge."""

from __future__ import annotations

import math

import numpy as np

from engine import Body, Box, Polygon, World
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    COPIES,
    G,
    History,
    Measure,
    Watch,
    add_floor,
    exact,
    experiment,
    levels,
    of_impulses,
    places,
    substep,
)
from sandbox.lab.sag import contact_hertz, is_soft, spring_sag

# --- slopes -----------------------------------------------------------------------------------------------------------

GRIP = 0.5  # of boxes on slopes
SLOPE, THICK = 24.0, 0.4  # length and thickness of what lies under [m]


def add_slope(world: World, angle: float, y: float, friction: float, x: float = 0.0) -> None:
    """Down to the right; the middle of its surface at (x, y)."""
    place = (x - 0.5 * THICK * math.sin(angle), y - 0.5 * THICK * math.cos(angle))
    world.create_body(Box(SLOPE, THICK), position=place, angle=-angle, kind="static", friction=friction)


def along_slope(angle: float, way: float, up: float, y: float, x: float = 0.0) -> tuple[float, float]:
    """The point that far down a slope from its middle, and that far above its surface [m]."""
    c, s = math.cos(angle), math.sin(angle)
    return x + way * c + up * s, y - way * s + up * c


def way_down(body: Body, angle: float, x: float = 0.0) -> float:
    """How far down the slope at height 0 from its middle a body is [m]."""
    return (body.position.x - x) * math.cos(angle) - body.position.y * math.sin(angle)


STEEPNESS = (0.98, 1.02, 1.5)  # of the slopes, tan(angle) / friction
ANGLES = tuple(math.atan(GRIP * steepness) for steepness in STEEPNESS)
SLID, STARTS = 2.0, -5.0  # [s], where the boxes begin [m]
FALLS = tuple(references.slope_acceleration(angle, GRIP, G) for angle in ANGLES)  # [m/s^2]


def slide_error(history: History, dt: float) -> float:
    """How far the box gets on the steepest slope [m]."""
    return abs(float(history[-1, 2]) - 0.5 * FALLS[2] * SLID * SLID)


def acceleration_error(history: History, dt: float) -> float:
    """Of the box that just slides, in the second half [m/s^2]: in the first steps it sinks into the slope."""
    half = len(history) // 2
    return abs(float(history[-1, 3] - history[half - 1, 3]) / ((len(history) - half) * dt) - FALLS[1])


@experiment(
    "incline",
    f"boxes on slopes: one of {STEEPNESS[0]:g} of the friction angle's tangent holds it, those above do not",
    seconds=SLID,
    measures=(
        Measure(
            "creep",
            "m",
            f"how far the box moves that holds, in {SLID:g} s",
            lambda history, dt: float(np.abs(history[:, 0]).max()),
            scale=0.5,
            against="the height of the box",
        ),
        Measure(
            "acceleration",
            "m/s^2",
            f"of the box that slides where tan(slope) is {STEEPNESS[1]:g} of its friction",
            acceleration_error,
            of_impulses(exact),
            scale=G * math.sin(ANGLES[1]),
            against="what it would be without friction",
        ),
        Measure(
            "slide",
            "m",
            f"how far the box slides in {SLID:g} s where tan(slope) is {STEEPNESS[2]:g} of its friction",
            slide_error,
            of_impulses(lambda world, dt: references.flight_lag(FALLS[2], substep(world, dt), SLID)),
            scale=0.5 * FALLS[2] * SLID * SLID,
            against="how far it slides",
        ),
    ),
    needs=("friction",),
)
def build_incline(world: World) -> Watch:
    columns = [(SLOPE * k, angle) for k, angle in enumerate(ANGLES)]
    firsts = []
    for x, angle in columns:
        boxes = []
        for y in levels(COPIES // len(ANGLES)):
            add_slope(world, angle, y, GRIP, x)
            place = along_slope(angle, STARTS, 0.25, y, x)
            boxes.append(world.create_body(Box(1.0, 0.5), position=place, angle=-angle, friction=GRIP))
        firsts.append((boxes[0], angle, x))
    box, angle, _ = firsts[1]

    def watch(world: World) -> np.ndarray:
        speed = box.velocity.x * math.cos(angle) - box.velocity.y * math.sin(angle)
        return np.array([*(way_down(*each) - STARTS for each in firsts), speed])

    return watch


# --- wedge ------------------------------------------------------------------------------------------------------------

WEDGE, BLOCK, WEDGE_ANGLE, SLIPPED = 2.0, 1.0, math.radians(30.0), 0.75  # [kg], [kg], [rad], [s]
BASE = 6.0  # of the wedge [m]
HEIGHT = BASE * math.tan(WEDGE_ANGLE)
AWAY, DOWN = references.wedge_accelerations(WEDGE, BLOCK, WEDGE_ANGLE, G)  # [m/s^2]
SIDEWAYS = DOWN * math.cos(WEDGE_ANGLE) - AWAY  # of the block [m/s^2]


def wedge_errors(history: History, dt: float) -> np.ndarray:
    """(3,) how far the wedge, and the block sideways and downwards, are from where they should be, at the end [m]."""
    half = 0.5 * (len(history) * dt) ** 2
    exactly = np.array([-AWAY * half, SIDEWAYS * half, -DOWN * math.sin(WEDGE_ANGLE) * half])
    return np.abs(history[-1] - exactly)


def slipped_lag(world: World, dt: float, acceleration: float) -> float | None:
    """Of what gets there with that acceleration [m]. None where soft contacts give way by so much meanwhile, about
    g / w^2, that it no longer hardly matters: a sixth of the block's lag.
    """
    lag = references.flight_lag(SIDEWAYS, substep(world, dt), SLIPPED)
    if is_soft(world) and spring_sag(G, 1.0, contact_hertz(world, dt)) > lag / 6.0:
        return None
    return references.flight_lag(acceleration, substep(world, dt), SLIPPED)


@experiment(
    "wedge",
    "a block slides down a wedge, which slides away under it, both without friction",
    seconds=SLIPPED,
    measures=(
        Measure(
            "wedge",
            "m",
            f"how far the wedge gets in {SLIPPED:g} s",
            lambda history, dt: float(wedge_errors(history, dt)[0]),
            of_impulses(lambda world, dt: slipped_lag(world, dt, AWAY)),
            scale=0.5 * AWAY * SLIPPED**2,
            against="how far it gets",
        ),
        Measure(
            "block",
            "m",
            "how far the block gets sideways",
            lambda history, dt: float(wedge_errors(history, dt)[1]),
            of_impulses(lambda world, dt: slipped_lag(world, dt, SIDEWAYS)),
            scale=0.5 * SIDEWAYS * SLIPPED**2,
            against="how far it gets",
        ),
    ),
)
def build_wedge(world: World) -> Watch:
    add_floor(world, 0.0)
    pairs = []
    shape = Polygon(((0.0, 0.0), (BASE, 0.0), (0.0, HEIGHT)))
    for x, y in places(COPIES // 2, 2.0 * BASE):
        wedge = world.create_body(shape, position=(x, y), mass=WEDGE, friction=0.0)
        c, s = math.cos(WEDGE_ANGLE), math.sin(WEDGE_ANGLE)
        place = (x + 0.7 * c + 0.25 * s, y + HEIGHT - 0.7 * s + 0.25 * c)
        block = world.create_body(Box(1.0, 0.5), position=place, angle=-WEDGE_ANGLE, mass=BLOCK, friction=0.0)
        pairs.append((wedge, block, place))
    wedge, block, place = pairs[0]

    def watch(world: World) -> np.ndarray:
        return np.array([wedge.position.x, block.position.x - place[0], block.position.y - place[1]])

    return watch
