"""Small scenes with an exact answer: what is watched in each, and how far off the answer it is.

Each fills its world with copies side by side, so that what is timed is the solver and not the Python around it. It
watches a few numbers after every step, of the first copy; its measures turn that history into errors. Where the error
that the integrator or the soft constraints must make is known in closed form, it is predicted too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine import Body, Box, Circle, World
from sandbox.lab import references
from sandbox.lab.sag import BOX_INERTIA, joint_gap, predicted_sink
from sandbox.lab.structure import GROUND, Point, Structure

G = 10.0  # [m/s^2]
COPIES = 60
APART = 6.0  # of copies [m]

History = np.ndarray  # (steps, k) of what was watched
Watch = Callable[[World], np.ndarray]  # (k,) now
Predict = Callable[[World, float], float | None]  # of a world with its settings and the time step [s]


@dataclass(frozen=True)
class Measure:
    """An error: of the history of a run whose time step was dt [s]."""

    name: str  # with its unit
    says: str
    error: Callable[[History, float], float]
    predicted: Predict


@dataclass(frozen=True)
class Experiment:
    """A scene with an exact answer. `build` fills the world and says what to watch."""

    name: str
    says: str
    seconds: float
    build: Callable[[World], Watch]
    measures: tuple[Measure, ...]
    needs: tuple[str, ...] = ()  # effects without which it makes no sense


def unpredicted(world: World, dt: float) -> None:
    """No closed form is known."""


def substep(world: World, dt: float) -> float:
    """Time of one integration [s]."""
    return dt / world.settings.substeps


def places(count: int = COPIES, apart: float = APART) -> list[tuple[float, float]]:
    """Where copies stand; the first at the origin [m]."""
    return [(apart * k, 0.0) for k in range(count)]


def add_floor(world: World, friction: float = 0.6) -> None:
    """Under all copies, its top at y = 0."""
    width = 2.0 * APART * (COPIES + 10)
    world.create_body(Box(width, 2), position=(0.0, -1.0), kind="static", friction=friction)


# --- ballistic --------------------------------------------------------------------------------------------------------

THROWN_AT, FLIGHT = 12.0, 2.0  # [m/s], [s]


def build_ballistic(world: World) -> Watch:
    balls = [world.create_body(Circle(0.25), position=place, velocity=(0.0, THROWN_AT)) for place in places()]
    ball = balls[0]
    return lambda world: np.array([ball.position.y])


def flight_error(history: History, dt: float) -> float:
    return abs(history[-1, 0] - references.flight(0.0, THROWN_AT, G, len(history) * dt))


BALLISTIC = Experiment(
    "ballistic",
    "a ball thrown upwards",
    FLIGHT,
    build_ballistic,
    (
        Measure(
            "height [m]",
            f"height after {FLIGHT:g} s",
            flight_error,
            lambda world, dt: references.flight_lag(G, substep(world, dt), FLIGHT),
        ),
    ),
)

# --- pendulum ---------------------------------------------------------------------------------------------------------

ROD, BOB, AMPLITUDE = 2.0, 0.25, 2.0 * math.pi / 3.0  # [m], [m], [rad]
INERTIA = ROD * ROD + 0.5 * BOB * BOB  # about the pivot, of 1 kg [kg m^2]
PERIOD = references.pendulum_period(INERTIA, 1.0, ROD, G, AMPLITUDE)
INWARD = 2.0 * G * (1.0 - math.cos(AMPLITUDE)) * ROD * ROD / INERTIA  # v^2 / d at the lowest point [m/s^2]


def build_pendulum(world: World) -> Watch:
    pivot = world.create_body(Box(0.2, 0.2), kind="static")
    bobs = []
    for x, y in places():
        place = (x + ROD * math.sin(AMPLITUDE), y - ROD * math.cos(AMPLITUDE))
        bobs.append(world.create_body(Circle(BOB), position=place, angle=AMPLITUDE, mass=1.0))
        world.create_joint_revolute(pivot, bobs[-1], anchor=(x, y), collide_connected=False)
    bob = bobs[0]
    return lambda world: np.array([bob.angle, bob.angular_velocity, gap(bob)])


def gap(bob: Body) -> float:
    """How far the end of the rod is from the pivot [m]."""
    return math.dist(bob.position, (ROD * math.sin(bob.angle), -ROD * math.cos(bob.angle)))


def period_error(history: History, dt: float) -> float:
    crossings = zero_crossings(history[:, 0], history[:, 1], dt)
    if len(crossings) < 3:
        return math.inf
    return abs((crossings[2] - crossings[0]) / PERIOD - 1.0)


def zero_crossings(x: np.ndarray, v: np.ndarray, dt: float) -> np.ndarray:
    """Times at which x passes through 0, between steps by the cubic that has its values and its speeds [s]."""
    times = []
    for k in np.flatnonzero(np.sign(x[:-1]) * np.sign(x[1:]) < 0):
        a, b, c, d = x[k], x[k + 1], v[k] * dt, v[k + 1] * dt
        cubic = np.array([2 * a - 2 * b + c + d, -3 * a + 3 * b - 2 * c - d, c, a])
        inside = [root.real for root in np.roots(cubic) if abs(root.imag) < 1e-9 and -1e-9 <= root.real <= 1.0 + 1e-9]
        times.append((k + 1 + (inside[0] if inside else a / (a - b))) * dt)  # the first watched is after one step
    return np.array(times)


PENDULUM = Experiment(
    "pendulum",
    f"a bob let go {math.degrees(AMPLITUDE):g} degrees from its lowest point",
    1.3 * PERIOD,
    build_pendulum,
    (
        Measure("period [relative]", "its period", period_error, unpredicted),
        Measure(
            "joint gap [m]",
            "how far its joint gives way",
            lambda history, dt: float(history[:, 2].max()),
            lambda world, dt: joint_gap(world, dt, G + INWARD, INWARD),
        ),
    ),
)

# --- sliding ----------------------------------------------------------------------------------------------------------

SLIDING_AT, FRICTION = 10.0, 0.5  # [m/s]


def build_sliding(world: World) -> Watch:
    add_floor(world, FRICTION)
    boxes = [
        world.create_body(Box(1.0, 0.5), position=(x, y + 0.25), velocity=(SLIDING_AT, 0.0), friction=FRICTION)
        for x, y in places()
    ]
    box = boxes[0]
    return lambda world: np.array([box.position.x])


SLIDING = Experiment(
    "sliding",
    "a box slides until friction has stopped it",
    3.0,
    build_sliding,
    (
        Measure(
            "distance [m]",
            "how far it gets",
            lambda history, dt: abs(history[-1, 0] - references.stopping_distance(SLIDING_AT, FRICTION, G)),
            lambda world, dt: references.stopping_lag(SLIDING_AT, substep(world, dt)),
        ),
    ),
)

# --- bounce -----------------------------------------------------------------------------------------------------------

RESTITUTION, BALL = 0.8, 0.25
DROPS = np.linspace(4.0, 5.0, COPIES)  # all different: a ball may hit at any moment of a time step [m]


def build_bounce(world: World) -> Watch:
    world.continuous = False  # what stops at its impact loses the rest of that step, however short substeps are
    add_floor(world)
    for (x, y), height in zip(places(), DROPS, strict=True):
        world.create_body(Circle(BALL), position=(x, y + height + BALL), restitution=RESTITUTION)
    return lambda world: world.positions[1:, 1] - BALL


def apex_error(history: History, dt: float) -> float:
    errors = []
    for heights, drop in zip(history.T, DROPS, strict=True):
        bounced = int(np.argmax(np.diff(heights) > 0.0))  # the first step that leads upwards
        errors.append(vertex(heights[bounced:]) / references.apex(drop, RESTITUTION) - 1.0)
    return float(np.sqrt(np.mean(np.square(errors))))


def vertex(heights: np.ndarray) -> float:
    """The top of the parabola through the highest of some equidistant heights and its neighbours [m]."""
    top = int(np.clip(np.argmax(heights), 1, len(heights) - 2))
    before, here, after = heights[top - 1 : top + 2]
    slope, bend = 0.5 * (after - before), after - 2.0 * here + before
    return float(here - 0.5 * slope * slope / bend) if bend < 0.0 else float(here)


BOUNCE = Experiment(
    "bounce",
    f"{COPIES} balls dropped from {DROPS[0]:g} to {DROPS[-1]:g} m bounce with e = {RESTITUTION:g}",
    2.2,
    build_bounce,
    (Measure("apex [relative]", "how high they rise, root mean square", apex_error, unpredicted),),
    needs=("restitution",),
)

# --- stack ------------------------------------------------------------------------------------------------------------

MASSES = (4.0, 1.0, 2.5, 0.5, 3.0, 1.5, 2.0, 0.8, 1.2, 1.0)  # from below [kg]
SETTLED = 0.5  # at the end, during which the impulses are compared [s]


def build_stack(world: World) -> Watch:
    add_floor(world)
    for x, y in places(COPIES // len(MASSES)):
        for k, mass in enumerate(MASSES):
            world.create_body(Box(1, 1), position=(x, y + k + 0.5), mass=mass, friction=0.6)

    def watch(world: World) -> np.ndarray:
        records = world.contact_records()
        records = records[records["body2"] <= len(MASSES)]  # the first tower's; body2 is the upper one
        given = np.zeros(len(MASSES))
        np.add.at(given, records["body2"] - 1, records["normal_impulse"])
        return np.append(given, len(MASSES) - 0.5 - world.positions[len(MASSES), 1])

    return watch


def impulse_error(history: History, dt: float) -> float:
    expected = np.array(references.loads(MASSES, G)) * dt
    late = history[-max(1, round(SETTLED / dt)) :, :-1]
    return float(np.abs(late / expected - 1.0).max(axis=1).mean())


def stack_structure() -> Structure:
    """The boxes, and the two points of each contact."""
    masses = np.array(MASSES)
    centers = np.column_stack([np.zeros(len(masses)), np.arange(len(masses)) + 0.5])
    points = [Point(k - 1 if k else GROUND, k, x, float(k)) for k in range(len(masses)) for x in (-0.5, 0.5)]
    return Structure(centers, masses, BOX_INERTIA * masses, points)


STACK = Experiment(
    "stack",
    f"{len(MASSES)} boxes of {min(MASSES):g} to {max(MASSES):g} kg on each other",
    3.0,
    build_stack,
    (
        Measure(
            "impulse [relative]",
            "what its contacts give, against the weight above",
            impulse_error,
            unpredicted,
        ),
        Measure(
            "sag [m]",
            "how far its top sinks",
            lambda history, dt: abs(float(history[-1, -1])),
            lambda world, dt: predicted_sink(world, dt, stack_structure(), len(MASSES) - 1),
        ),
    ),
)

EXPERIMENTS = {each.name: each for each in (BALLISTIC, PENDULUM, SLIDING, BOUNCE, STACK)}
