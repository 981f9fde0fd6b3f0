"""Scenes without an exact answer: compared with converged references (sandbox/lab/converged.py).

What is watched: where all dynamic bodies are, the deepest overlap, the farthest that a joint gives way, how fast the
fastest body is, and how far contacts are from complementary. Where bodies are is compared only as long as the reference
is certain to CERTAIN: all of the time, but for the heap. Its impacts multiply every difference, so that no more than
its first half second of three is known, 28 frames of 180; what comes after counts for nothing, right or wrong.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from engine import Box, Capsule, Circle, World
from sandbox.lab.converged import Fill, Reference, dynamic_positions, reference_of
from sandbox.lab.experiments.experiment import EXPERIMENTS, Experiment, G, History, Measure, Watch, late
from sandbox.lab.measures import complementarity, jitter, joint_error, penetration, speeds, time_until_divergence
from sandbox.simulation import TIME_STEP

DIVERGED = 0.1  # from the reference: so far off, a body is somewhere else [m]
CERTAIN = 0.1 * DIVERGED  # the reference must be: what comes after is not compared [m]
OTHERS = 4  # numbers that are watched beside the positions
PENETRATION, JOINT_ERROR, FASTEST, COMPLEMENTARITY = range(-OTHERS, 0)  # their columns
SETTLED = 0.5  # at the end, during which what stands is compared [s]
SIZE = "a metre, about the size of its bodies"

CONVERGED: dict[str, Experiment] = {}  # those among the experiments that are


def watch(world: World) -> np.ndarray:
    """(2 N + 4,) positions [m], penetration [m], joint error [m], fastest [m/s], complementarity [m/s]."""
    fastest = float(speeds(world).max(initial=0.0))
    residual = complementarity(world, world._state.last_dt).value
    return np.array([*dynamic_positions(world).ravel(), penetration(world), joint_error(world), fastest, residual])


def way(history: History) -> np.ndarray:
    """(steps, N, 2) positions out of what was watched [m]."""
    return history[:, :-OTHERS].reshape(len(history), -1, 2)


def away(reference: Reference, history: History, dt: float) -> np.ndarray:
    """(frames,) the distance from the reference over time, as long as that is certain [m]; NaN between frames."""
    return reference.distances(way(history), dt)[: reference.known(CERTAIN)]


def greatest(column: int, history: History, dt: float) -> float:
    """Of a number that was watched."""
    return float(history[:, column].max())


def of_contacts() -> tuple[Measure, ...]:
    return (Measure("penetration", "m", "the deepest overlap, at worst", partial(greatest, PENETRATION), against=SIZE),)


def of_joints() -> tuple[Measure, ...]:
    says = "the farthest that a joint gives way, at worst"
    return (Measure("joint error", "m", says, partial(greatest, JOINT_ERROR), against=SIZE),)


def of_rest() -> tuple[Measure, ...]:
    """Of what should be still in the end."""
    return (
        Measure(
            "jitter",
            "m/s",
            f"how fast the fastest body moves in the last {SETTLED:g} s",
            lambda history, dt: jitter(history[:, FASTEST], dt, SETTLED),
            against="a metre a second",
        ),
        Measure(
            "complementarity",
            "m/s",
            f"how far contacts are from pushing only where shapes stay together, in the last {SETTLED:g} s",
            lambda history, dt: float(late(history, dt, SETTLED)[:, COMPLEMENTARITY].mean()),
            scale=G * TIME_STEP,
            against="what weight adds to a speed in 1/60 s",
        ),
    )


def converged(
    name: str,
    says: str,
    seconds: float,
    fill: Fill,
    *,
    contacts: bool = False,
    joints: bool = False,
    stands: bool = False,
    certain: float | None = None,
) -> None:
    """Makes a scene an experiment that is compared with its converged reference.

    contacts, joints, stands: whether it has any, and rests in the end, so that these are measured, too. certain: for
    about how long its reference is, where that is not all of the time [s]; reports say so.
    """
    if name in EXPERIMENTS:
        raise ValueError(f"name = {name!r}: must be an experiment's name that is not taken yet")
    reference = partial(reference_of, name, fill, seconds)

    def build(world: World) -> Watch:
        fill(world)
        return watch

    def farthest(history: History, dt: float) -> float:
        found = away(reference(), history, dt)
        return float(np.nanmax(found)) if np.isfinite(found).any() and not np.isinf(found).any() else math.inf

    def lost(history: History, dt: float) -> float:
        found = away(reference(), history, dt)
        until = time_until_divergence(np.where(np.isnan(found), 0.0, found), TIME_STEP, DIVERGED)
        return max(0.0, 1.0 - until / (len(found) * TIME_STEP)) if len(found) else 0.0

    time, only = "the time", ""
    if certain is not None:
        time = f"the first {certain:g} s of {seconds:g}"
        only, time = f", in {time}: of what comes after nothing is known", f"{time}, after which nothing is known,"
    measures = (
        Measure(
            "distance",
            "m",
            f"how far a body is from where the reference has it, at worst{only}",
            farthest,
            against=SIZE,
        ),
        Measure(
            "diverged",
            "relative",
            f"the part of {time} after a body was first {DIVERGED:g} m away from the reference",
            lost,
            against="all of the time" if certain is None else f"about {certain:g} s, while the reference is certain",
        ),
        *(of_contacts() if contacts else ()),
        *(of_joints() if joints else ()),
        *(of_rest() if stands else ()),
    )
    CONVERGED[name] = EXPERIMENTS[name] = Experiment(name, says, seconds, build, measures, prepare=reference)


def scene(name: str) -> Fill:
    """One of the sandbox's scenes."""

    def fill(world: World) -> None:
        from sandbox.scenes import find_scene  # the scenes import the laboratory's closed forms

        find_scene(name).build(world)

    return fill


