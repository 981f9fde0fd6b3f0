"""What is joined: forces in joints at rest and in motion, and how far they give way."""

from __future__ import annotations

import math

import numpy as np

from engine import Box, Circle, World
from engine.solvers.soft_step.direct.choose import MOST_STRETCH
from engine.solvers.soft_step.direct.work import STIFFNESS
from sandbox.lab import references
from sandbox.lab.experiments.experiment import (
    G,
    Measure,
    Watch,
    experiment,
    late,
    of_impulses,
    of_soft_step,
    places,
    substep,
)
from sandbox.lab.sag import joint_hertz, spring_sag


def held_hertz(world: World, dt: float, give: float) -> float:
    """Frequency of the joints of something that hangs: as its solver visits them one by one, or solves them at once.

    give: of the joint that would give way most, force x inverse masses [m/s^2]: by it soft_step chooses.
    """
    hertz, how = joint_hertz(world, dt), world.settings.joint_solving
    at_once = how == "direct" or (how == "auto" and give / (2.0 * math.pi * hertz) ** 2 > MOST_STRETCH)
    return STIFFNESS / (2.0 * math.pi * substep(world, dt)) if at_once else hertz


# --- Atwood -----------------------------------------------------------------------------------------------------------

PAIR, ROPE, PULLED = (3.0, 2.0), 4.0, 2.0  # [kg], [m], [s]
FALL, TENSION = references.atwood(*PAIR, G)  # [m/s^2], [N]


@experiment(
    "atwood",
    "two masses pull at the ends of a rope, one up and one down: Atwood's machine, unrolled from its pulley",
    seconds=PULLED,
    measures=(
        Measure(
            "distance",
            "m",
            f"how far the heavier one gets in {PULLED:g} s",
            lambda history, dt: abs(float(history[-1, 0]) - 0.5 * FALL * (len(history) * dt) ** 2),
            of_impulses(lambda world, dt: references.flight_lag(FALL, substep(world, dt), PULLED)),
            scale=0.5 * FALL * PULLED**2,
            against="how far it gets",
        ),
        Measure(
            "tension",
            "relative",
            "what the rope pulls with",
            lambda history, dt: float(np.abs(late(history, dt)[:, 1] / (TENSION * dt) - 1.0).mean()),
            against="2 m1 m2 g / (m1 + m2)",
        ),
        Measure(
            "stretch",
            "m",
            "how much longer the rope gets",
            lambda history, dt: abs(float(history[-1, 2]) - ROPE),
            of_soft_step(
                lambda world, dt: spring_sag(TENSION, 1.0 / (1.0 / PAIR[0] + 1.0 / PAIR[1]), joint_hertz(world, dt))
            ),
            scale=ROPE,
            against="its length",
        ),
    ),
    needs=("gravity scale", "distance joints"),
)
def build_atwood(world: World) -> Watch:
    pairs = []
    for x, y in places():
        heavy = world.create_body(Circle(0.4), position=(x, y), mass=PAIR[0])
        light = world.create_body(Circle(0.4), position=(x, y + ROPE), mass=PAIR[1], gravity_scale=-1.0)
        rope = world.create_joint_distance(heavy, light, anchor1=heavy.position, anchor2=light.position)
        pairs.append((heavy, light, rope))
    heavy, light, rope = pairs[0]

    def watch(world: World) -> np.ndarray:
        return np.array([-heavy.position.y, -rope.impulse.y, light.position.y - heavy.position.y])

    return watch


# --- hanging chain ----------------------------------------------------------------------------------------------------

LINK, LINK_MASSES = 0.5, (1.0,) * 9 + (4.0,)  # length [m]; from above [kg]
LOADS = references.hanging_loads(LINK_MASSES, G)


def joint_compliances(masses: tuple[float, ...]) -> np.ndarray:
    """1 / effective mass of each joint of a chain, the first on something that does not move [1/kg]."""
    inverse = 1.0 / np.array(masses)
    return inverse + np.append(0.0, inverse[:-1])