# --- what stands ------------------------------------------------------------------------------------------------------

BASE = 12  # boxes in the lowest row


def fill_pyramid(world: World) -> None:
    world.create_body(Box(60, 2), position=(0.0, -1.0), kind="static", friction=0.6)
    for row in range(BASE):
        for k in range(BASE - row):
            world.create_body(Box(1, 1), position=(1.1 * (k - 0.5 * (BASE - row - 1)), row + 0.5), friction=0.6)


converged("pyramid", f"a pyramid of {BASE} boxes at its base", 2.0, fill_pyramid, contacts=True, stands=True)
converged("arch", "thirteen loose stones in an arch", 2.0, scene("Stacking/Arch"), contacts=True, stands=True)
converged("card_house", "a house of cards", 2.0, scene("Stacking/Card House"), contacts=True, stands=True)
converged(
    "mass_ratio",
    "a box of 400 times the mass of those that carry it",
    2.0,
    scene("Stacking/Mass Ratio 400"),
    contacts=True,
    stands=True,
)

# --- what hangs -------------------------------------------------------------------------------------------------------

LINKS, LINK, HEAVY = 20, 0.5, 100.0  # -, [m], mass of what hangs at the end over that of a link
STARTS = math.radians(30.0)  # from the vertical


def fill_heavy_chain(world: World) -> None:
    ceiling = world.create_body(kind="static")
    c, s = math.cos(STARTS), math.sin(STARTS)
    above = ceiling
    for k in range(LINKS):
        middle = LINK * (k + 0.5)
        link = world.create_body(Capsule(LINK, 0.05), position=(middle * s, -middle * c), angle=STARTS - 0.5 * math.pi)
        link_joint = (LINK * k * s, -LINK * k * c)
        world.create_joint_revolute(above, link, anchor=link_joint, collide_connected=False)
        above = link
    end, mass = (LINK * LINKS * s, -LINK * LINKS * c), HEAVY * world.bodies[1].mass
    weight = world.create_body(Circle(0.5 * LINK), position=end, mass=mass)  # it touches no link but its own
    world.create_joint_revolute(above, weight, anchor=end, collide_connected=False)


converged(
    "heavy_chain",
    f"a chain of {LINKS} links swings with a weight of {HEAVY:g} of them at its end",
    2.0,
    fill_heavy_chain,
    joints=True,
)
converged(
    "ball_and_chain", "a heavy ball swings on a chain of 30 links", 2.0, scene("Joints/Ball and Chain"),
    joints=True,
)  # fmt: skip
converged(
    "bridge_160",
    "a bridge of 160 planks, on which stones roll and boxes fall",
    1.0,
    scene("Joints/Bridge"),
    contacts=True,
    joints=True,
)

# --- what falls -------------------------------------------------------------------------------------------------------

HEAP, SEED = 40, 20261122


def fill_heap(world: World) -> None:
    container = world.create_body(Box(16, 2), position=(0.0, -1.0), kind="static", friction=0.6)
    for x in (-7.0, 7.0):
        container.add_shape(Box(2, 12), offset=(x, 7.0), friction=0.6)
    turns = np.random.default_rng(SEED).uniform(0.0, math.tau, HEAP)
    for k, turn in enumerate(turns.tolist()):
        place = (1.5 * (k % 7 - 3) + 0.2 * (k // 7 % 2), 1.0 + 1.5 * (k // 7))
        shape = Circle(0.5) if k % 3 == 0 else Box(1, 1)
        world.create_body(shape, position=place, angle=turn, friction=0.6)


converged("heap", f"{HEAP} boxes and balls fall into a heap", 3.0, fill_heap, contacts=True, certain=0.45)