def predicted_stretch(world: World, dt: float) -> float:
    """Soft joints give way by F / (m w^2), and what hangs lowest sinks by the sum [m]."""
    gives = LOADS * joint_compliances(LINK_MASSES)
    return float(gives.sum()) / (2.0 * math.pi * held_hertz(world, dt, float(gives.max()))) ** 2


def tension_error(expected: np.ndarray) -> Measure:
    """Of joints, the first of what is watched, as impulses of a step."""
    return Measure(
        "tension",
        "relative",
        "what its joints bear, at worst",
        lambda history, dt: float(
            np.abs(late(history, dt)[:, : len(expected)] / (expected * dt) - 1.0).max(axis=1).mean()
        ),
        against="what hangs on each",
    )


def pulls(world: World, count: int) -> np.ndarray:
    """(count,) what the first joints gave in the last step [N s]."""
    records = world.joint_records()[:count]
    return np.hypot(records["impulse_x"], records["impulse_y"])


@experiment(
    "hanging_chain",
    f"a chain of {len(LINK_MASSES)} links hangs, the last one {LINK_MASSES[-1] / LINK_MASSES[0]:g} times as heavy",
    seconds=2.0,
    measures=(
        tension_error(LOADS),
        Measure(
            "stretch",
            "m",
            "how far its end sinks",
            lambda history, dt: abs(float(history[-1, -1])),
            of_soft_step(predicted_stretch),
            scale=LINK * len(LINK_MASSES),
            against="its length",
        ),
    ),
    needs=("revolute joints",),
)
def build_hanging_chain(world: World) -> Watch:
    ceiling = world.create_body(kind="static")
    for x, y in places(6):
        above = ceiling
        for k, mass in enumerate(LINK_MASSES):
            link = world.create_body(Box(0.1, LINK), position=(x, y - LINK * (k + 0.5)), mass=mass)
            world.create_joint_revolute(above, link, anchor=(x, y - LINK * k), collide_connected=False)
            above = link
    last, count = world.bodies[len(LINK_MASSES)], len(LINK_MASSES)
    low = -LINK * (count - 0.5)
    return lambda world: np.append(pulls(world, count), low - last.position.y)


# --- bridge -----------------------------------------------------------------------------------------------------------

PLANKS, PLANK, PLANK_MASS, SPAN = 15, 1.0, 1.0, 13.0  # -, [m], [kg], [m]
JOINTS, PULLS = references.hanging_links(PLANKS, PLANK, PLANK_MASS, SPAN, G)
MIDDLES = 0.5 * (JOINTS[:-1] + JOINTS[1:])  # of its planks [m]


@experiment(
    "bridge",
    f"{PLANKS} planks hang between two points, in the shape of the discrete catenary",
    seconds=2.0,
    measures=(
        tension_error(np.hypot(*PULLS.T)),
        Measure(
            "shape",
            "m",
            "how far a plank is off its place, at worst",
            lambda history, dt: float(history[-1, -1]),
            scale=SPAN,
            against="its span",
        ),
    ),
    needs=("revolute joints",),
)
def build_bridge(world: World) -> Watch:
    banks = world.create_body(kind="static")
    ways = np.diff(JOINTS, axis=0)
    for x, y in places(4, SPAN + 2.0):
        before = banks
        for (px, py), (jx, jy), (wx, wy) in zip(MIDDLES, JOINTS[:-1], ways, strict=True):
            plank = world.create_body(
                Box(PLANK, 0.1), position=(x + px, y + py), angle=math.atan2(wy, wx), mass=PLANK_MASS
            )
            world.create_joint_revolute(before, plank, anchor=(x + jx, y + jy), collide_connected=False)
            before = plank
        world.create_joint_revolute(before, banks, anchor=(x + SPAN, y), collide_connected=False)

    def watch(world: World) -> np.ndarray:
        off = np.hypot(*(world.positions[1 : PLANKS + 1] - MIDDLES).T).max()
        return np.append(pulls(world, PLANKS + 1), off)

    return watch
